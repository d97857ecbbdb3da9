//! Derivatives with respect to time: of inputs within a step, of outputs at its end.

use maglev_fmu::fmi::fmi2::fmi2SetRealInputDerivatives;
use maglev_fmu::model::variable::Causality;
use maglev_fmu::package::dependencies;
use proptest::prelude::*;

use super::differences::{assert_close, inputs, nominal, reals, slope};
use super::harness::{Component, OK, PLANT, Phase, Standard, plants};

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn outputs_move_with_their_slopes(ramp in -1.0..1.0f64, shares in prop::array::uniform2(0.1..1.0f64)) {
        for (standard, model) in plants() {
            let duration = 1e-3;
            // Steps to a time close to `duration`.
            let stepped = |offset: f64| {
                let component = Component::new(standard, model);
                component.initialise(0.0);
                for (input, share) in inputs(&component).into_iter().zip(shares) {
                    assert_eq!(component.set_reference(input, 0.1 * share * nominal(&component, input)), OK);
                    if standard == Standard::Fmi2 {
                        let slope = 10.0 * ramp * nominal(&component, input);
                        // SAFETY: a live handle, arrays of one element.
                        let status = unsafe { fmi2SetRealInputDerivatives(component.handle, &input, 1, &1, &slope) };
                        assert_eq!(status, OK);
                    }
                }
                assert_eq!(component.step(0.0, duration + offset), OK);
                component
            };
            let end = stepped(0.0);
            for output in reals(&end, |row| end.variable(row).causality == Causality::Output) {
                let exact = end.output_slope(output);
                if is_of_the_last_step(&end, output) {
                    prop_assert_eq!(exact, 0.0);
                    continue;
                }
                let difference = slope(0.1 * duration, |offset| stepped(offset).get_reference(output).1);
                let size = nominal(&end, output).max(end.get_reference(output).1.abs()) / duration;
                let context = format!("{model}: slope of {}", end.variable(output).name);
                assert_close(exact, difference, 1e-1 * size, &context);
            }
        }
    }
}

/// Outputs that tell of the last step in co-simulation and do not move until the next one: readings, and what follows from an
/// input, which may have another value by then.
fn is_of_the_last_step(component: &Component, output: u32) -> bool {
    let description = component.description;
    let follows = dependencies(description).swap_remove(output as usize);
    let is_input = |row: usize| description.variables[row].causality == Causality::Input;
    let (noise, _) = description.find("sensor.noise").unwrap();
    follows.at_an_instant.iter().any(|(row, _)| is_input(*row)) || follows.initially.contains(&noise)
}

#[test]
fn a_ramp_is_the_limit_of_short_held_steps() {
    for (_, model) in plants().filter(|(standard, _)| *standard == Standard::Fmi2) {
        let new = || {
            let component = Component::new(Standard::Fmi2, model);
            component.initialise(0.0);
            component
        };
        let (ramp, held) = (new(), new());
        let inputs = inputs(&ramp);
        let (begin, slopes): (Vec<f64>, Vec<f64>) =
            inputs.iter().map(|input| (0.01 * nominal(&ramp, *input), 30.0 * nominal(&ramp, *input))).unzip();
        let orders = vec![1; inputs.len()];
        assert_eq!(ramp.set_reals(&inputs, &begin), OK);
        // SAFETY: a live handle, arrays of these lengths.
        let status = unsafe {
            fmi2SetRealInputDerivatives(
                ramp.handle,
                inputs.as_ptr(),
                inputs.len(),
                orders.as_ptr(),
                slopes.as_ptr(),
            )
        };
        assert_eq!(status, OK);
        for k in 0..2 {
            assert_eq!(ramp.step(f64::from(k) * 1e-3, 1e-3), OK);
        }
        let steps = 2000;
        let h = 2e-3 / f64::from(steps);
        for k in 0..steps {
            let middle = (f64::from(k) + 0.5) * h;
            let values: Vec<f64> = begin.iter().zip(&slopes).map(|(u, s)| u + s * middle).collect();
            assert_eq!(held.set_reals(&inputs, &values), OK);
            assert_eq!(held.step(f64::from(k) * h, h), OK);
        }
        let size = ramp.nominal_sizes();
        for ((state, _), size) in ramp.description.continuous_states().zip(size) {
            let name = ramp.description.variables[state].name;
            let (one, many) = (ramp.get(name), held.get(name));
            assert!((one - many).abs() < 1e-7 * size, "{model} {name}: {one} {many}");
        }
        // The input has moved along, and the mean of the last step is told.
        for (input, (begin, slope)) in inputs.iter().zip(begin.iter().zip(&slopes)) {
            let expected = begin + slope * 2e-3;
            assert!((ramp.get_reference(*input).1 - expected).abs() <= 1e-12 * expected.abs());
        }
        let voltage = inputs.iter().position(|input| ramp.variable(*input).name == "voltage").unwrap();
        let mean = begin[voltage] + slopes[voltage] * 1.5e-3;
        assert!((ramp.get("voltage_measured") - mean).abs() <= 1e-12 * mean);
    }
}

impl Component {
    fn nominal_sizes(&self) -> Vec<f64> {
        self.description.continuous_states().map(|(state, _)| nominal(self, state as u32)).collect()
    }
}

#[test]
fn what_is_no_slope_of_an_input_is_named() {
    let component = Component::in_phase(Standard::Fmi2, PLANT, Phase::Step);
    let [voltage, position] = ["voltage", "position"].map(|name| component.reference(name));
    let ask = |row: u32, order: i32, value: f64| {
        // SAFETY: a live handle, arrays of one element.
        unsafe { fmi2SetRealInputDerivatives(component.handle, &row, 1, &order, &value) }
    };
    component.assert_refused(ask(voltage, 2, 1.0), &["order 2 of the derivative of voltage: expected 1"]);
    component.assert_refused(ask(voltage, 0, 1.0), &["order 0 of the derivative of voltage: expected 1"]);
    component
        .assert_refused(ask(position, 1, 1.0), &["position", "is an output: expected a continuous input"]);
    component.assert_refused(ask(voltage, 1, f64::NAN), &["derivative of voltage = NaN V/s"]);
    assert_eq!(ask(voltage, 1, 0.0), OK);
}
