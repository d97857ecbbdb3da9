//! One run of the rig's control loop through the packaged models.

use super::recording::{RIG, Reference, SAMPLE_TIME, SENSOR, SET_POINT};
use crate::host::Value;
use crate::plant::maglev_rig::MaglevRig;
use crate::study::StudyError;
use crate::study::loop_packages::{LoopPackages, Parameter};
use crate::study::metrics::{difference, root_mean_square};
use crate::study::run::Run;

/// Conditions of a run; everything else keeps the models' start values.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Where the ball rests at first and is to stay \[m\].
    pub set_point: f64,
    pub reference: Reference,
    /// What the sine is multiplied by.
    pub amplitude: f64,
    /// Standard deviation of the sensor \[V\].
    pub noise: f64,
    pub seed: i32,
    /// Mass over that of Table 1.
    pub mass_ratio: f64,
    /// Acceleration \[m/s2\] by a disturbing force, and from when on \[s\].
    pub disturbance_step: (f64, f64),
    /// \[s\]
    pub duration: f64,
    /// Of the controller.
    pub parameters: Vec<Parameter<'static>>,
}

impl Scenario {
    pub fn new(reference: Reference, duration: f64, parameters: &[Parameter<'static>]) -> Self {
        Self {
            set_point: SET_POINT,
            reference,
            amplitude: 1.0,
            noise: 0.0,
            seed: 1,
            mass_ratio: 1.0,
            disturbance_step: (0.0, 0.0),
            duration,
            parameters: parameters.to_vec(),
        }
    }
}

/// r \[V\] and x'' \[m/s2\] just after the tick: columns that are added to what is recorded.
pub const REFERENCE: &str = "reference";
pub const ACCELERATION: &str = "acceleration";
/// States of the observer, in metres or volts as `observer.measurement` selects.
pub const ESTIMATES: [&str; 3] = ["position", "velocity", "extended"];

/// Runs a scenario.
pub fn simulate(packages: &LoopPackages, scenario: &Scenario) -> Result<Run, StudyError> {
    let Scenario { set_point, noise, seed, mass_ratio, disturbance_step: (acceleration, begin), .. } =
        *scenario;
    let rest = SENSOR.voltage(set_point);
    let rig = MaglevRig { mass: RIG.mass * mass_ratio, ..RIG };
    let plant = [
        ("initial.position", Value::Real(set_point)),
        ("mass", Value::Real(rig.mass)),
        ("sensor.noise", Value::Real(noise)),
        ("sensor.seed", Value::Integer(seed)),
    ];
    let mut controller = vec![
        ("sensor_voltage", Value::Real(rest)),
        ("reference", Value::Real(rest)),
        ("controller.operating_voltage", Value::Real(RIG.operating_voltage(set_point))),
    ];
    controller.extend_from_slice(&scenario.parameters);
    let wanted = |time: f64| rest + scenario.amplitude * scenario.reference.at(time);
    let is_disturbed = |time: f64| acceleration != 0.0 && time >= begin - 0.5 * SAMPLE_TIME;
    let run = packages.simulate_with(
        &plant,
        &controller,
        &[
            ("plant", "position"),
            ("plant", "velocity"),
            ("plant", "sensor_voltage"),
            ("plant", "contact"),
            ("controller", "voltage"),
            ("controller", "estimate.position"),
            ("controller", "estimate.velocity"),
            ("controller", "estimate.extended"),
            ("controller", "observer.residual"),
        ],
        SAMPLE_TIME,
        scenario.duration,
        |time, controller, plant| {
            if scenario.reference != Reference::Hold {
                controller.set_by_name("reference", wanted(time))?;
            }
            if is_disturbed(time) {
                plant.set_by_name("force", rig.mass * acceleration)?;
            }
            Ok(())
        },
    )?;
    let reference = run.time.iter().map(|time| wanted(*time)).collect();
    let samples = run.state("position").iter().zip(&run["controller.voltage"]);
    let acceleration = run.time.iter().zip(samples).map(|(time, (position, voltage))| {
        let force = if is_disturbed(*time) { rig.mass * acceleration } else { 0.0 };
        rig.acceleration(*position, *voltage, force)
    });
    let acceleration = acceleration.collect();
    Ok(run.with(REFERENCE, reference).with(ACCELERATION, acceleration))
}

/// The unit in which an observer works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measurement {
    Metres,
    Volts,
}

/// True x1, x2, x3 = x'' - b u in the observer's unit, over time.
pub fn truth(run: &Run, measurement: Measurement, input_gain: f64) -> [Vec<f64>; 3] {
    let (position, scale) = match measurement {
        Measurement::Metres => ("position", 1.0),
        Measurement::Volts => ("sensor_voltage", SENSOR.gain),
    };
    let extended = run[ACCELERATION].iter().zip(&run["controller.voltage"]);
    [
        run.state(position).to_vec(),
        run.state("velocity").iter().map(|velocity| scale * velocity).collect(),
        extended.map(|(acceleration, voltage)| scale * acceleration - input_gain * voltage).collect(),
    ]
}

/// Root mean square of truth minus estimate of z1, z2, z3 from `start` \[s\] on.
pub fn errors(run: &Run, measurement: Measurement, input_gain: f64, start: f64) -> [f64; 3] {
    let truth = truth(run, measurement, input_gain);
    core::array::from_fn(|state| {
        let error = difference(&truth[state], run.estimate(ESTIMATES[state]));
        root_mean_square(run.since(start, &error))
    })
}

/// y - r \[V\] without noise.
pub fn control_error(run: &Run) -> Vec<f64> {
    difference(run.state("sensor_voltage"), &run[REFERENCE])
}
