//! What one run of the continuous loop is made of.

use super::{
    ball::{Ball, Motion},
    mechanics::Mechanics,
    mixing::Mixing,
    reference::Reference,
};

/// Which state the law (22) acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feedback {
    /// The true one: the observer only watches.
    State,
    /// The estimate: sensorless control.
    Estimate,
}

/// What the prefilters hold at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterStart {
    /// As if current and flux had been constant before; exact for a ball that starts at rest.
    ConstantHistory,
    /// Zero, prefilters and low-passes alike.
    Zero,
}

/// How the voltage follows the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Voltage {
    Continuous,
    /// Held for so many steps of the scheme, as a sampled controller does.
    Held(usize),
}

#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub ball: Ball,
    pub reference: Reference,
    /// rho \[1/s\]: the pole of (23)
    pub pole: f64,
    /// alpha_1, alpha_2 \[1/s\]
    pub prefilter_poles: [f64; 2],
    pub mixing: Mixing,
    /// gamma of the adaptation (11)
    pub gain: f64,
    pub mechanics: Mechanics,
    pub start: Motion,
    /// theta/lambda_0: by this the flux exceeds chi
    pub flux_offset: f64,
    /// p_hat(0) \[kg m/s\]
    pub momentum_estimate: f64,
    pub filters: FilterStart,
    /// t_pre \[s\]: so long low-passes follow their inputs at once and the flux offset is not adapted
    pub hold: f64,
    pub feedback: Feedback,
    pub voltage: Voltage,
    /// Step of the scheme \[s\]
    pub step: f64,
}

impl Settings {
    /// Sensorless control of the first reference from a wrong flux of a tenth.
    pub fn sinusoids() -> Self {
        Self {
            ball: Ball::LABORATORY,
            reference: Reference::SINUSOIDS,
            pole: 60.0,
            prefilter_poles: [100.0, 300.0],
            mixing: Mixing { poles: [10.0, 25.0, 60.0, 150.0], scale: 1e9 },
            gain: 10.0,
            mechanics: Mechanics { speed_rate: 200.0, position_rate: 200.0 },
            start: Ball::LABORATORY.rest(0.0),
            flux_offset: 0.1,
            momentum_estimate: 0.0,
            filters: FilterStart::ConstantHistory,
            hold: 0.1,
            feedback: Feedback::Estimate,
            voltage: Voltage::Continuous,
            step: 1e-4,
        }
    }

    /// The same for the second reference.
    pub fn steps() -> Self {
        let baseline = Self::sinusoids();
        Self { reference: Reference::STEPS, mixing: Mixing { scale: 1e10, ..baseline.mixing }, ..baseline }
    }
}
