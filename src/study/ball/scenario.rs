//! One run of the levitated ball's control loop through the packaged units.

use crate::host::Value;
use crate::plant::levitated_ball::LevitatedBall;
use crate::signal::BallReference;
use crate::study::StudyError;
use crate::study::loop_packages::LoopPackages;

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

/// Rows of a run, one per millisecond or per tick if those are rarer; states in the order position \[m\], velocity
/// \[m/s\], flux \[Wb\].
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// \[s\]
    pub time: Vec<f64>,
    pub state: [Vec<f64>; 3],
    pub estimate: [Vec<f64>; 3],
    /// y* \[m\]
    pub reference: Vec<f64>,
    /// \[A\]
    pub current: Vec<f64>,
    /// \[V\]
    pub voltage: Vec<f64>,
    /// Delta, scaled by kappa
    pub excitation: Vec<f64>,
    /// Time at which the ball first touched a stop \[s\].
    pub lost_at: Option<f64>,
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

/// Runs a scenario.
pub fn simulate(packages: &LoopPackages, scenario: &Scenario) -> Result<Run, StudyError> {
    let real = Value::Real;
    let Scenario { prefilters, filters, .. } = *scenario;
    let reference = |time: f64| scenario.target + scenario.reference.at(time);
    let mut wire = None;
    let trace = packages.simulate_with(
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
    let touches = trace.column("plant.contact").unwrap_or_default();
    let lost_at = trace.time.iter().zip(touches).find(|(_, touch)| **touch != 0.0).map(|(time, _)| *time);
    let stride = (ROW_INTERVAL / scenario.sample_time).round().max(1.0) as usize;
    let thin = |column: &[f64]| -> Vec<f64> { column.iter().step_by(stride).copied().collect() };
    let time = thin(&trace.time);
    let mut columns = trace.columns.iter().map(|column| thin(column));
    let mut next = || columns.next().unwrap_or_default();
    Ok(Run {
        time,
        state: [next(), next(), next()],
        estimate: [next(), next(), next()],
        reference: next(),
        current: next(),
        voltage: next(),
        excitation: next(),
        lost_at,
    })
}

/// Number of [`Run::state`] and [`Run::estimate`].
pub const POSITION: usize = 0;
pub const VELOCITY: usize = 1;
pub const FLUX: usize = 2;

impl Run {
    /// Estimate minus truth of one state.
    pub fn error(&self, state: usize) -> Vec<f64> {
        self.estimate[state]
            .iter()
            .zip(&self.state[state])
            .map(|(estimate, truth)| estimate - truth)
            .collect()
    }

    /// Error of the flux estimate as a share of lam0.
    pub fn flux_error(&self) -> Vec<f64> {
        self.error(FLUX).iter().map(|error| error / carrying_flux()).collect()
    }

    /// y - y* \[m\]
    pub fn tracking_error(&self) -> Vec<f64> {
        self.state[POSITION].iter().zip(&self.reference).map(|(position, wanted)| position - wanted).collect()
    }

    /// Rows of the last `duration` \[s\] of a column.
    pub fn tail<'a>(&self, column: &'a [f64], duration: f64) -> &'a [f64] {
        let end = self.time.last().copied().unwrap_or(0.0);
        let first = self.time.partition_point(|time| *time < end - duration - 1e-9);
        &column[first.min(column.len())..]
    }

    /// Time \[s\] from which on a column stays within `limit`; infinite if it does not, or if the ball is lost.
    pub fn settled(&self, column: &[f64], limit: f64) -> f64 {
        if self.lost_at.is_some() {
            return f64::INFINITY;
        }
        match column.iter().rposition(|value| value.is_nan() || value.abs() > limit) {
            None => 0.0,
            Some(last) => self.time.get(last + 1).copied().unwrap_or(f64::INFINITY),
        }
    }

    /// t_l \[s\]: the flux error stays below 1 % of lam0.
    pub fn flux_settled(&self) -> f64 {
        self.settled(&self.flux_error(), 0.01)
    }

    /// t_e \[s\]: |y - y*| stays below `limit` \[m\].
    pub fn tracking_settled(&self, limit: f64) -> f64 {
        self.settled(&self.tracking_error(), limit)
    }
}

/// Largest magnitude.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| peak.max(value.abs()))
}

/// Root mean square.
pub fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settling_is_for_good_and_never_for_a_lost_ball() {
        let mut run = Run { time: vec![0.0, 1.0, 2.0, 3.0], ..Run::default() };
        assert_eq!(run.settled(&[1.0, 0.0, 1.0, 0.0], 0.5), 3.0);
        assert_eq!(run.settled(&[0.0; 4], 0.5), 0.0);
        assert_eq!(run.settled(&[0.0, 0.0, 0.0, 1.0], 0.5), f64::INFINITY);
        assert_eq!(run.tail(&[1.0, 2.0, 3.0, 4.0], 1.0), [3.0, 4.0]);
        run.lost_at = Some(1.0);
        assert_eq!(run.settled(&[0.0; 4], 0.5), f64::INFINITY);
        assert_eq!(root_mean_square(&[3.0, -4.0, 0.0, 0.0]), 2.5);
    }
}
