//! The loops of the system packages with their start values, in a master as packages get: all models step at once, then
//! exchange, and wires carry zeros in the first step. Not the bits are looked at but the physics.

use maglev_fmu::model::system::{BALL, BEARING, RIG, SYSTEMS, System};
use maglev_fmu::model::{ClosedLoop, ExchangeOrder, ModelError, ModelType, StartValues};
use maglev_fmu_test::closed_loop::closed_loop;
use maglev_fmu_test::values::{get, set};

/// The models as a package of a system starts them. Wires carry zeros before the first exchange.
fn started(system: &System, step_size: f64) -> ClosedLoop {
    started_with(system, StartValues::TABLE, step_size)
}

/// The same in a package with these values for the controller.
fn started_with(system: &System, controller: &StartValues, step_size: f64) -> ClosedLoop {
    let mut models = ClosedLoop::of(system, ExchangeOrder::Parallel);
    models.step_size = step_size;
    for model in [&mut models.plant, &mut models.controller] {
        let description = model.description();
        let is_controller = std::ptr::eq(description, system.controller.description);
        let wanted = if is_controller { controller } else { StartValues::TABLE };
        system.start_values_with(description, wanted).unwrap().apply(&mut **model);
        model.initialise(0.0).unwrap();
    }
    for wire in system.wires() {
        let is_of_plant = std::ptr::eq(wire.target, system.plant.description);
        let model = if is_of_plant { &mut models.plant } else { &mut models.controller };
        set(&mut **model, wire.input, 0.0);
    }
    models
}

/// As in the model's table.
fn start_value(model: &ModelType, name: &str) -> f64 {
    model.description.find(name).unwrap().1.start
}

/// Outputs `plant.*` and `controller.*` after each step.
struct Run {
    plant: Vec<Vec<f64>>,
    controller: Vec<Vec<f64>>,
}

impl Run {
    /// Of the package, for `duration` \[s\] in steps of `step_size` \[s\]. Wires are zero before the first exchange.
    fn of(system: &System, step_size: f64, duration: f64, plotted: [&[&str]; 2]) -> Result<Self, ModelError> {
        let mut models = started(system, step_size);
        let mut run = Self { plant: Vec::new(), controller: Vec::new() };
        for _ in 0..(duration / step_size).round() as usize {
            models.step()?;
            run.plant.push(plotted[0].iter().map(|name| get(&*models.plant, name)).collect());
            run.controller.push(plotted[1].iter().map(|name| get(&*models.controller, name)).collect());
        }
        Ok(run)
    }

    fn column(rows: &[Vec<f64>], column: usize) -> Vec<f64> {
        rows.iter().map(|row| row[column]).collect()
    }

    /// Largest error of an estimate from sample `first` on; the estimate after a step belongs to the outputs before.
    fn worst_error(&self, column: usize, first: usize) -> f64 {
        let (truth, estimate) = (Self::column(&self.plant, column), Self::column(&self.controller, column));
        let pairs = truth.iter().zip(&estimate[1..]).skip(first);
        pairs.map(|(truth, estimate)| (truth - estimate).abs()).fold(0.0, f64::max)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| f64::max(most, value.abs()))
}

/// Position of the bearing after `duration` \[s\] in the loop of the paper: the controller reads and ticks, then the
/// plant moves on with the new voltage.
fn bearing_of_the_paper(duration: f64) -> f64 {
    let mut models = closed_loop(&BEARING, &[], &[]);
    for _ in 0..(duration / models.step_size).round() as usize {
        models.step().unwrap();
    }
    get(&*models.plant, "position")
}

/// Samples that an observer needs.
const START_UP: usize = 20;

#[test]
fn the_bearing_moves_as_in_the_paper() {
    let names = ["position", "velocity", "flux"];
    let estimates = names.map(|name| format!("estimate.{name}"));
    let estimates = estimates.each_ref().map(String::as_str);
    let expected = bearing_of_the_paper(2.0);
    // Steps of which the sample time is a multiple.
    for steps in [1, 2, 4, 5] {
        let step_size = BEARING.step_size() / f64::from(steps);
        let run = Run::of(&BEARING, step_size, 2.0, [&names, &estimates]).unwrap();
        let end = run.plant.last().unwrap()[0];
        println!("bearing after 2 s: {end} m in steps of {step_size} s, in the paper's order {expected} m");
        // The voltage comes a step later, and so does the start.
        assert!((end / expected - 1.0).abs() < 0.02, "{end} m, expected {expected} m");
        for (column, name) in names.iter().enumerate() {
            let swing = largest(&Run::column(&run.plant, column));
            let error = run.worst_error(column, START_UP * steps as usize);
            assert!(error < 0.01 * swing, "{name}: {error:e}, swing {swing:e}, steps of {step_size} s");
        }
    }
}

/// Why the documents ask for such a step.
#[test]
fn the_rotor_is_lost_where_ticks_lie_within_steps() {
    let run = Run::of(&BEARING, 0.4e-3, 2.0, [&["position"], &["estimate.position"]]).unwrap();
    assert!(run.plant.last().unwrap()[0].abs() > 0.05);
}

#[test]
fn the_ball_is_up() {
    let names = ["position", "flux"];
    for step_size in [1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 7e-4, 8e-4, 1e-3] {
        let run = Run::of(&BALL, step_size, 1.0, [&names, &["estimate.position", "estimate.flux"]]).unwrap();
        let end = run.plant.last().unwrap();
        let lowest = Run::column(&run.plant, 0).into_iter().fold(0.0, f64::min);
        println!("ball in steps of {step_size} s: {end:?}, lowest {lowest} m");
        assert!(end[0].abs() < 1e-5, "{end:?} in steps of {step_size} s");
        // The estimator waits out its start-up, then needs some tens of milliseconds.
        let settled = (0.3 / step_size) as usize;
        let gap = start_value(BALL.plant, "gap");
        let flux = largest(&Run::column(&run.plant, 1));
        assert!(run.worst_error(0, settled) < 0.01 * gap);
        assert!(run.worst_error(1, settled) < 0.01 * flux);
    }
}

#[test]
fn the_ball_of_the_rig_stays_where_it_is() {
    let start = start_value(RIG.plant, "initial.position");
    for step_size in [1e-4, 3e-4, 4e-4, 5e-4, 7e-4, 8e-4, RIG.step_size()] {
        let plotted: [&[&str]; 2] = [&["position", "sensor_voltage"], &["estimate.si.position"]];
        let run = Run::of(&RIG, step_size, 2.0, plotted).unwrap();
        let off = run.plant.iter().map(|row| (row[0] - start).abs()).fold(0.0, f64::max);
        println!("rig: at most {off} m off, error {} m", run.worst_error(0, START_UP));
        assert!(off < 0.01 * start);
        assert!(run.worst_error(0, START_UP) < 0.01 * start);
        // A wire at zero means the operating point.
        assert!(run.plant.last().unwrap()[1].abs() < 1e-3);
    }
    assert!(get(&*started(&RIG, RIG.step_size()).plant, "sensor_voltage").abs() < 1e-12);
}

#[test]
fn steps_that_lose_the_loop_are_refused() {
    for system in [&BEARING, &BALL, &RIG] {
        let refused = Run::of(system, 0.01, 1.0, [&["position"], &["voltage"]]);
        let message = refused.err().expect("refused").to_string();
        assert!(message.contains("a step of 0.01 s: expected at most longest_step = 0.001 s"), "{message}");
    }
}

/// What the delay at the start is for: without it the observer of the bearing takes the zero of the first wire for a
/// motion, and the ball's for a place at the magnet.
#[test]
fn zeros_of_the_first_step_are_no_measurements() {
    for (system, name) in [(&BEARING, "estimate.flux"), (&BALL, "estimate.position")] {
        let truth = name.trim_start_matches("estimate.");
        let run = Run::of(system, system.step_size(), 0.01, [&[truth], &[name]]).unwrap();
        // In the first step ticks pass. The bearing's map is not exact where the flux changes sign, as it does here.
        let estimates = &Run::column(&run.controller, 0)[1..];
        let bound = 2.0 * largest(&Run::column(&run.plant, 0)).max(1e-3);
        assert!(estimates.iter().all(|estimate| estimate.abs() < bound), "{name}: {estimates:?}");
    }
}

/// Guards: packages with another sample time that named the step of the table, which lost the rotor (271 m after 2 s).
#[test]
fn another_sample_time_brings_its_own_step() {
    for (system, sample_time, step_size) in
        [(&BEARING, 5e-4, 5e-4), (&BEARING, 2.5e-4, 2.5e-4), (&RIG, 5e-4, 5e-4), (&BALL, 2e-4, 1e-4)]
    {
        let mut wanted = StartValues::default();
        wanted.set(system.controller.description, "sample_time", sample_time).unwrap();
        assert_eq!(system.step_size_with(&wanted), step_size, "{}", system.name);
        let mut models = started_with(system, &wanted, step_size);
        assert_eq!(get(&*models.controller, "start_delay"), step_size);
        for _ in 0..(2.0 / step_size).round() as usize {
            models.step().unwrap();
        }
        let (output, bound) = match system.name {
            "bearing" => ("position", 0.02),
            "ball" => ("position", 1e-4),
            _ => ("sensor_voltage", 1e-3),
        };
        let reached = get(&*models.plant, output);
        assert!(reached.abs() < bound, "{}, T = {sample_time} s: {output} = {reached}", system.name);
    }
}

#[test]
fn the_step_of_a_package_divides_its_sample_time() {
    for system in SYSTEMS {
        let suggested = system.step_size();
        assert_eq!(system.step_size_with(StartValues::TABLE), suggested);
        for factor in [1e-3, 0.3, 0.7, 1.0, 1.5, 2.0, 3.0, 7.3, 1000.0] {
            let mut wanted = StartValues::default();
            let sample_time = factor * suggested;
            if wanted.set(system.controller.description, "sample_time", sample_time).is_err() {
                continue;
            }
            let step_size = system.step_size_with(&wanted);
            let steps = sample_time / step_size;
            assert!(step_size <= suggested * (1.0 + 1e-12) && step_size > 0.49 * suggested.min(sample_time));
            assert!((steps - steps.round()).abs() < 1e-9 * steps, "{} {factor}: {step_size}", system.name);
        }
    }
}
