//! Sensors with a sample time: readings lie at its multiples, one number of the noise each, whoever solves the model and
//! however the time is cut. Without one, an importer that integrates a plant sees the value itself.

use maglev_fmu::model::Description;
use maglev_fmu::model::variable::{Kind, Variable};
use maglev_fmu::package::dependencies;

use super::harness::{BOTH, Component, OK, Standard, description, plants};

const SAMPLE_TIME: f64 = 1e-3;

/// What the sensor of a plant reads, and the reading.
fn sensor(model: &str) -> (&'static str, &'static str) {
    let reading = reading(description(model));
    (reading.name.strip_suffix("_measured").unwrap(), reading.name)
}

/// The output that is noisy.
fn reading(description: &Description) -> &'static Variable {
    let (noise, _) = description.find("sensor.noise").unwrap();
    let mut rows = description.variables.iter().zip(dependencies(description));
    rows.find(|(_, follows)| follows.initially.contains(&noise)).unwrap().0
}

/// A plant that moves, with a noisy sensor.
fn prepare(component: &Component, sample_time: f64) {
    let Kind::Real(quantity) = reading(component.description).kind else { panic!("a real number") };
    assert_eq!(component.set("sensor.noise", 1e-3 * quantity.nominal), OK);
    assert_eq!(component.set("sensor.sample_time", sample_time), OK);
    assert_eq!(component.set("initial.velocity", 0.01), OK);
    component.initialise(0.0);
    assert_eq!(component.set("voltage", 0.5), OK);
}

fn stepped(standard: Standard, model: &str, sample_time: f64) -> Component {
    let component = Component::new(standard, model);
    prepare(&component, sample_time);
    component
}

fn integrated(standard: Standard, model: &str, sample_time: f64) -> Component {
    let component = Component::exchanged(standard, model);
    prepare(&component, sample_time);
    component
}

/// Readings at the first multiples of the sample time, the start included, of a sensor that is read once per step.
fn readings_of_steps(standard: Standard, model: &str, count: usize) -> Vec<f64> {
    let component = stepped(standard, model, 0.0);
    let (_, reading) = sensor(model);
    (0..count)
        .map(|k| {
            if k > 0 {
                assert_eq!(component.step((k - 1) as f64 * SAMPLE_TIME, SAMPLE_TIME), OK);
            }
            component.get(reading)
        })
        .collect()
}

/// What the plants promise of a step.
fn assert_same(one: f64, other: f64, context: &str) {
    assert!((one - other).abs() <= 1e-9 * one.abs().max(1e-3), "{context}: {one} {other}");
}

#[test]
fn readings_do_not_depend_on_how_the_time_is_cut_into_steps() {
    for (standard, model) in plants() {
        let expected = readings_of_steps(standard, model, 40);
        let (_, reading) = sensor(model);
        for steps_per_sample in [1.0, 4.0, 2.0 / 7.0, 0.3, 1.7] {
            let component = stepped(standard, model, SAMPLE_TIME);
            let step = SAMPLE_TIME / steps_per_sample;
            assert_eq!(component.get(reading).to_bits(), expected[0].to_bits());
            let steps = (38.0 * steps_per_sample) as u32;
            for k in 0..steps {
                assert_eq!(component.step(f64::from(k) * step, step), OK);
                // The multiple at the step's end belongs to it.
                let last = (f64::from(k + 1) / steps_per_sample + 1e-6).floor() as usize;
                let context = format!("{standard:?} {model}, {steps_per_sample} steps per sample, step {k}");
                if steps_per_sample == 1.0 {
                    assert_eq!(component.get(reading).to_bits(), expected[last].to_bits(), "{context}");
                }
                assert_same(component.get(reading), expected[last], &context);
            }
        }
    }
}

/// Moves the states of a plant that an importer integrates from `time` over `h` \[s\], in many small steps.
fn integrate(component: &Component, time: f64, h: f64) {
    let steps = 10;
    let step = h / f64::from(steps);
    for k in 0..steps {
        let start = component.states();
        let rate = |share: f64, slope: &[f64]| {
            let states: Vec<f64> = start.iter().zip(slope).map(|(x, k)| x + share * step * k).collect();
            assert_eq!(component.set_time(time + (f64::from(k) + share) * step), OK);
            assert_eq!(component.set_states(&states), OK);
            component.derivatives()
        };
        let first = rate(0.0, &start);
        let second = rate(0.5, &first);
        let third = rate(0.5, &second);
        let fourth = rate(1.0, &third);
        let mean: Vec<f64> =
            (0..start.len()).map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0).collect();
        rate(1.0, &mean);
    }
}

#[test]
fn an_importer_that_integrates_comes_to_every_reading_once() {
    for (standard, model) in plants() {
        let expected = readings_of_steps(standard, model, 30);
        let component = integrated(standard, model, SAMPLE_TIME);
        let (value, reading) = sensor(model);
        let (status, _, mut next) = component.event_iteration();
        assert_eq!((status, next), (OK, Some(SAMPLE_TIME)));
        assert_eq!(component.get(reading).to_bits(), expected[0].to_bits());
        let mut time = 0.0;
        for (k, expected_reading) in expected.iter().enumerate().skip(1) {
            let event = next.expect("a time event");
            // The multiple itself, counted and not added up.
            assert_eq!(event.to_bits(), (k as f64 * SAMPLE_TIME).to_bits());
            assert_eq!(component.enter_continuous_time(), OK);
            let held = component.get(reading);
            // An event of another kind in between reads nothing and moves no reading.
            let half = 0.5 * (event - time);
            integrate(&component, time, half);
            assert_eq!(component.enter_event_mode(), OK);
            for _ in 0..2 {
                assert_eq!(component.event_iteration().2, Some(event), "{standard:?} {model} {k}");
            }
            assert_eq!(component.enter_continuous_time(), OK);
            integrate(&component, time + half, half);
            assert_eq!(component.get(reading).to_bits(), held.to_bits(), "held until the event");
            assert_ne!(component.get(value), held);
            // Both standards let an importer be a little late, and rounding makes it early.
            let lateness = [0.0, 1e-12, -1e-12, 3e-12][k % 4];
            assert_eq!(component.set_time(event + lateness), OK);
            assert_eq!(component.enter_event_mode(), OK);
            next = component.event_iteration().2;
            let context = format!("{standard:?} {model}, reading {k}");
            assert_same(component.get(reading), *expected_reading, &context);
            // The same event again reads nothing again.
            let read = component.get(reading);
            assert_eq!(component.event_iteration().2, next);
            assert_eq!(component.get(reading).to_bits(), read.to_bits(), "{context}");
            time = event + lateness;
        }
    }
}

#[test]
fn an_importer_that_misses_readings_gets_one_and_goes_on() {
    for (standard, model) in plants() {
        let component = integrated(standard, model, SAMPLE_TIME);
        component.update_discrete_states();
        assert_eq!(component.enter_continuous_time(), OK);
        for (time, next) in [(2.5 * SAMPLE_TIME, 3.0), (7.0 * SAMPLE_TIME, 8.0), (1e3, 1e6 + 1.0)] {
            assert_eq!(component.set_time(time), OK);
            assert_eq!(component.enter_event_mode(), OK);
            assert_eq!(component.event_iteration().2, Some(next * SAMPLE_TIME), "{standard:?} {model}");
            assert_eq!(component.enter_continuous_time(), OK);
        }
        // So late that there is no later time.
        assert_eq!(component.set_time(1e300), OK);
        assert_eq!(component.enter_event_mode(), OK);
        assert_eq!(component.event_iteration(), (OK, false, None));
    }
}

#[test]
fn readings_go_on_from_a_saved_state() {
    for (standard, model) in plants() {
        let (_, reading) = sensor(model);
        let (whole, cut) = (stepped(standard, model, SAMPLE_TIME), stepped(standard, model, SAMPLE_TIME));
        let step = 0.4 * SAMPLE_TIME;
        for k in 0..50 {
            let time = f64::from(k) * step;
            assert_eq!(whole.step(time, step), OK);
            let restored = Component::new(standard, model);
            assert_eq!(restored.restore_bytes(&cut.saved_bytes()), OK);
            assert_eq!(restored.step(time, step), OK);
            assert_eq!(cut.restore_bytes(&restored.saved_bytes()), OK);
            assert_eq!(cut.get(reading).to_bits(), whole.get(reading).to_bits(), "{model} {k}");
        }
        // In model exchange, too; the time goes back with it.
        let component = integrated(standard, model, SAMPLE_TIME);
        component.update_discrete_states();
        assert_eq!(component.enter_continuous_time(), OK);
        let event = || {
            assert_eq!(component.set_time(SAMPLE_TIME), OK);
            assert_eq!(component.enter_event_mode(), OK);
            let next = component.event_iteration().2;
            (component.get(reading).to_bits(), next)
        };
        let saved = component.saved_bytes();
        let first = event();
        assert_eq!(component.restore_bytes(&saved), OK);
        assert_eq!(event(), first, "{standard:?} {model}");
    }
}

#[test]
fn a_state_from_before_the_start_fits_both_interfaces() {
    for (standard, model) in plants() {
        let (value, reading) = sensor(model);
        let (stepped, exchanged) = (Component::new(standard, model), Component::exchanged(standard, model));
        for component in [&stepped, &exchanged] {
            assert_eq!(component.set("sensor.noise", 1e-3), OK);
            assert_eq!(component.enter_initialization(0.0, None), OK);
        }
        let noisy = stepped.get(reading);
        assert_ne!(noisy, stepped.get(value));
        assert_eq!(exchanged.get(reading), exchanged.get(value));
        let saved = exchanged.saved_bytes();
        assert_eq!(exchanged.restore_bytes(&stepped.saved_bytes()), OK);
        assert_eq!(stepped.restore_bytes(&saved), OK);
        assert_eq!(exchanged.get(reading), exchanged.get(value));
        assert_eq!(stepped.get(reading).to_bits(), noisy.to_bits());
    }
}

#[test]
fn without_a_sample_time_an_importer_sees_the_value_itself() {
    for (standard, model) in plants() {
        let (value, reading) = sensor(model);
        let component = Component::exchanged(standard, model);
        assert_eq!(component.set("sensor.noise", 1e-3), OK);
        assert_eq!(component.set("sensor.resolution", 0.25), OK);
        component.initialise(0.0);
        assert_eq!(component.event_iteration().2, None);
        assert_eq!(component.get(reading), component.get(value));
        assert_eq!(component.enter_continuous_time(), OK);
        let mut states = component.states();
        states[0] += 1e-4;
        assert_eq!(component.set_states(&states), OK);
        assert_eq!(component.get(reading), component.get(value), "{standard:?} {model}");
        assert_eq!(component.set_time(1e-3), OK);
        assert_eq!(component.enter_event_mode(), OK);
        assert_eq!(component.event_iteration().2, None);
        assert_eq!(component.get(reading), component.get(value));
    }
}

#[test]
fn what_the_voltage_drives_flows_at_once_in_model_exchange() {
    for standard in BOTH {
        let rig = Component::in_continuous_time(standard, "MaglevRigPlant");
        for (asked, acts) in [(0.76, 0.76), (-3.0, 0.0), (7.0, 5.0)] {
            assert_eq!(rig.set("voltage", asked), OK);
            assert_eq!(rig.get("voltage_measured"), acts);
            assert_eq!(rig.get("current"), 1.05 * acts);
        }
        assert_eq!(rig.set("voltage", 0.76), OK);
        integrate(&rig, 0.0, 1e-3);
        assert!((rig.get("current") - 0.797).abs() < 2e-3, "{}", rig.get("current"));
        assert_eq!(rig.get("sensor_voltage_measured"), rig.get("sensor_voltage"));
        // The range of the sensor is part of what it shows in continuous time: 40 mm are beyond it.
        assert_eq!(rig.set_states(&[0.04, 0.0]), OK);
        assert_eq!((rig.get("sensor_voltage_measured"), rig.get("sensor_voltage") > 1.25), (1.25, true));
        let row = rig.reference("sensor_voltage_measured");
        assert_eq!(rig.partial(row, rig.reference("position")), 0.0);
        assert_eq!(rig.partial(row, rig.reference("sensor.maximum")), 1.0);

        // In co-simulation it is what the last step has seen.
        let rig = Component::new(standard, "MaglevRigPlant");
        rig.initialise(0.0);
        assert_eq!((rig.get("current"), rig.get("voltage_measured")), (0.0, 0.0));
        assert_eq!(rig.step(0.0, 1e-3), OK);
        let acted = rig.get("voltage");
        assert_eq!(rig.set("voltage", 2.0), OK);
        assert_eq!((rig.get("current"), rig.get("voltage_measured")), (1.05 * acted, acted));
        for name in ["current", "voltage_measured"] {
            assert_eq!(rig.partial(rig.reference(name), rig.reference("voltage")), 0.0);
            assert_eq!(rig.output_slope(rig.reference(name)), 0.0);
        }
    }
}

#[test]
fn a_sample_time_that_nobody_could_step_through_is_refused() {
    for (standard, model) in plants() {
        for component in [Component::new(standard, model), Component::exchanged(standard, model)] {
            assert_eq!(component.enter_initialization(0.0, None), OK);
            component.recorder.clear();
            for sample_time in [1e-9, 5e-324, 9.99e-7] {
                assert_eq!(component.set("sensor.sample_time", sample_time), OK);
                let said = format!("sensor.sample_time = {sample_time:e} s: expected 0 or at least 1e-6 s");
                component.assert_refused(component.exit_initialization(), &[&said]);
            }
            assert_eq!(component.set("sensor.sample_time", 1e-6), OK);
            assert_eq!(component.exit_initialization(), OK);
        }
    }
}
