//! Derivatives in closed form against differences: between variables, of inputs and of outputs with respect to time.

use maglev_fmu::fmi::fmi2::fmi2SetRealInputDerivatives;
use maglev_fmu::fmi::fmi3::fmi3GetAdjointDerivative;
use maglev_fmu::model::variable::{Causality, Kind, Variability};
use proptest::prelude::*;

use super::harness::{BOTH, Component, DISCARD, ERROR, OK, Standard, plants};

/// Derivative of `f` at 0 by central differences with Richardson extrapolation over three step sizes.
fn slope(size: f64, f: impl Fn(f64) -> f64) -> f64 {
    let difference = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let [coarse, middle, fine] = [1e-2, 5e-3, 2.5e-3].map(|share| difference(share * size));
    let [first, second] = [(4.0 * middle - coarse) / 3.0, (4.0 * fine - middle) / 3.0];
    (16.0 * second - first) / 15.0
}

/// Value references of real variables that `keep` keeps.
fn reals(component: &Component, keep: impl Fn(u32) -> bool) -> Vec<u32> {
    (0..component.description.variables.len() as u32)
        .filter(|row| matches!(component.variable(*row).kind, Kind::Real(_)) && keep(*row))
        .collect()
}

fn is_derivative(component: &Component, row: u32) -> bool {
    component.variable(row).derivative_of.is_some()
}

/// Continuous outputs and state derivatives.
fn unknowns(component: &Component) -> Vec<u32> {
    reals(component, |row| {
        let variable = component.variable(row);
        let is_output =
            variable.causality == Causality::Output && variable.variability == Variability::Continuous;
        is_output || is_derivative(component, row)
    })
}

fn inputs(component: &Component) -> Vec<u32> {
    reals(component, |row| component.variable(row).causality == Causality::Input)
}

/// A quantity's usual size.
fn nominal(component: &Component, row: u32) -> f64 {
    let Kind::Real(quantity) = component.variable(row).kind else { unreachable!() };
    quantity.nominal
}

/// States around which a plant is differentiated: those of its start, moved by shares of their nominal values.
fn moved_states(component: &Component, shares: &[f64]) -> Vec<f64> {
    let nominals = component.nominals();
    let states = component.states();
    // Positions stay away from the stops.
    (0..states.len()).map(|i| states[i] + if i == 0 { 0.01 } else { 0.5 } * shares[i] * nominals[i]).collect()
}

fn assert_close(exact: f64, difference: f64, scale: f64, context: &str) {
    let error = (exact - difference).abs();
    assert!(error <= 1e-8 * exact.abs().max(scale), "{context}: {exact} against {difference}");
}

/// Unit in which a derivative of `unknown` with respect to `known` is measured.
fn scale(component: &Component, unknown: u32, known: u32) -> f64 {
    let value = component.get_reference(unknown).1.abs();
    nominal(component, unknown).max(value) / nominal(component, known)
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

/// Parameters of a sensor that are 0 where its output is to have derivatives.
fn is_off(name: &str) -> bool {
    name == "sensor.resolution" || name == "sensor.sample_time"
}

/// Outputs that tell of the last step in co-simulation and do not move until the next one: readings, and what follows from an
/// input, which may have another value by then.
fn is_of_the_last_step(component: &Component, output: u32) -> bool {
    let description = component.description;
    let follows = description.dependencies().swap_remove(output as usize);
    let is_input = |row: usize| description.variables[row].causality == Causality::Input;
    let (noise, _) = description.find("sensor.noise").unwrap();
    follows.at_an_instant.iter().any(|(row, _)| is_input(*row)) || follows.initially.contains(&noise)
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
fn what_cannot_be_differentiated_is_named() {
    for standard in BOTH {
        let component = Component::in_continuous_time(standard, super::harness::PLANT);
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
    let component = Component::in_phase(Standard::Fmi2, super::harness::PLANT, super::harness::Phase::Step);
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
    assert_eq!(ERROR, 3);
}
