//! The paper's experiment natively, without models: digital PID on the rig, voltage held, plant by Runge-Kutta with ten
//! sub-steps per sample. Written apart from the plant's own integrator, as a second opinion.

use maglev_fmu::controller::digital_pid::{Derivative, DigitalPid, PidSettings};
use maglev_fmu::observer::extended_state::NonlinearInjection;
use maglev_fmu::observer::extended_state::gains_from_bandwidth;
use maglev_fmu::plant::maglev_rig::{MaglevRig, PositionSensor, State};
use maglev_fmu::signal::GaussianNoise;
use std::f64::consts::TAU;

pub const RIG: MaglevRig = MaglevRig::PRINTED;
pub const SENSOR: PositionSensor = PositionSensor::MANUAL;
pub const T: f64 = 1e-3;

/// Table 4.
pub fn table_4() -> NonlinearInjection {
    NonlinearInjection::new(gains_from_bandwidth(100.0), [1.0, 0.5, 0.25], [0.01; 3])
}

/// References in sensor volts around the set point, over time in s.
pub fn hold(_: f64) -> f64 {
    0.0
}

pub fn sine(time: f64) -> f64 {
    0.15 * (TAU * 0.5 * time).sin()
}

pub fn sine_step(time: f64) -> f64 {
    // Half a sample before 2 s, so that the rounding of the time does not matter.
    sine(time) + if time > 2.0 - 0.5 * T { 0.1 } else { 0.0 }
}

/// The PID of Table 2 as reconstructed, for a set point in m.
pub fn pid_settings(set_point: f64) -> PidSettings {
    PidSettings {
        proportional_gain: 4.2,
        integral_gain: 2.2,
        derivative_gain: 0.02,
        derivative: Derivative::Error,
        operating_voltage: RIG.operating_voltage(set_point),
        sample_time: T,
        limits: (0.0, 5.0),
    }
}

/// The state after one sample under a held voltage and force.
pub fn plant_step(state: State, voltage: f64, force: f64, substeps: u32) -> State {
    let h = T / f64::from(substeps);
    let rate = |s: State| (s.velocity, RIG.acceleration(s.position, voltage, force));
    let moved = |s: State, (v, a): (f64, f64), h: f64| State {
        position: s.position + h * v,
        velocity: s.velocity + h * a,
    };
    (0..substeps).fold(state, |s, _| {
        let first = rate(s);
        let second = rate(moved(s, first, h / 2.0));
        let third = rate(moved(s, second, h / 2.0));
        let fourth = rate(moved(s, third, h));
        State {
            position: s.position + h / 6.0 * (first.0 + 2.0 * second.0 + 2.0 * third.0 + fourth.0),
            velocity: s.velocity + h / 6.0 * (first.1 + 2.0 * second.1 + 2.0 * third.1 + fourth.1),
        }
    })
}

/// What is known at a sample, before the voltage acts.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub reference: f64,
    pub state: State,
    /// With noise \[V\].
    pub sensor_voltage: f64,
    /// From this sample on \[V\].
    pub voltage: f64,
}

impl Sample {
    /// True x'' \[m/s2\] just after the sample.
    pub fn acceleration(&self) -> f64 {
        RIG.acceleration(self.state.position, self.voltage, 0.0)
    }
}

/// PID loop of `samples` samples, starting at rest at `set_point` \[m\], with white sensor noise \[V\].
pub fn data_run(reference: fn(f64) -> f64, set_point: f64, samples: usize, noise: f64) -> Vec<Sample> {
    let settings = pid_settings(set_point);
    let mut pid = DigitalPid::default();
    let mut state = State { position: set_point, velocity: 0.0 };
    let mut source = GaussianNoise::new(7, 0);
    (0..samples)
        .map(|k| {
            let reference = SENSOR.voltage(set_point) + reference(k as f64 * T);
            let mut sensor_voltage = SENSOR.voltage(state.position);
            if noise > 0.0 {
                sensor_voltage += noise * source.sample();
            }
            let voltage = pid.update(&settings, sensor_voltage, reference);
            let sample = Sample { reference, state, sensor_voltage, voltage };
            state = plant_step(state, voltage, 0.0, 10);
            sample
        })
        .collect()
}

/// sqrt(mean e^2)
pub fn root_mean_square(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = errors.fold((0.0, 0u32), |(sum, count), error| (sum + error * error, count + 1));
    (sum / f64::from(count)).sqrt()
}
