//! The paper's experiment without models: the rig under its digital PID, as a recording that observers are run over.
//!
//! Voltage held between samples; the ball moves by ten Runge-Kutta steps per sample. What the models compute for the
//! same loop agrees to some ten digits (see the experiment's claims); tuning needs thousands of passes over the data, and
//! table 5 interpolates the measurement, which no sampled model can do.

use crate::controller::digital_pid::{Derivative, DigitalPid, PidSettings};
use crate::plant::maglev_rig::{MaglevRig, PositionSensor, State};
use crate::signal::GaussianNoise;

/// The plant of Table 1 and its sensor.
pub const RIG: MaglevRig = MaglevRig::PRINTED;
pub const SENSOR: PositionSensor = PositionSensor::MANUAL;
/// T \[s\], assumed; the paper prints none.
pub const SAMPLE_TIME: f64 = 1e-3;
/// Set point \[m\] unless told otherwise: the operating point of the rig's manual.
pub const SET_POINT: f64 = 9e-3;
/// Kp, Ki, Kd as printed, in sensor volts.
pub const GAINS: [f64; 3] = [4.2, 2.2, 0.02];
/// Range of the driver's input \[V\]: it attracts only.
pub const VOLTAGE_LIMITS: (f64, f64) = (0.0, 5.0);

/// Runge-Kutta steps of the plant per sample.
const SUBSTEPS: u32 = 10;

/// What is asked of the loop, in sensor volts around the set point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    Hold,
    /// 0.15 V at 0.5 Hz.
    Sine,
    /// The sine, and 0.1 V from 2 s on.
    SineAndStep,
    /// 0.05 V at 3 Hz.
    FastSine,
}

impl Reference {
    /// r - y0 \[V\] at a time \[s\].
    pub fn at(self, time: f64) -> f64 {
        let sine =
            |amplitude: f64, frequency: f64| amplitude * libm::sin(core::f64::consts::TAU * frequency * time);
        match self {
            Self::Hold => 0.0,
            Self::Sine => sine(0.15, 0.5),
            // Half a sample early, so that the rounding of the time does not matter.
            Self::SineAndStep => sine(0.15, 0.5) + if time > 2.0 - 0.5 * SAMPLE_TIME { 0.1 } else { 0.0 },
            Self::FastSine => sine(0.05, 3.0),
        }
    }
}

/// How the loop is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// \[m\]; also where the ball rests at first.
    pub set_point: f64,
    pub reference: Reference,
    /// Mass of the ball over that of Table 1.
    pub mass_ratio: f64,
    /// Standard deviation of the sensor's white noise \[V\].
    pub noise: f64,
    pub seed: u64,
    /// Acceleration \[m/s2\] by a disturbing force, and from when on \[s\].
    pub disturbance_step: (f64, f64),
    /// \[s\]
    pub duration: f64,
}

impl Conditions {
    /// Nothing unusual.
    pub const fn new(reference: Reference, duration: f64) -> Self {
        Self {
            set_point: SET_POINT,
            reference,
            mass_ratio: 1.0,
            noise: 0.0,
            seed: 1,
            disturbance_step: (0.0, 0.0),
            duration,
        }
    }
}

/// One sample per row, the first at 0 s, the last at the end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// r \[V\]
    pub reference: Vec<f64>,
    /// x \[m\]
    pub position: Vec<f64>,
    /// x' \[m/s\]
    pub velocity: Vec<f64>,
    /// x'' \[m/s2\] just after the sample.
    pub acceleration: Vec<f64>,
    /// With noise \[V\].
    pub sensor_voltage: Vec<f64>,
    /// From this sample on \[V\].
    pub voltage: Vec<f64>,
}

impl Recording {
    /// Runs the loop.
    pub fn make(conditions: &Conditions) -> Self {
        let Conditions { set_point, noise, disturbance_step: (acceleration, begin), .. } = *conditions;
        let rig = MaglevRig { mass: RIG.mass * conditions.mass_ratio, ..RIG };
        let settings = PidSettings {
            proportional_gain: GAINS[0],
            integral_gain: GAINS[1],
            derivative_gain: GAINS[2],
            derivative: Derivative::Error,
            // As for the printed mass: the controller does not know another.
            operating_voltage: RIG.operating_voltage(set_point),
            sample_time: SAMPLE_TIME,
            limits: VOLTAGE_LIMITS,
        };
        let mut pid = DigitalPid::default();
        let mut source = GaussianNoise::new(conditions.seed, 0);
        let mut state = State { position: set_point, velocity: 0.0 };
        let mut recording = Self::default();
        for sample in 0..=(conditions.duration / SAMPLE_TIME).round() as usize {
            let time = sample as f64 * SAMPLE_TIME;
            let reference = SENSOR.voltage(set_point) + conditions.reference.at(time);
            let sensor_voltage =
                SENSOR.voltage(state.position) + if noise > 0.0 { noise * source.sample() } else { 0.0 };
            let voltage = pid.update(&settings, sensor_voltage, reference);
            let force = if acceleration != 0.0 && time >= begin { rig.mass * acceleration } else { 0.0 };
            recording.reference.push(reference);
            recording.position.push(state.position);
            recording.velocity.push(state.velocity);
            recording.acceleration.push(rig.acceleration(state.position, voltage, force));
            recording.sensor_voltage.push(sensor_voltage);
            recording.voltage.push(voltage);
            state = advance(&rig, state, voltage, force);
        }
        recording
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Times of the samples \[s\].
    pub fn times(&self) -> Vec<f64> {
        (0..self.len()).map(|sample| sample as f64 * SAMPLE_TIME).collect()
    }
}

/// One sample under a held voltage \[V\] and force \[N\].
fn advance(rig: &MaglevRig, mut state: State, voltage: f64, force: f64) -> State {
    let step = SAMPLE_TIME / f64::from(SUBSTEPS);
    for _ in 0..SUBSTEPS {
        let rate = |state: State| (state.velocity, rig.acceleration(state.position, voltage, force));
        let moved = |(velocity, acceleration): (f64, f64), duration: f64| State {
            position: state.position + duration * velocity,
            velocity: state.velocity + duration * acceleration,
        };
        let first = rate(state);
        let second = rate(moved(first, 0.5 * step));
        let third = rate(moved(second, 0.5 * step));
        let fourth = rate(moved(third, step));
        let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * b + 2.0 * c + d) / 6.0;
        state = State {
            position: state.position + step * mean(first.0, second.0, third.0, fourth.0),
            velocity: state.velocity + step * mean(first.1, second.1, third.1, fourth.1),
        };
    }
    state
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recording_is_that_of_the_independent_prototype() {
        let recording = Recording::make(&Conditions::new(Reference::SineAndStep, 4.0));
        assert_eq!(recording.len(), 4001);
        let rows = include_str!("../../../tests/reference/rig_sine_step.csv").lines().skip(1);
        let mut count = 0;
        for (row, sample) in rows.zip((0..).step_by(5)) {
            let numbers: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
            let own = [
                recording.reference[sample],
                recording.position[sample],
                recording.velocity[sample],
                recording.sensor_voltage[sample],
                recording.voltage[sample],
            ];
            for (value, (expected, scale)) in
                own.iter().zip(numbers[1..6].iter().zip([1.5, 9e-3, 0.1, 1.5, 1.0]))
            {
                assert!((value - expected).abs() < 1e-9 * scale, "sample {sample}: {value} {expected}");
            }
            count += 1;
        }
        assert_eq!(count, 800);
    }

    #[test]
    fn noise_mass_and_push_reach_the_loop() {
        let clean = Conditions::new(Reference::Hold, 2.0);
        let rest = Recording::make(&clean);
        assert!(rest.velocity.iter().all(|velocity| velocity.abs() < 1e-9));
        let noisy = Recording::make(&Conditions { noise: 1e-3, ..clean });
        let errors: Vec<f64> = noisy
            .sensor_voltage
            .iter()
            .zip(&noisy.position)
            .map(|(measured, position)| measured - SENSOR.voltage(*position))
            .collect();
        let deviation = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        assert!((deviation / 1e-3 - 1.0).abs() < 0.05);
        let disturbed = Recording::make(&Conditions { disturbance_step: (1.0, 1.0), ..clean });
        assert_eq!(disturbed.position[1000], disturbed.position[0]);
        assert!((disturbed.acceleration[1000] - 1.0).abs() < 1e-9);
        // Long enough for the integral.
        let heavy = Recording::make(&Conditions { mass_ratio: 1.2, duration: 30.0, ..clean });
        let ratio = heavy.voltage.last().unwrap() / heavy.position.last().unwrap() * 9e-3 / rest.voltage[0];
        assert!((ratio - 1.2f64.sqrt()).abs() < 1e-6, "{ratio}");
    }
}
