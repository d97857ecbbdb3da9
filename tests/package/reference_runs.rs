//! Reference runs of all models: what their packages will hold.

use maglev_fmu::model::{NullLogSink, StartValues, models};
use maglev_fmu::package::ReferenceRun;
use maglev_fmu_test::values::{get, set};

#[test]
fn runs_are_complete_finite_and_repeatable() {
    for model in models() {
        let run = ReferenceRun::of(model.description, StartValues::TABLE).unwrap();
        let steps = run.inputs.rows.len();
        assert!((100..=1500).contains(&steps), "{steps}");
        assert_eq!(run.outputs.rows.len(), steps + 1);
        for table in [&run.inputs, &run.outputs] {
            for (time, values) in &table.rows {
                assert_eq!(values.len(), table.variables.len());
                let are_finite = values.iter().all(|value| value.is_finite());
                assert!(are_finite, "{} at {time} s", model.description.name);
            }
        }
        let again = ReferenceRun::of(model.description, StartValues::TABLE).unwrap();
        assert_eq!(run.inputs.csv() + &run.outputs.csv(), again.inputs.csv() + &again.outputs.csv());
    }
}

#[test]
fn a_model_alone_answers_the_inputs_as_it_did_in_its_loop() {
    for model in models() {
        let run = ReferenceRun::of(model.description, StartValues::TABLE).unwrap();
        let mut alone = (model.create)();
        alone.initialise(0.0).unwrap();
        for ((_, inputs), (_, outputs)) in run.inputs.rows.iter().zip(&run.outputs.rows[1..]) {
            for (variable, value) in run.inputs.variables.iter().zip(inputs) {
                set(&mut *alone, variable.name, *value);
            }
            alone.advance(run.step_size, &mut NullLogSink).unwrap();
            let values: Vec<f64> =
                run.outputs.variables.iter().map(|variable| get(&*alone, variable.name)).collect();
            assert_eq!(&values, outputs, "{}", model.description.name);
        }
    }
}

#[test]
fn every_input_moves() {
    for model in models() {
        let run = ReferenceRun::of(model.description, StartValues::TABLE).unwrap();
        for (column, variable) in run.inputs.variables.iter().enumerate() {
            let first = run.inputs.rows[0].1[column];
            let moves = run.inputs.rows.iter().any(|(_, values)| values[column] != first);
            assert!(moves, "{} of {}", variable.name, model.description.name);
        }
    }
}
