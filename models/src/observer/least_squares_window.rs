//! More outputs than unknowns: (6) with the pseudo-inverse of the footnote to (5) (Mystkowski, Kotta, Kaparin 2018).
//!
//! With w = (x1, x2, x3) the state at the window's oldest sample, output j is
//!
//! ```text
//! H_j(w) = x1 + j T x2 + Q_j(x3)        j = 0 .. N-1
//! Q_0 = V_0 = 0,  Q_{j+1} = Q_j + T V_j + p(z_j, u_j),  V_{j+1} = V_j + v(z_j, u_j),  z_{j+1} = z_j + u_j T,  z_0 = x3
//! ```
//!
//! with p and v the force effect on position and velocity. Position and velocity enter linearly, so a projection
//! eliminates them: with P the orthogonal projection of N values onto the complement of all straight lines in j,
//! the flux component of pinv(dH/dw) (Y - H(w)) is
//!
//! ```text
//! delta x3 = <P Q', P (Y - Q)> / <P Q', P Q'>        Q' = dQ/dx3
//! ```
//!
//! and the other two fit a straight line to Y - Q - Q' delta x3. This is algebra, not approximation: the iterates
//! are those of (6), and for N = 3 those of the square system. For small noise sigma the flux at the window's
//! start has the variance sigma^2 / <P Q', P Q'>, about 180 sigma^2 / (T^4 x3^2 N^5) at a steady flux.

use super::newton::NewtonSettings;
use super::sample_window::MAX_WINDOW;
use super::step_length::{moved, step_length};
use super::{CONVERGED, largest_magnitude};
use crate::plant::magnetic_bearing::State;

/// Y - H(w) = 0 at one sample, for more equations than unknowns.
pub(super) struct Window<'a> {
    /// Y \[m\]
    positions: &'a [f64],
    /// U \[V\], one less
    voltages: &'a [f64],
    /// Number of outputs, and j of the window's middle, (N - 1) / 2.
    count: f64,
    middle: f64,
    /// Sum of (j - middle)^2
    spread: f64,
}

/// Straight line in j.
struct Line {
    /// Value at the window's middle.
    mean: f64,
    /// Rise per sample.
    slope: f64,
}

pub(super) struct Solution {
    /// w_d, the state at the oldest sample of the window.
    pub state: State,
    pub iterations: u32,
    pub converged: bool,
}

impl<'a> Window<'a> {
    pub fn new(positions: &'a [f64], voltages: &'a [f64]) -> Self {
        let count = positions.len() as f64;
        let spread = count * (count * count - 1.0) / 12.0;
        Self { positions, voltages, count, middle: (count - 1.0) / 2.0, spread }
    }

    /// Least-squares line through the values.
    fn fit(&self, values: &[f64]) -> Line {
        let (mut sum, mut moment, mut place) = (0.0, 0.0, -self.middle);
        for value in values {
            sum += value;
            moment += place * value;
            place += 1.0;
        }
        Line { mean: sum / self.count, slope: moment / self.spread }
    }

    /// The values less their least-squares line: P `values`.
    fn remove_line(&self, values: &mut [f64]) -> Line {
        let line = self.fit(values);
        let mut place = -self.middle;
        for value in values.iter_mut() {
            *value -= line.mean + line.slope * place;
            place += 1.0;
        }
        line
    }

    /// Writes Y - y_0 - Q(x3) to `rest` and Q'(x3) to `sensitivity`, both of N places of which the first stays 0.
    #[inline]
    fn remove_force(&self, settings: &NewtonSettings, flux: f64, rest: &mut [f64], sensitivity: &mut [f64]) {
        let NewtonSettings { bearing, map, sample_time: t, .. } = *settings;
        let (mut flux, mut position, mut velocity) = (flux, 0.0, 0.0);
        let (mut position_slope, mut velocity_slope) = (0.0, 0.0);
        let oldest = self.positions[0];
        let targets = rest.iter_mut().zip(sensitivity.iter_mut()).skip(1);
        for ((measured, voltage), target) in self.positions[1..].iter().zip(self.voltages).zip(targets) {
            let (effect, slope) = bearing.linearised_force_effect(map, flux, *voltage, t);
            position += t * velocity + effect.position;
            velocity += effect.velocity;
            position_slope += t * velocity_slope + slope.position;
            velocity_slope += slope.velocity;
            flux += voltage * t;
            *target.0 = (measured - oldest) - position;
            *target.1 = position_slope;
        }
    }

    /// Iterates (6) from `guess`; stops early once a further iteration could not change the flux any more. An
    /// iteration whose result is not finite is dropped and ends the search.
    pub fn solve(&self, settings: &NewtonSettings, guess: State) -> Solution {
        let count = self.positions.len();
        let t = settings.sample_time;
        let resolution = f64::EPSILON * largest_magnitude([self.positions[0], self.positions[count - 1]]);
        let mut state = guess;
        let mut converged = false;
        let mut places = [[0.0; MAX_WINDOW]; 2];
        let [rest, sensitivity] = places.each_mut().map(|places| &mut places[..count]);
        for iteration in 1..=settings.max_iterations {
            (rest[0], sensitivity[0]) = (0.0, 0.0);
            self.remove_force(settings, state.flux, rest, sensitivity);
            let rest_line = self.remove_line(rest);
            let sensitivity_line = self.remove_line(sensitivity);
            let (mut product, mut square) = (0.0, 0.0);
            for (value, slope) in rest.iter().zip(sensitivity.iter()) {
                product += value * slope;
                square += slope * slope;
            }
            let correction = product / square;
            let mean = rest_line.mean - sensitivity_line.mean * correction;
            let slope = rest_line.slope - sensitivity_line.slope * correction;
            let step = State {
                position: self.positions[0] + (mean - self.middle * slope) - state.position,
                velocity: slope / t - state.velocity,
                flux: correction,
            };
            let length = step_length(settings, state, step, |w| self.squared_residual(settings, w));
            let candidate = moved(state, step, length);
            if !candidate.is_finite() {
                return Solution { state, iterations: iteration, converged: false };
            }
            let size = candidate.flux.abs();
            state = candidate;
            converged = (length * correction).abs() <= CONVERGED * size;
            // What a change of the flux does to the outputs, against their last digit.
            let unseen = correction * correction * square <= resolution * resolution;
            if length == 1.0 && (unseen || correction.abs() <= f64::EPSILON * size) {
                return Solution { state, iterations: iteration, converged };
            }
        }
        Solution { state, iterations: settings.max_iterations, converged }
    }

    /// |Y - H(w)|^2 \[m2\]
    fn squared_residual(&self, settings: &NewtonSettings, w: State) -> f64 {
        let mut places = [[0.0; MAX_WINDOW]; 2];
        let [rest, sensitivity] = places.each_mut().map(|places| &mut places[..self.positions.len()]);
        self.remove_force(settings, w.flux, rest, sensitivity);
        let (mut sum, mut line) = (0.0, w.position - self.positions[0]);
        for value in rest.iter() {
            sum += (value - line) * (value - line);
            line += settings.sample_time * w.velocity;
        }
        sum
    }

    /// The state at the newest sample, and the largest component of Y - H(w) \[m\].
    pub fn forward(&self, settings: &NewtonSettings, w: State) -> (State, f64) {
        let NewtonSettings { bearing, map, sample_time, .. } = *settings;
        let mut state = w;
        let mut residual = largest_magnitude([self.positions[0] - w.position]);
        for (measured, voltage) in self.positions[1..].iter().zip(self.voltages) {
            state = bearing.advance(map, state, *voltage, sample_time);
            residual = largest_magnitude([residual, measured - state.position]);
        }
        (state, residual)
    }
}
