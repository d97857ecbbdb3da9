//! One run of the levitated ball's control loop through the packaged models.

use super::reference::BallReference;
use crate::host::Value;
use crate::plant::levitated_ball::LevitatedBall;
use crate::study::StudyError;
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::{difference, root_mean_square};
use crate::study::run::Run;

/// Time between the rows that are kept of a run \[s\]; the loop itself runs faster.
const ROW_INTERVAL: f64 = 1e-3;

/// Estimators of the flux offset, items of `observer.kind`.
pub const DREM: &str = "drem";
pub const NEWTON: &str = "polynomial_newton";
pub const ADAPTIVE: &str = "polynomial_newton_adaptive";

/// lam0 of the laboratory rig \[Wb\]: the flux that carries the ball.
pub fn carrying_flux() -> f64 {
    LevitatedBall::LABORATORY.equilibrium_flux()
}

/// Parameters of a run; everything else keeps its start value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario {
    pub reference: BallReference,
    /// Added to the reference \[m\]; the ball starts there.
    pub target: f64,
    pub observer: &'static str,
    /// What the observer's flux lacks at the start, as a share of lam0.
    pub flux_error: f64,
    /// gamma \[1/s\] and kappa of DREM
    pub gain: f64,
    pub excitation_scale: f64,
    /// alpha and beta \[1/s\]
    pub prefilters: [f64; 2],
    pub filters: [f64; 4],
    /// w_p = w_y \[1/s\]
    pub mechanical_rate: f64,
    /// \[s\]
    pub startup_hold: f64,
    pub filters_from_zero: bool,
    /// Item of `controller.feedback`.
    pub feedback: &'static str,
    /// What the controller's resistance is wrong by, as a share.
    pub resistance_error: f64,
    /// Standard deviation of the current sensor \[A\].
    pub noise: f64,
    /// T \[s\]
    pub sample_time: f64,
    /// \[s\]
    pub duration: f64,
}

impl Scenario {
    /// DREM as in the figures, the flux wrong by a tenth of lam0.
    pub fn new(reference: BallReference, duration: f64) -> Self {
        Self {
            reference,
            target: 0.0,
            observer: DREM,
            flux_error: 0.1,
            gain: 10.0,
            excitation_scale: if reference == BallReference::Steps { 1e10 } else { 1e9 },
            prefilters: [100.0, 300.0],
            filters: [10.0, 25.0, 60.0, 150.0],
            mechanical_rate: 200.0,
            startup_hold: 0.1,
            filters_from_zero: false,
            feedback: "estimate",
            resistance_error: 0.0,
            noise: 0.0,
            sample_time: 1e-4,
            duration,
        }
    }
}

const RECORDED: [(&str, &str); 11] = [
    ("plant", "position"),
    ("plant", "velocity"),
    ("plant", "flux"),
    ("controller", "estimate.position"),
    ("controller", "estimate.velocity"),
    ("controller", "estimate.flux"),
    ("controller", "reference.position"),
    ("plant", "current"),
    ("controller", "voltage"),
    ("controller", "observer.excitation"),
    ("plant", "contact"),
];

/// Runs a scenario. Rows are kept for every millisecond, or every tick if those are rarer; added to what is recorded are
/// [`FLUX_ERROR`] and [`TRACKING_ERROR`].
pub fn simulate(packages: &LoopPackages, scenario: &Scenario) -> Result<Run, StudyError> {
    let real = Value::Real;
    let Scenario { prefilters, filters, .. } = *scenario;
    let reference = |time: f64| scenario.target + scenario.reference.at(time);
    let mut wire = None;
    let run = packages.simulate_with(
        &[("initial.position", real(scenario.target)), ("sensor.noise", real(scenario.noise))],
        &[
            ("observer.kind", Value::Text(scenario.observer)),
            ("observer.initial.flux", real((1.0 - scenario.flux_error) * carrying_flux())),
            ("observer.gain", real(scenario.gain)),
            ("observer.excitation_scale", real(scenario.excitation_scale)),
            ("observer.prefilter[1]", real(prefilters[0])),
            ("observer.prefilter[2]", real(prefilters[1])),
            ("observer.filter[1]", real(filters[0])),
            ("observer.filter[2]", real(filters[1])),
            ("observer.filter[3]", real(filters[2])),
            ("observer.filter[4]", real(filters[3])),
            ("observer.speed_rate", real(scenario.mechanical_rate)),
            ("observer.position_rate", real(scenario.mechanical_rate)),
            ("observer.startup_hold", real(scenario.startup_hold)),
            ("observer.filters_from_zero", Value::Boolean(scenario.filters_from_zero)),
            ("controller.feedback", Value::Text(scenario.feedback)),
            ("controller.initial_reference", real(scenario.target)),
            ("controller.reference_filter", real(scenario.reference.filter_rate())),
            ("resistance", real((1.0 + scenario.resistance_error) * LevitatedBall::LABORATORY.resistance)),
        ],
        &RECORDED,
        scenario.sample_time,
        scenario.duration,
        |time, controller, _| {
            let handle = match wire {
                Some(handle) => handle,
                None => *wire.insert(controller.variable("reference")?),
            };
            controller.set(handle, reference(time))
        },
    )?;
    let run = run.every((ROW_INTERVAL / scenario.sample_time).round().max(1.0) as usize);
    let flux_error = run.error("flux").iter().map(|error| error / carrying_flux()).collect();
    let tracking_error = difference(run.state("position"), &run[REFERENCE]);
    Ok(run.with(FLUX_ERROR, flux_error).with(TRACKING_ERROR, tracking_error))
}

/// Column of the error of the flux estimate as a share of lam0.
pub const FLUX_ERROR: &str = "flux_error";
/// Column of y - y* \[m\].
pub const TRACKING_ERROR: &str = "tracking_error";
/// Column of y* \[m\].
pub const REFERENCE: &str = "controller.reference.position";
/// Column of Delta, scaled by kappa.
pub const EXCITATION: &str = "controller.observer.excitation";

/// t_l \[s\]: the flux error stays below 1 % of lam0.
pub fn flux_settled(run: &Run) -> f64 {
    run.settled(&run[FLUX_ERROR], 0.01)
}

/// t_e \[s\]: |y - y*| stays below `limit` \[m\].
pub fn tracking_settled(run: &Run, limit: f64) -> f64 {
    run.settled(&run[TRACKING_ERROR], limit)
}

/// Root mean square of a column over the last second.
pub fn last_second(run: &Run, name: &str) -> f64 {
    root_mean_square(run.last(1.0, &run[name]))
}
