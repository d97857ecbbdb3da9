//! Controllers at the limits that their tables declare: whatever parameters and inputs, outputs are finite, and an observer
//! that ran away counts it.

use maglev_fmu::model::variable::{Causality, Kind, Variability, Variable};
use maglev_fmu::model::{MaglevRigController, Model, NullLogSink, models};
use maglev_fmu_test::values::{get, set};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg32;

/// Parameters at their limits or at their start values, inputs also far beyond any signal.
fn extreme(variable: &Variable, random: &mut Pcg32) -> f64 {
    let (smallest, largest) = match (variable.kind, variable.name) {
        (Kind::Boolean, _) => (0.0, 1.0),
        (Kind::Enumeration(enumeration), _) => (1.0, enumeration.items.len() as f64),
        // What only costs time.
        (_, "observer.max_iterations" | "observer.substeps") => (variable.range.0, 20.0),
        (_, "observer.startup_hold") => (0.0, 1e-3),
        _ => (variable.range.0.max(-1.7e308), variable.range.1.min(1.7e308)),
    };
    let choice = random.next_u32() % 8;
    let share = f64::from(random.next_u32()) / f64::from(u32::MAX);
    let value = match (choice, variable.kind) {
        (0, _) => smallest,
        (1, _) => largest,
        (2 | 3, Kind::Real(_)) => share * (if choice == 2 { smallest } else { largest }),
        (4, Kind::Real(_)) => (variable.start + 1e-3) * 10f64.powf(12.0 * share - 6.0),
        (5, Kind::Real(_)) if variable.causality == Causality::Input => 1e5 * (2.0 * share - 1.0),
        (_, Kind::Enumeration(_)) => (smallest + share * (largest - smallest)).round(),
        _ => variable.start,
    };
    value.clamp(smallest, largest)
}

#[test]
fn outputs_are_finite_at_declared_limits() {
    for model in models().filter(|model| model.description.is_sampled()) {
        let variables = model.description.variables;
        let mut random = Pcg32::seed_from_u64(16);
        for run in 0..400 {
            let mut model = (model.create)();
            for (row, variable) in variables.iter().enumerate().filter(|(_, row)| !row.is_calculated()) {
                model.values_mut()[row] = extreme(variable, &mut random);
            }
            // The steps below are those of the sample time.
            let (longest_step, _) = model.description().find("longest_step").unwrap();
            model.values_mut()[longest_step] = variables[longest_step].start;
            model.initialise(0.0).unwrap();
            if model.check_parameters().is_err() {
                continue;
            }
            let sample_time = get(&*model, "sample_time");
            // Inputs rest, jump, and rest again at another value; some tunable parameters change on the way.
            for tick in 0..120 {
                for (row, variable) in variables.iter().enumerate() {
                    let is_tunable = variable.causality == Causality::Parameter
                        && variable.variability == Variability::Tunable;
                    let changes = match variable.causality {
                        Causality::Input => tick % 40 < 4 || random.next_u32() % 50 == 0,
                        _ => is_tunable && random.next_u32() % 2000 == 0,
                    };
                    if changes {
                        model.values_mut()[row] = extreme(variable, &mut random);
                    }
                }
                if model.check_parameters().is_err() {
                    break;
                }
                model.apply_tunable_parameters();
                model.advance(sample_time, &mut NullLogSink).unwrap();
                for (variable, value) in variables.iter().zip(model.values()) {
                    let name = model.description().name;
                    assert!(value.is_finite(), "{name}, run {run}, tick {tick}: {} = {value}", variable.name);
                }
            }
        }
    }
}

#[test]
fn the_rigs_nonlinear_observer_comes_back_from_its_limits() {
    let mut model = MaglevRigController::new();
    for (name, value) in
        [("observer.kind", 2.0), ("observer.discretisation", 1.0), ("observer.exponent[1]", 2.0)]
    {
        set(&mut model, name, value);
    }
    model.initialise(0.0).unwrap();
    let mut tick = |voltage: f64| {
        set(&mut model, "sensor_voltage", voltage);
        model.advance(1e-3, &mut NullLogSink).unwrap();
        for name in
            ["observer.residual", "estimate.position", "estimate.velocity", "estimate.extended", "voltage"]
        {
            let value = get(&model, name);
            assert!(value.is_finite(), "{name} = {value} at t = {}", get(&model, "tick_time"));
        }
        [get(&model, "observer.restarts"), get(&model, "observer.residual"), get(&model, "estimate.position")]
    };
    for k in 0..60 {
        tick(if k % 2 == 0 { 5e5 } else { -5e5 });
    }
    // With so little gain on small errors it swings around the measurement, but by tenths of a volt.
    for k in 0..540 {
        let [restarts, residual, position] = tick(-1.5);
        if k >= 40 {
            assert!(residual.abs() < 1.0 && (position + 1.5).abs() < 1.0, "{restarts} {residual} {position}");
        }
    }
}
