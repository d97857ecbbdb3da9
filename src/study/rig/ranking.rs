//! Table 5, and which observer is better under which conditions.

use super::observers::{KINDS, PRINTED_INPUT_GAIN, holding, interpolating};
use super::recording::Reference;
use super::simulation::{self, Measurement, Scenario, simulate};
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::root_mean_square;
use crate::study::run::Run;
use crate::study::sweep::{indices, sweep};
use crate::study::{Progress, StudyError};

/// Table 5 as printed: LESO, NESO.
pub const PRINTED_SIMULATION: [f64; 2] = [2.9797e-4, 3.36361e-4];
pub const PRINTED_EXPERIMENT: [f64; 2] = [9.3599e-4, 9.5948e-4];

/// Set point \[m\] at which two seconds of start-up give the printed numbers.
pub const SET_POINT_OF_TABLE_5: f64 = 8.5e-3;

/// Runs a scenario with LESO and with NESO.
pub fn both(packages: &LoopPackages, scenario: &Scenario) -> Result<[Run; 2], StudyError> {
    let [linear, nonlinear] = KINDS.map(|kind| {
        let mut scenario = scenario.clone();
        scenario.parameters.push(kind);
        simulate(packages, &scenario)
    });
    Ok([linear?, nonlinear?])
}

/// Both rows of Table 5 as computed here.
pub struct Table5 {
    /// rms e1 \[m\]
    pub simulation_errors: [f64; 2],
    /// rms of the innovation \[V\]
    pub experiment_errors: [f64; 2],
}

impl Table5 {
    pub fn simulate(packages: &LoopPackages) -> Result<Self, StudyError> {
        let simulation = both(packages, &start_up(2.0))?;
        let moving = Scenario {
            // 0.71 V.
            amplitude: 0.71 / 0.15,
            noise: 1e-4,
            ..Scenario::new(Reference::Sine, 10.0, &holding(Measurement::Volts, "steady"))
        };
        let experiment = both(packages, &moving)?;
        Ok(Self {
            simulation_errors: errors(&simulation, Measurement::Metres, 0.0).map(|errors| errors[0]),
            experiment_errors: [0, 1].map(|who| {
                let run = &experiment[who];
                root_mean_square(run.since(1.0, &run["controller.observer.residual"]))
            }),
        })
    }
}

/// The simulation row's run: at rest at 8.5 mm, estimates from zero.
pub fn start_up(duration: f64) -> Scenario {
    Scenario {
        set_point: SET_POINT_OF_TABLE_5,
        ..Scenario::new(Reference::Hold, duration, &interpolating(Measurement::Metres, "zero"))
    }
}

/// rms e1, e2, e3 of LESO and NESO.
fn errors(runs: &[Run; 2], measurement: Measurement, start: f64) -> [[f64; 3]; 2] {
    [&runs[0], &runs[1]].map(|run| simulation::errors(run, measurement, PRINTED_INPUT_GAIN, start))
}

/// Standard deviations of the sensor \[V\].
pub const NOISES: [f64; 7] = [0.0, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2];
pub const REFERENCES: [(Reference, &str); 4] = [
    (Reference::Hold, "hold"),
    (Reference::Sine, "sine 0.15 V 0.5 Hz"),
    (Reference::SineAndStep, "sine and step 0.1 V"),
    (Reference::FastSine, "sine 0.05 V 3 Hz"),
];
/// \[s\]
const DURATION: f64 = 10.0;

/// How the estimates begin and from when on they are scored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Zero as in the paper, scored from the first sample on.
    FromZero,
    /// At rest as measured, scored after 1 s.
    Steady,
}

/// One condition and what came of it.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    pub measurement: Measurement,
    pub start: Start,
    /// Index into [`REFERENCES`].
    pub reference: usize,
    /// \[V\]
    pub noise: f64,
    /// rms e1, e2, e3 of NESO over those of LESO: above 1 LESO is better.
    pub ratios: [f64; 3],
    /// rms e1, e2, e3 of LESO in the observer's unit.
    pub linear: [f64; 3],
}

/// Units and starts with their names.
pub const MEASUREMENTS: [(Measurement, &str); 2] =
    [(Measurement::Metres, "metres"), (Measurement::Volts, "volts")];
pub const STARTS: [(Start, &str); 2] = [(Start::FromZero, "from zero"), (Start::Steady, "steady")];

/// LESO and NESO with the printed parameters under all conditions.
pub fn compare(packages: &LoopPackages, progress: Progress<'_>) -> Result<Vec<Comparison>, StudyError> {
    let cases = indices([MEASUREMENTS.len(), STARTS.len(), REFERENCES.len(), NOISES.len()]);
    sweep(&cases, progress, "rig: comparing observers", |&[measurement, start, reference, noise]| {
        let (measurement, start, noise) = (MEASUREMENTS[measurement].0, STARTS[start].0, NOISES[noise]);
        let (item, from) = match start {
            Start::FromZero => ("zero", 0.0),
            Start::Steady => ("steady", 1.0),
        };
        let scenario = Scenario {
            noise,
            ..Scenario::new(REFERENCES[reference].0, DURATION, &holding(measurement, item))
        };
        let [linear, nonlinear] = errors(&both(packages, &scenario)?, measurement, from);
        let ratios = core::array::from_fn(|state| nonlinear[state] / linear[state]);
        Ok(Comparison { measurement, start, reference, noise, ratios, linear })
    })
}

/// Below this rms e1 \[m or V\] an observer makes no error worth the name, and a ratio compares round-off.
pub const ROUND_OFF: f64 = 1e-11;

impl Comparison {
    /// Whether LESO is better in z1, where there is an error at all.
    pub fn linear_wins(&self) -> Option<bool> {
        (self.linear[0] > ROUND_OFF).then_some(self.ratios[0] > 1.0)
    }
}
