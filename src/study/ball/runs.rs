//! All runs that figures, tables and claims look at.

use super::reference::BallReference::{self, Constant, Sinusoids, Steps};
use super::scenario::{ADAPTIVE, DREM, NEWTON, Scenario, simulate};
use crate::study::loop_packages::LoopPackages;
use crate::study::run::Run;
use crate::study::sweep::sweep;
use crate::study::{Progress, StudyError};

pub const REFERENCES: [BallReference; 2] = [Sinusoids, Steps];
/// Initial flux errors of figures 2 and 3, as shares of lam0.
pub const FLUX_ERRORS: [f64; 4] = [0.1, 0.05, -0.05, -0.1];
/// gamma of figures 4 and 5 \[1/s\]
pub const GAINS: [f64; 4] = [1.0, 3.0, 10.0, 100.0];
/// w_p = w_y of figure 6 \[1/s\]
pub const RATES: [f64; 4] = [50.0, 100.0, 200.0, 400.0];
/// w_p = w_y for which a frozen flux error is looked at \[1/s\], and that error.
pub const FROZEN_RATES: [f64; 3] = [100.0, 200.0, 400.0];
pub const FROZEN_FLUX_ERROR: f64 = 0.02;
/// Where the ball is to rest then \[m\].
pub const FROZEN_TARGET: f64 = 1e-3;
/// gamma of figure 7 \[1/s\], with a kappa that is a millionth of the usual.
pub const POORLY_EXCITED_GAINS: [f64; 6] = [0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0];
const POOR_EXCITATION_SCALE: f64 = 1e4;
/// Sets of filters whose excitation is compared: alpha, beta \[1/s\].
pub const FILTER_SETS: [([f64; 2], [f64; 4]); 6] = [
    ([100.0, 300.0], [10.0, 25.0, 60.0, 150.0]),
    ([100.0, 300.0], [5.0, 15.0, 40.0, 100.0]),
    ([100.0, 300.0], [40.0, 50.0, 60.0, 70.0]),
    ([30.0, 60.0], [10.0, 25.0, 60.0, 150.0]),
    ([30.0, 60.0], [1.0, 2.0, 3.0, 4.0]),
    ([300.0, 900.0], [100.0, 200.0, 400.0, 800.0]),
];
/// Sample times \[s\] that are compared.
pub const SAMPLE_TIMES: [f64; 6] = [5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3];
pub const COMPARED_OBSERVERS: [&str; 2] = [DREM, NEWTON];
/// Error of the resistance with which the open integration is tried, a share.
pub const RESISTANCE_ERROR: f64 = 1e-3;
pub const ALL_OBSERVERS: [&str; 3] = [DREM, NEWTON, ADAPTIVE];

/// The runs, in the order of the constants above.
pub struct Runs {
    /// Figures 2 and 3: `[reference][flux error]`.
    pub flux_errors: [Vec<Run>; 2],
    /// The true state fed back, by reference.
    pub state_feedback: Vec<Run>,
    /// Figures 4 and 5: `[reference][gain]`.
    pub gains: [Vec<Run>; 2],
    /// Figure 6: by mechanical rate.
    pub rates: Vec<Run>,
    /// A frozen flux error at rest, by mechanical rate.
    pub frozen: Vec<Run>,
    /// Figure 7: filters from zero, no hold, true state fed back; by gain.
    pub poorly_excited: Vec<Run>,
    /// The same with filters from a ball at rest.
    pub well_started: Vec<Run>,
    /// Filters from zero, no hold, largest gain of figure 7, estimates fed back.
    pub poorly_excited_loop: Vec<Run>,
    /// Constant reference, by observer of [`ALL_OBSERVERS`].
    pub constant: Vec<Run>,
    /// Wrong resistance on the sinusoids, by observer of [`ALL_OBSERVERS`].
    pub wrong_resistance: Vec<Run>,
    /// Observer only watching, by set of filters: `[reference][set]`.
    pub filter_sets: [Vec<Run>; 2],
    /// `[observer][reference]`, by sample time.
    pub sample_times: [[Vec<Run>; 2]; 2],
}

impl Runs {
    pub fn simulate(packages: &LoopPackages, progress: Progress<'_>) -> Result<Self, StudyError> {
        let mut scenarios: Vec<Scenario> = Vec::new();
        let mut queue = |batch: Vec<Scenario>| {
            let first = scenarios.len();
            scenarios.extend(batch);
            first..scenarios.len()
        };
        let frozen = Scenario {
            target: FROZEN_TARGET,
            flux_error: FROZEN_FLUX_ERROR,
            gain: 0.0,
            ..Scenario::new(Constant, 3.0)
        };
        let poor = Scenario {
            excitation_scale: POOR_EXCITATION_SCALE,
            filters_from_zero: true,
            startup_hold: 0.0,
            feedback: "state",
            ..Scenario::new(Steps, 10.0)
        };
        let places = [
            queue(by(FLUX_ERRORS, |flux_error| Scenario { flux_error, ..Scenario::new(Sinusoids, 4.0) })),
            queue(by(FLUX_ERRORS, |flux_error| Scenario { flux_error, ..Scenario::new(Steps, 10.0) })),
            queue(vec![
                Scenario { feedback: "state", ..Scenario::new(Sinusoids, 4.0) },
                Scenario { feedback: "state", ..Scenario::new(Steps, 10.0) },
            ]),
            queue(by(GAINS, |gain| Scenario { gain, ..Scenario::new(Sinusoids, 10.0) })),
            queue(by(GAINS, |gain| Scenario { gain, ..Scenario::new(Steps, 10.0) })),
            queue(by(RATES, |mechanical_rate| Scenario { mechanical_rate, ..Scenario::new(Sinusoids, 2.0) })),
            queue(by(FROZEN_RATES, |mechanical_rate| Scenario { mechanical_rate, ..frozen })),
            queue(by(POORLY_EXCITED_GAINS, |gain| Scenario { gain, ..poor })),
            queue(by(POORLY_EXCITED_GAINS, |gain| Scenario { gain, filters_from_zero: false, ..poor })),
            queue(vec![Scenario { gain: 1.0, feedback: "estimate", ..poor }]),
            queue(by(ALL_OBSERVERS, |observer| Scenario { observer, ..Scenario::new(Constant, 4.0) })),
            queue(by(ALL_OBSERVERS, |observer| Scenario {
                observer,
                resistance_error: RESISTANCE_ERROR,
                ..Scenario::new(Sinusoids, 4.0)
            })),
            queue(by(FILTER_SETS, |(prefilters, filters)| watching(Sinusoids, prefilters, filters))),
            queue(by(FILTER_SETS, |(prefilters, filters)| watching(Steps, prefilters, filters))),
            queue(by(SAMPLE_TIMES, |sample_time| sampled(DREM, Sinusoids, sample_time))),
            queue(by(SAMPLE_TIMES, |sample_time| sampled(DREM, Steps, sample_time))),
            queue(by(SAMPLE_TIMES, |sample_time| sampled(NEWTON, Sinusoids, sample_time))),
            queue(by(SAMPLE_TIMES, |sample_time| sampled(NEWTON, Steps, sample_time))),
        ];
        let mut runs =
            sweep(&scenarios, progress, "ball: simulating", |scenario| simulate(packages, scenario))?;
        let mut batches = places.map(|place| runs.drain(..place.len()).collect::<Vec<Run>>()).into_iter();
        let mut next = || batches.next().unwrap_or_default();
        Ok(Self {
            flux_errors: [next(), next()],
            state_feedback: next(),
            gains: [next(), next()],
            rates: next(),
            frozen: next(),
            poorly_excited: next(),
            well_started: next(),
            poorly_excited_loop: next(),
            constant: next(),
            wrong_resistance: next(),
            filter_sets: [next(), next()],
            sample_times: [[next(), next()], [next(), next()]],
        })
    }
}

fn by<T, const N: usize>(values: [T; N], scenario: impl Fn(T) -> Scenario) -> Vec<Scenario> {
    values.into_iter().map(scenario).collect()
}

/// The observer only watches, with a frozen and right flux.
fn watching(reference: BallReference, prefilters: [f64; 2], filters: [f64; 4]) -> Scenario {
    Scenario {
        prefilters,
        filters,
        feedback: "state",
        flux_error: 0.0,
        gain: 0.0,
        excitation_scale: 1.0,
        ..Scenario::new(reference, 6.0)
    }
}

fn sampled(observer: &'static str, reference: BallReference, sample_time: f64) -> Scenario {
    // A hold of 0.2 s costs DREM nothing here and lets its prefilters settle.
    let startup_hold = if observer == DREM { 0.2 } else { 0.02 };
    Scenario { observer, sample_time, startup_hold, ..Scenario::new(reference, 6.0) }
}
