//! The references (24), (25): r and the three equal first-order filters behind it.

use nalgebra::Vector3;

/// r(t) before the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Waveform {
    /// A [sin w t + sin 2.2 w t + sin 3.7 w t] with w = 15 rad/s: three tones excite four regressors.
    Sinusoids,
    /// 0, A, -A, A/2 for a second each, again and again.
    Steps,
    /// A throughout.
    Constant,
}

/// A waveform with its amplitude and filter; numbers and the order of the filter are assumed.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    pub waveform: Waveform,
    /// A \[m\]
    pub amplitude: f64,
    /// w_f \[1/s\]
    pub filter_pole: f64,
}

/// y*, y*', y*'', y*''' in metres and seconds.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub jerk: f64,
}

impl Reference {
    pub const SINUSOIDS: Self = Self { waveform: Waveform::Sinusoids, amplitude: 0.6e-3, filter_pole: 80.0 };
    pub const STEPS: Self = Self { waveform: Waveform::Steps, amplitude: 1e-3, filter_pole: 60.0 };

    pub fn constant(position: f64) -> Self {
        Self { waveform: Waveform::Constant, amplitude: position, filter_pole: 60.0 }
    }

    /// r(t) \[m\]. At an edge the new value holds already.
    pub fn raw(&self, time: f64) -> f64 {
        self.amplitude
            * match self.waveform {
                Waveform::Sinusoids => [1.0, 2.2, 3.7].iter().map(|tone| (15.0 * tone * time).sin()).sum(),
                // Times are products of a count and a step: round-off must not move an edge.
                Waveform::Steps => [0.0, 1.0, -1.0, 0.5][(time + 1e-9) as usize % 4],
                Waveform::Constant => 1.0,
            }
    }

    /// Derivative of the filter's states, from the one next to r to y*.
    pub fn derivative(&self, filter: Vector3<f64>, raw: f64) -> Vector3<f64> {
        self.filter_pole * Vector3::new(raw - filter[0], filter[0] - filter[1], filter[1] - filter[2])
    }

    /// y* and its derivatives, exactly those of the filter's output.
    pub fn target(&self, filter: Vector3<f64>, raw: f64) -> Target {
        let [first, second, third] = filter.into();
        let pole = self.filter_pole;
        Target {
            position: third,
            velocity: pole * (second - third),
            acceleration: pole.powi(2) * (first - 2.0 * second + third),
            jerk: pole.powi(3) * (raw - 3.0 * first + 3.0 * second - third),
        }
    }
}
