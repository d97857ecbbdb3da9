//! Packaged models go on from serialised states that another instance, of any form, has written.

use maglev_fmu::host::{HostError, Instance, Storage};
use maglev_fmu::model::system::SYSTEMS;
use maglev_fmu::model::variable::{Causality, Kind};
use maglev_fmu::package::Form;
use maglev_fmu_test::packages;

/// All reals of the model, as bits.
fn snapshot(instance: &Instance) -> Vec<u64> {
    let reals = instance.description().variables.iter().filter(|variable| variable.storage != Storage::Other);
    reals
        .map(|variable| instance.get(instance.variable(&variable.name).unwrap()).unwrap().to_bits())
        .collect()
}

#[test]
fn states_cross_instances_and_forms() {
    for model in SYSTEMS.iter().flat_map(|system| [system.plant, system.controller]) {
        let description = model.description;
        let forms = || Form::all_of(description);
        for (from, to) in forms().flat_map(|from| forms().map(move |to| (from, to))) {
            let inputs = description.variables.iter().filter(|variable| {
                variable.causality == Causality::Input && matches!(variable.kind, Kind::Real(_))
            });
            let input = inputs.map(|variable| variable.name).next().unwrap();
            let mut first = packages::instantiate(from, description.name, &[]);
            let mut second = packages::instantiate(to, description.name, &[]);
            first.initialise(0.0, None).unwrap();
            let step = |instance: &mut Instance, k: u32| {
                instance.set_by_name(input, 1e-4 * f64::from(k)).unwrap();
                instance.step(f64::from(k) * 1e-3, 1e-3).unwrap();
            };
            (0..50).for_each(|k| step(&mut first, k));

            let saved = first.save_state().unwrap();
            let bytes = first.serialise_state(&saved).unwrap();
            first.free_state(saved).unwrap();
            let read = second.deserialise_state(&bytes).unwrap();
            second.restore_state(&read).unwrap();
            assert!(matches!(first.restore_state(&read), Err(HostError::ForeignState { .. })));
            second.free_state(read).unwrap();
            for k in 50..100 {
                step(&mut first, k);
                step(&mut second, k);
                assert_eq!(snapshot(&second), snapshot(&first), "{} {from:?} to {to:?}", description.name);
            }
            let refused = second.deserialise_state(&bytes[1..]).unwrap_err().to_string();
            assert!(refused.contains("bytes begin with"), "{refused}");
        }
    }
}
