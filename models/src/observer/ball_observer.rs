//! Flux, velocity and position of the levitated ball from current and voltage.
//!
//! "Sensorless control of the levitated ball", sections 3 and 4: the flux is the integral of the induced voltage (6), (7) plus
//! an unknown offset, which is estimated ([`FluxEstimator`]); velocity and position follow from the flux by Propositions 7
//! and 8. Normalised as in [`super::flux_regression`], with S = (u - R i) / lam0 and rates w_p = g_p lam0^2, w_y = g_y lam0^2,
//! these are, l^ being the estimate of l and z^, v^ those of z and v:
//!
//! ```text
//! s' = S                                  l^ = s + theta^                                              (6), (7)
//! v_I' = W2 (l^^2 - 1) - w_p l^^2 v^ + 2 w_p I S            v^ = v_I - w_p I l^                        (17)
//! z^' = -v^ - w_y l^^2 z^ + w_y I l^                                                                   (20)
//! ```
//!
//! (17) and (20) are reconstructions, as the regression is. Between samples the voltage is constant and the current nearly an
//! exponential; `Course` follows it more closely than a straight line would.

pub use super::ball_observer_settings::{
    Adaptation, BallEstimate, BallObserverSettings, FluxEstimator, InitialBallEstimate,
};
use super::current_course::{Course, SMALLEST_FLUX};
use super::drem::{Drem, normalised};
use super::flux_regression::{FluxRegression, FluxRegressionSettings, Sample, residual_and_slope};
use super::polynomial_newton::limited_error;
use crate::plant::levitated_ball::State;
use crate::signal::FirstOrderHold;
use serde::{Deserialize, Serialize};

/// Largest normalised current that is believed: some hundred times what carries the ball.
const LARGEST_CURRENT: f64 = 1e3;
/// Largest share of the resistance, or of the voltage that carries the ball at y = 0, that is learnt.
const LARGEST_ADAPTATION: f64 = 0.25;
/// Longest sub-step of the prefilters \[s\].
const LONGEST_SUBSTEP: f64 = 1e-4;
const MAX_SUBSTEPS: u32 = 16;

/// Constants that follow from the settings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Constants {
    regression: FluxRegressionSettings,
    /// R c / k \[1/s\]: S = U - `damping` I
    damping: f64,
    /// lam0 \[Wb\]
    flux: f64,
    /// c lam0 / k \[A\]
    current: f64,
    substeps: u32,
    prefilters: [FirstOrderHold; 2],
    filters: [FirstOrderHold; 4],
    /// 1 - e^(-G T)
    newton_share: f64,
}

impl Constants {
    fn new(settings: &BallObserverSettings) -> Self {
        let BallObserverSettings { ball, sample_time, .. } = settings;
        let flux = ball.equilibrium_flux();
        let substeps =
            (libm::ceil(sample_time / LONGEST_SUBSTEP * (1.0 - 1e-9)) as u32).clamp(1, MAX_SUBSTEPS);
        let substep = sample_time / f64::from(substeps);
        Self {
            regression: FluxRegressionSettings {
                rates: settings.prefilters,
                gravity: ball.gravity / ball.gap,
            },
            damping: ball.resistance * ball.gap / ball.inductance_constant,
            flux,
            current: ball.gap * flux / ball.inductance_constant,
            substeps,
            prefilters: settings.prefilters.map(|rate| FirstOrderHold::low_pass(rate, substep)),
            filters: settings.filters.map(|rate| FirstOrderHold::low_pass(rate, *sample_time)),
            newton_share: match settings.estimator {
                FluxEstimator::Newton { gain, .. } => -libm::expm1(-gain * sample_time),
                FluxEstimator::Mixing(_) | FluxEstimator::NormalisedMixing { .. } => 0.0,
            },
        }
    }
}

/// The observer with its settings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallObserver {
    settings: BallObserverSettings,
    initial: InitialBallEstimate,
    constants: Constants,
    memory: Memory,
}

/// What the observer remembers from sample to sample, all normalised.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Memory {
    regression: FluxRegression,
    mixing: Drem,
    /// theta^
    offset: f64,
    /// d, learnt: S = U + d, or S = U - (damping - d) I \[1/s\]
    learnt: f64,
    /// v_I
    integrated_velocity: f64,
    /// v^ less the one of the sample before
    velocity_rise: f64,
    /// z^
    gap: f64,
    /// Samples seen; saved in a fixed number of bytes.
    #[serde(with = "postcard::fixint::le")]
    samples: u32,
}

impl Memory {
    /// A ball at rest up to the first `current` (normalised).
    fn start(
        settings: &BallObserverSettings,
        initial: &InitialBallEstimate,
        constants: &Constants,
        current: f64,
    ) -> Self {
        let sample = Sample { flux: initial.flux / constants.flux, current };
        let offset = initial.flux_offset / constants.flux;
        let flux = sample.flux + offset;
        let gap = settings.ball.gap;
        let regression = if initial.filters_from_zero {
            FluxRegression::from_zero(sample)
        } else {
            FluxRegression::new(sample)
        };
        let coefficients = regression.coefficients(&constants.regression);
        let mixing = if initial.filters_from_zero {
            Drem::from_zero(coefficients)
        } else {
            Drem::at_rest(coefficients)
        };
        Self {
            mixing,
            regression,
            offset,
            learnt: 0.0,
            integrated_velocity: initial.velocity / gap + settings.speed_rate * current * flux,
            velocity_rise: 0.0,
            gap: initial.position.map_or(current / flux.max(SMALLEST_FLUX), |position| 1.0 - position / gap),
            samples: 0,
        }
    }

    fn flux(&self) -> f64 {
        self.regression.sample().flux + self.offset
    }

    /// v^
    fn velocity(&self, speed_rate: f64) -> f64 {
        self.integrated_velocity - speed_rate * self.regression.sample().current * self.flux()
    }
}

impl BallObserver {
    /// An observer that has not seen a sample yet.
    pub fn new(settings: BallObserverSettings, initial: InitialBallEstimate) -> Self {
        let constants = Constants::new(&settings);
        let memory = Memory::start(&settings, &initial, &constants, 1.0);
        Self { settings, initial, constants, memory }
    }

    /// Whether it was made with `settings`; asked of an observer that was read from bytes.
    pub fn belongs_to(&self, settings: &BallObserverSettings) -> bool {
        self.settings == *settings && self.constants == Constants::new(settings)
    }

    /// Goes on with other settings; the state of the filters stays.
    pub fn apply_settings(&mut self, settings: BallObserverSettings) {
        if settings != self.settings {
            self.settings = settings;
            self.constants = Constants::new(&settings);
        }
    }

    /// The estimate before any time has passed, given the first `current` \[A\]: what the observer was told, and the
    /// residual of a ball at rest.
    pub fn start(&mut self, current: f64) -> BallEstimate {
        let current = self.normalised(current);
        self.memory = Memory::start(&self.settings, &self.initial, &self.constants, current);
        let InitialBallEstimate { flux, flux_offset, velocity, .. } = self.initial;
        let normalised_flux = self.memory.flux();
        let square = normalised_flux * normalised_flux;
        let estimate = self.estimate(0.0, normalised_flux * square * (square - 1.0));
        let state = State { velocity, flux: flux + flux_offset, ..estimate.state };
        BallEstimate { state, flux_offset, ..estimate }
    }

    /// Takes the sample i\[k\] = `current` \[A\] and the `voltage` \[V\] that acted since the sample before.
    #[inline(never)]
    pub fn update(&mut self, current: f64, voltage: f64) -> BallEstimate {
        let excitation = self.advance(self.normalised(current), voltage / self.constants.flux);
        let memory = &self.memory;
        let residual = self.residual();
        let sum =
            residual + memory.velocity(self.settings.speed_rate) + memory.gap + memory.learnt + excitation;
        if sum.is_finite() {
            return self.estimate(excitation, residual);
        }
        // Nothing of what has run away is worth keeping.
        BallEstimate { restarted: true, ..self.start(current) }
    }

    fn normalised(&self, current: f64) -> f64 {
        (current / self.constants.current).clamp(-LARGEST_CURRENT, LARGEST_CURRENT)
    }

    fn residual(&self) -> f64 {
        let coefficients = self.memory.regression.coefficients(&self.constants.regression);
        residual_and_slope(&coefficients, self.memory.offset).0
    }

    /// S = U - damping I with what has been learnt: U and damping.
    fn circuit(&self, voltage: f64) -> (f64, f64) {
        let (damping, learnt) = (self.constants.damping, self.memory.learnt);
        match self.settings.estimator {
            FluxEstimator::Newton { adaptation: Some((Adaptation::Resistance, _)), .. } => {
                (voltage, damping - learnt)
            }
            FluxEstimator::Newton { adaptation: Some((Adaptation::VoltageOffset, _)), .. } => {
                (voltage + learnt, damping)
            }
            _ => (voltage, damping),
        }
    }

    /// One sample with normalised inputs; returns Delta.
    #[inline]
    fn advance(&mut self, current: f64, voltage: f64) -> f64 {
        let (source, damping) = self.circuit(voltage);
        let Self { settings, constants, memory, .. } = self;
        let (t, speed_rate, gravity) =
            (settings.sample_time, settings.speed_rate, constants.regression.gravity);
        let past = memory.regression.sample();
        let flux_before = past.flux + memory.offset;
        let velocity_before = memory.velocity(speed_rate);

        let beliefs = [memory.offset, velocity_before, velocity_before + memory.velocity_rise];
        let course = Course::new(past, current, (source, damping), beliefs, t);
        for substep in 1..=constants.substeps {
            let share = f64::from(substep) / f64::from(constants.substeps);
            memory.regression.advance(&constants.prefilters, course.at(share));
        }
        let excitation = estimate_offset(settings, constants, memory);
        memory.samples = memory.samples.saturating_add(1);

        let present = memory.regression.sample();
        let flux_after = present.flux + memory.offset;
        let middle = 0.5 * (flux_before + flux_after);
        let drive = |flux: f64, current: f64| {
            let induced = source - damping * current;
            gravity * (flux * flux - 1.0)
                + speed_rate * current * (speed_rate * flux * flux * flux + 2.0 * induced)
        };
        let hold = FirstOrderHold::relaxation(speed_rate * middle * middle, t);
        memory.integrated_velocity = hold.after(
            memory.integrated_velocity,
            drive(flux_before, past.current),
            drive(flux_after, present.current),
        );

        let velocity_after = memory.velocity(speed_rate);
        memory.velocity_rise = velocity_after - velocity_before;

        let position_rate = settings.position_rate;
        let hold = if position_rate == speed_rate {
            hold
        } else {
            FirstOrderHold::relaxation(position_rate * middle * middle, t)
        };
        memory.gap = hold.after(
            memory.gap,
            position_rate * past.current * flux_before - velocity_before,
            position_rate * present.current * flux_after - velocity_after,
        );
        excitation
    }

    /// The memory in physical units.
    fn estimate(&self, excitation: f64, residual: f64) -> BallEstimate {
        let Self { settings, constants, memory, .. } = self;
        let ball = &settings.ball;
        let (source, damping) = self.circuit(0.0);
        BallEstimate {
            state: State {
                position: ball.gap * (1.0 - memory.gap),
                velocity: ball.gap * memory.velocity(settings.speed_rate),
                flux: constants.flux * memory.flux(),
            },
            flux_offset: constants.flux * memory.offset,
            excitation,
            residual,
            resistance: ball.resistance * (damping / constants.damping),
            voltage_offset: constants.flux * source,
            active: memory.samples > settings.held_samples,
            restarted: false,
        }
    }
}

/// theta^ and d after the newest sample of the regression; returns Delta.
#[inline]
fn estimate_offset(settings: &BallObserverSettings, constants: &Constants, memory: &mut Memory) -> f64 {
    let coefficients = memory.regression.coefficients(&constants.regression);
    let held = memory.samples < settings.held_samples;
    match settings.estimator {
        FluxEstimator::Mixing(mixing) | FluxEstimator::NormalisedMixing { mixing, .. } => {
            if held {
                memory.mixing = Drem::at_rest(coefficients);
                return 0.0;
            }
            memory.mixing.advance(&constants.filters, coefficients);
            let equation = memory.mixing.mix();
            let mixing = match settings.estimator {
                FluxEstimator::NormalisedMixing { level, .. } => normalised(&mixing, level, &equation),
                _ => mixing,
            };
            memory.offset = equation.improve(&mixing, memory.offset, settings.sample_time);
            mixing.excitation_scale * equation.excitation
        }
        FluxEstimator::Newton { adaptation, .. } => {
            if !held {
                let error = limited_error(&coefficients, memory.offset);
                memory.offset -= constants.newton_share * error;
                if let Some((_, gain)) = adaptation {
                    let limit = LARGEST_ADAPTATION * constants.damping;
                    let learnt = memory.learnt - gain * settings.sample_time * error;
                    memory.learnt = learnt.clamp(-limit, limit);
                }
            }
            0.0
        }
    }
}
