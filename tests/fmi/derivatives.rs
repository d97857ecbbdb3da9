//! Partial derivatives in closed form against differences.

use maglev_fmu::fmi::fmi3::fmi3GetAdjointDerivative;
use maglev_fmu::model::variable::Causality;
use proptest::prelude::*;

use super::differences::{assert_close, inputs, is_derivative, nominal, reals, scale, slope, unknowns};
use super::harness::{BOTH, Component, DISCARD, OK, PLANT, Standard, plants};

/// States around which a plant is differentiated: those of its start, moved by shares of their nominal values.
fn moved_states(component: &Component, shares: &[f64]) -> Vec<f64> {
    let nominals = component.nominals();
    let states = component.states();
    // Positions stay away from the stops.
    (0..states.len()).map(|i| states[i] + if i == 0 { 0.01 } else { 0.5 } * shares[i] * nominals[i]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn partial_derivatives_are_those_of_the_values(
        shares in prop::array::uniform4(-1.0..1.0f64), forces in prop::array::uniform2(0.1..1.0f64),
    ) {
        for (standard, model) in plants() {
            let component = Component::in_continuous_time(standard, model);
            let states = moved_states(&component, &shares);
            prop_assert_eq!(component.set_states(&states), OK);
            for (input, share) in inputs(&component).into_iter().zip(forces) {
                let value = share * nominal(&component, input);
                prop_assert_eq!(component.set_reference(input, value), OK);
            }
            let state_rows: Vec<u32> =
                component.description.continuous_states().map(|(state, _)| state as u32).collect();
            for unknown in unknowns(&component) {
                let name = component.variable(unknown).name;
                for (index, known) in state_rows.iter().enumerate() {
                    let at = |offset: f64| {
                        let mut shifted = states.clone();
                        shifted[index] += offset;
                        assert_eq!(component.set_states(&shifted), OK);
                        component.get_reference(unknown).1
                    };
                    // The bearing's acceleration has a kink at zero flux.
                    let size = nominal(&component, *known) * 1e-2;
                    let is_kink = component.variable(*known).name == "flux" && states[index].abs() < size;
                    if is_kink {
                        continue;
                    }
                    let difference = slope(size, at);
                    at(0.0);
                    let context = format!("{model}: {name} by state {index}");
                    assert_close(component.partial(unknown, *known), difference, scale(&component, unknown, *known), &context);
                }
                for known in inputs(&component) {
                    let value = component.get_reference(known).1;
                    let at = |offset: f64| {
                        assert_eq!(component.set_reference(known, value + offset), OK);
                        component.get_reference(unknown).1
                    };
                    let difference = slope(nominal(&component, known), at);
                    at(0.0);
                    let context = format!("{model}: {name} by {}", component.variable(known).name);
                    assert_close(component.partial(unknown, known), difference, scale(&component, unknown, known), &context);
                }
            }
        }
    }

    #[test]
    fn initial_partial_derivatives_are_those_of_initialisation(shares in prop::collection::vec(0.8..1.2f64, 64)) {
        let instances = plants().flat_map(|(standard, model)| {
            [Component::new(standard, model), Component::exchanged(standard, model)]
        });
        for component in instances {
            let model = component.description.name;
            prop_assert_eq!(component.enter_initialization(0.0, None), OK);
            let knowns = reals(&component, |row| matches!(component.variable(row).causality, Causality::Parameter | Causality::Input));
            for (known, share) in knowns.iter().zip(&shares) {
                let row = component.variable(*known);
                let size = 0.1 * nominal(&component, *known);
                let start = match row.start {
                    0.0 if row.range.1 <= 0.0 => -size,
                    0.0 => size,
                    start => start,
                };
                // An ideal sensor, whose reading has a derivative, and in model exchange none that is read.
                let value = if is_off(row.name) { 0.0 } else { start * share };
                prop_assert_eq!(component.set_reference(*known, value), OK, "{} {}", row.name, value);
            }
            let found = reals(&component, |row| {
                let causality = component.variable(row).causality;
                matches!(causality, Causality::Output | Causality::CalculatedParameter) || is_derivative(&component, row)
            });
            for known in &knowns {
                let row = component.variable(*known);
                if is_off(row.name) {
                    continue;
                }
                let value = component.get_reference(*known).1;
                for unknown in &found {
                    let at = |offset: f64| {
                        assert_eq!(component.set_reference(*known, value + offset), OK, "{}", row.name);
                        component.get_reference(*unknown).1
                    };
                    let difference = slope(value.abs(), at);
                    at(0.0);
                    let size = nominal(&component, *unknown).max(component.get_reference(*unknown).1.abs()) / value.abs();
                    let context = format!("{model}: initial {} by {}", component.variable(*unknown).name, row.name);
                    assert_close(component.partial(*unknown, *known), difference, size, &context);
                }
            }
        }
    }

}

/// Parameters of a sensor that are 0 where its output is to have derivatives.
fn is_off(name: &str) -> bool {
    name == "sensor.resolution" || name == "sensor.sample_time"
}

#[test]
fn derivatives_that_overflow_are_discarded_like_values() {
    for standard in BOTH {
        let ball = Component::new(standard, "LevitatedBallPlant");
        ball.initialise(0.0);
        ball.recorder.clear();
        assert_eq!(ball.set("voltage", 1.7e308), OK);
        let mut slope = [f64::NAN];
        let current = ball.reference("current");
        assert_eq!(ball.try_output_slope(current, &mut slope), DISCARD);
        assert!(slope[0].is_nan(), "nothing is written");
        let text = &ball.recorder.take()[0].text;
        assert!(text.contains("derivative with respect to time of current"), "{text}");

        let ball = Component::in_continuous_time(standard, "LevitatedBallPlant");
        let [flux, acceleration, velocity] =
            ["flux", "acceleration", "velocity"].map(|name| ball.reference(name));
        assert_eq!(ball.set_states(&[0.0, 0.0, 1e200]), OK);
        let mut sensitivity = [-7.0, -7.0];
        let status = ball.directional(&[velocity, acceleration], &[flux], &[1e300], &mut sensitivity);
        assert_eq!((status, sensitivity), (DISCARD, [-7.0, -7.0]));
        let text = &ball.recorder.take()[0].text;
        assert!(text.contains("derivative along the seed of acceleration"), "{text}");
        if standard == Standard::Fmi3 {
            let mut sensitivity = [-7.0];
            let seed = [1e300];
            // SAFETY: a live handle, arrays of one element.
            let status = unsafe {
                let result = sensitivity.as_mut_ptr();
                fmi3GetAdjointDerivative(ball.handle, &acceleration, 1, &flux, 1, seed.as_ptr(), 1, result, 1)
            };
            assert_eq!((status, sensitivity), (DISCARD, [-7.0]));
        }
    }
}

#[test]
fn parameters_keep_their_derivatives_after_initialisation() {
    for (standard, model) in plants() {
        let component = Component::exchanged(standard, model);
        assert_eq!(component.set("initial.velocity", 0.01), OK);
        assert_eq!(component.enter_initialization(0.0, None), OK);
        let knowns = reals(&component, |row| {
            let variable = component.variable(row);
            variable.causality == Causality::Parameter && !variable.name.starts_with("initial.")
        });
        let unknowns = unknowns(&component);
        let jacobian = || -> Vec<f64> {
            unknowns.iter().flat_map(|u| knowns.iter().map(|k| component.partial(*u, *k))).collect()
        };
        let before = jacobian();
        assert_eq!(component.exit_initialization(), OK);
        let states: Vec<u32> =
            component.description.continuous_states().map(|(state, _)| state as u32).collect();
        // What the initial states owe to a parameter is gone once they are states in their own right.
        let owed: Vec<f64> = unknowns
            .iter()
            .flat_map(|u| {
                knowns.iter().map(|k| {
                    states
                        .iter()
                        .map(|s| component.partial(*u, *s) * initial_slope(standard, model, *s, *k))
                        .sum::<f64>()
                })
            })
            .collect();
        for ((before, after), owed) in before.iter().zip(jacobian()).zip(owed) {
            assert!((before - after - owed).abs() <= 1e-12 * before.abs().max(1.0), "{model}");
        }
    }
}

fn initial_slope(standard: Standard, model: &str, state: u32, parameter: u32) -> f64 {
    let component = Component::new(standard, model);
    assert_eq!(component.enter_initialization(0.0, None), OK);
    component.partial(state, parameter)
}

#[test]
fn adjoint_derivatives_are_the_transposed_ones() {
    for (_, model) in plants().filter(|(standard, _)| *standard == Standard::Fmi3) {
        let component = Component::in_continuous_time(Standard::Fmi3, model);
        let unknowns = unknowns(&component);
        let mut knowns = inputs(&component);
        knowns.extend(component.description.continuous_states().map(|(state, _)| state as u32));
        let seed: Vec<f64> = (0..unknowns.len()).map(|k| 1.0 + k as f64).collect();
        let mut sensitivity = vec![f64::NAN; knowns.len()];
        // SAFETY: a live handle, arrays of these lengths.
        let status = unsafe {
            fmi3GetAdjointDerivative(
                component.handle,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                sensitivity.len(),
            )
        };
        assert_eq!(status, OK);
        for (known, found) in knowns.iter().zip(&sensitivity) {
            let expected: f64 = unknowns
                .iter()
                .zip(&seed)
                .map(|(unknown, seed)| component.partial(*unknown, *known) * seed)
                .sum();
            assert!((found - expected).abs() <= 1e-14 * expected.abs());
        }
        assert!(sensitivity.iter().any(|value| *value != 0.0));
    }
}

#[test]
fn what_cannot_be_differentiated_is_named() {
    for standard in BOTH {
        let component = Component::in_continuous_time(standard, PLANT);
        let [position, noise, seed, epsilon] =
            ["position", "sensor.noise", "sensor.seed", "epsilon"].map(|name| component.reference(name));
        let mut room = [0.0];
        let mut ask = |unknown, known| component.directional(&[unknown], &[known], &[1.0], &mut room);
        component
            .assert_refused(ask(noise, position), &["sensor.noise", "is a parameter: expected an unknown"]);
        component.assert_refused(
            ask(position, epsilon),
            &["epsilon", "is a calculated parameter: expected a known"],
        );
        component.assert_refused(ask(position, seed), &["sensor.seed", "is no real number"]);
        component.assert_refused(ask(position, 999), &["value reference 999 is unknown"]);
        assert_eq!(ask(position, 0), OK, "time is a known");
    }
}
