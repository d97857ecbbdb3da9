//! One run of the rig's control loop through the packaged units.

use super::recording::{RIG, Reference, SAMPLE_TIME, SENSOR, SET_POINT};
use crate::host::Value;
use crate::plant::maglev_rig::MaglevRig;
use crate::study::StudyError;
use crate::study::loop_packages::{LoopPackages, Parameter};

/// Conditions of a run; everything else keeps the units' start values.
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
    pub push: (f64, f64),
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
            push: (0.0, 0.0),
            duration,
            parameters: parameters.to_vec(),
        }
    }
}

/// Samples of a run, one per tick.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// \[s\]
    pub time: Vec<f64>,
    /// r \[V\]
    pub reference: Vec<f64>,
    /// x \[m\]
    pub position: Vec<f64>,
    /// x' \[m/s\]
    pub velocity: Vec<f64>,
    /// x'' \[m/s2\] just after the tick.
    pub acceleration: Vec<f64>,
    /// Without noise \[V\].
    pub sensor_voltage: Vec<f64>,
    /// From the tick on \[V\].
    pub voltage: Vec<f64>,
    /// z1, z2, z3 in metres or volts as `observer.measurement` selects.
    pub estimate: [Vec<f64>; 3],
    /// y less what the observer expected of it, in metres or volts.
    pub innovation: Vec<f64>,
    /// Whether the ball touched a stop.
    pub contact: bool,
}

const RECORDED: [(&str, &str); 9] = [
    ("plant", "position"),
    ("plant", "velocity"),
    ("plant", "sensor_voltage"),
    ("controller", "voltage"),
    ("controller", "estimate.position"),
    ("controller", "estimate.velocity"),
    ("controller", "estimate.extended"),
    ("controller", "observer.residual"),
    ("plant", "contact"),
];

/// Runs a scenario.
pub fn simulate(packages: &LoopPackages, scenario: &Scenario) -> Result<Run, StudyError> {
    let Scenario { set_point, noise, seed, mass_ratio, push: (push, push_from), .. } = *scenario;
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
    let is_pushed = |time: f64| push != 0.0 && time >= push_from - 0.5 * SAMPLE_TIME;
    let trace = packages.simulate_with(
        &plant,
        &controller,
        &RECORDED,
        SAMPLE_TIME,
        scenario.duration,
        |time, controller, plant| {
            if scenario.reference != Reference::Hold {
                controller.set_by_name("reference", wanted(time))?;
            }
            if is_pushed(time) {
                plant.set_by_name("force", rig.mass * push)?;
            }
            Ok(())
        },
    )?;
    let mut columns = trace.columns.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    let mut run = Run {
        position: next(),
        velocity: next(),
        sensor_voltage: next(),
        voltage: next(),
        estimate: [next(), next(), next()],
        innovation: next(),
        contact: next().iter().any(|contact| *contact != 0.0),
        ..Run::default()
    };
    run.reference = trace.time.iter().map(|time| wanted(*time)).collect();
    run.acceleration = trace
        .time
        .iter()
        .zip(run.position.iter().zip(&run.voltage))
        .map(|(time, (position, voltage))| {
            let force = if is_pushed(*time) { rig.mass * push } else { 0.0 };
            rig.acceleration(*position, *voltage, force)
        })
        .collect();
    run.time = trace.time;
    Ok(run)
}

/// The unit in which an observer works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measurement {
    Metres,
    Volts,
}

impl Run {
    /// True x1, x2, x3 = x'' - b u in the observer's unit, over time.
    pub fn truth(&self, measurement: Measurement, input_gain: f64) -> [Vec<f64>; 3] {
        let scale = match measurement {
            Measurement::Metres => 1.0,
            Measurement::Volts => SENSOR.gain,
        };
        let position = match measurement {
            Measurement::Metres => self.position.clone(),
            Measurement::Volts => self.sensor_voltage.clone(),
        };
        let extended = self.acceleration.iter().zip(&self.voltage);
        [
            position,
            self.velocity.iter().map(|velocity| scale * velocity).collect(),
            extended.map(|(acceleration, voltage)| scale * acceleration - input_gain * voltage).collect(),
        ]
    }

    /// Root mean square of truth minus estimate of z1, z2, z3 from `start` \[s\] on.
    pub fn errors(&self, measurement: Measurement, input_gain: f64, start: f64) -> [f64; 3] {
        let truth = self.truth(measurement, input_gain);
        core::array::from_fn(|state| {
            let both = truth[state].iter().zip(&self.estimate[state]).zip(&self.time);
            let scored = both.filter(|(_, time)| **time >= start - 0.5 * SAMPLE_TIME);
            root_mean_square(scored.map(|((truth, estimate), _)| truth - estimate))
        })
    }
}

/// sqrt(mean x^2)
pub fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    if count > 0.0 { libm::sqrt(sum / count) } else { f64::NAN }
}

/// Largest magnitude.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |peak, value| peak.max(value.abs()))
}
