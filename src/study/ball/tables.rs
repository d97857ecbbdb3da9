//! Tables of the ball's study: the sampled loop beside the continuous one, and what sample time, filters and gains do.

use super::continuous::{FLUX_ERROR_RUNS, POORLY_EXCITED, SINUSOID_GAINS, STEP_GAINS};
use super::runs::{
    COMPARED_OBSERVERS, FILTER_SETS, FLUX_ERRORS, FROZEN_FLUX_ERROR, FROZEN_RATES, FROZEN_TARGET, GAINS,
    POORLY_EXCITED_GAINS, REFERENCES, Runs, SAMPLE_TIMES,
};
use super::scenario::{EXCITATION, FLUX_ERROR, TRACKING_ERROR, flux_settled, last_second, tracking_settled};
use crate::plant::levitated_ball::LevitatedBall;
use crate::study::Summary;
use crate::study::metrics::{peak, root_mean_square};
use crate::study::report::quantity;
use crate::study::run::Run;

pub fn all(runs: &Runs) -> Vec<Summary> {
    vec![
        convergence(runs),
        gains(runs),
        poorly_excited(runs),
        sample_times(runs),
        frozen(runs),
        filters(runs),
    ]
}

/// A settling time, which may be infinite.
fn settling(time: f64) -> String {
    if time.is_finite() { quantity(time, "s") } else { "not within the run".to_owned() }
}

fn millimetres(value: f64) -> String {
    quantity(1e3 * value, "mm")
}

fn percent(share: f64) -> String {
    quantity(100.0 * share, "%")
}

/// Criteria A3 and A4.
fn convergence(runs: &Runs) -> Summary {
    let rows = (0..REFERENCES.len()).flat_map(|reference| {
        FLUX_ERRORS.iter().enumerate().map(move |(k, error)| {
            let run = &runs.flux_errors[reference][k];
            let continuous = FLUX_ERROR_RUNS[reference][k];
            vec![
                format!("{:?}, {:+.0} %", REFERENCES[reference], 100.0 * error).to_lowercase(),
                settling(flux_settled(run)),
                settling(continuous.flux_settled),
                settling(tracking_settled(run, 0.05e-3)),
                settling(continuous.tracking_settled),
                millimetres(peak(&run[TRACKING_ERROR])),
                millimetres(continuous.peak),
                millimetres(last_second(run, TRACKING_ERROR)),
                percent(last_second(run, FLUX_ERROR)),
            ]
        })
    });
    Summary::new(
        "Figures 2 and 3 sampled at 0.1 ms, beside the continuous loop (which ends below 2e-6 mm)",
        [
            "reference, flux offset",
            "flux error < 1 % from",
            "continuous",
            "|y - y*| < 0.05 mm from",
            "continuous",
            "largest |y - y*|",
            "continuous",
            "rms of the last second",
            "rms flux error of the last second",
        ],
        rows,
    )
}

/// Criteria A5 and A6.
fn gains(runs: &Runs) -> Summary {
    let rows = GAINS.iter().enumerate().map(|(k, gain)| {
        let (sinusoids, steps) = (&runs.gains[0][k], &runs.gains[1][k]);
        let (continuous_time, continuous_rest) = STEP_GAINS[k];
        let left = |run: &Run| root_mean_square(run.last(0.1, &run[FLUX_ERROR]));
        vec![
            format!("{gain}"),
            settling(flux_settled(sinusoids)),
            settling(SINUSOID_GAINS[k]),
            percent(left(sinusoids)),
            settling(flux_settled(steps)),
            settling(continuous_time),
            percent(left(steps)),
            if continuous_rest > 0.0 { percent(continuous_rest) } else { "converged".to_owned() },
        ]
    });
    Summary::new(
        "Adaptation gain, flux offset +10 %, 10 s (figures 4 and 5)",
        [
            "gamma [1/s]",
            "sinusoids: flux error < 1 % from",
            "continuous",
            "left at 10 s",
            "steps: flux error < 1 % from",
            "continuous",
            "left at 10 s",
            "continuous",
        ],
        rows,
    )
}

/// Criterion A8.
fn poorly_excited(runs: &Runs) -> Summary {
    let left = |run: &Run| percent(peak(run[FLUX_ERROR].last()));
    let rows = POORLY_EXCITED_GAINS.iter().enumerate().map(|(k, gain)| {
        vec![
            format!("{gain}"),
            left(&runs.poorly_excited[k]),
            percent(POORLY_EXCITED[k]),
            left(&runs.well_started[k]),
        ]
    });
    Summary::new(
        "Steady-state error and adaptation gain: |flux error| / lam0 after 10 s of steps with kappa = 1e4, \
         no hold (figure 7)",
        ["gamma [1/s]", "filters from zero", "continuous", "filters from rest"],
        rows,
    )
}

/// How a run ended: its errors over the last second, or when the ball was lost.
fn outcome(run: &Run) -> String {
    match run.lost_at {
        Some(time) => format!("lost at {}", quantity(time, "s")),
        None => format!(
            "{}, {}",
            percent(last_second(run, FLUX_ERROR)),
            millimetres(last_second(run, TRACKING_ERROR))
        ),
    }
}

fn sample_times(runs: &Runs) -> Summary {
    let rows = SAMPLE_TIMES.iter().enumerate().map(|(k, sample_time)| {
        let cells = (0..COMPARED_OBSERVERS.len()).flat_map(|observer| {
            (0..REFERENCES.len()).map(move |reference| outcome(&runs.sample_times[observer][reference][k]))
        });
        std::iter::once(quantity(1e3 * sample_time, "ms")).chain(cells).collect()
    });
    Summary::new(
        "Sample time: rms flux error and rms |y - y*| of the last of 6 s, flux offset +10 % at the start, \
         no noise",
        ["T", "drem, sinusoids", "drem, steps", "polynomial_newton, sinusoids", "polynomial_newton, steps"],
        rows,
    )
}

/// y - y* \[m\] at rest at `target` \[m\] with a flux estimate of `ratio` times the flux and w_p = w_y = `rate` \[1/s\], pole
/// -60 1/s: speed and position observers and the law (22) at rest, solved.
pub fn offset_at_rest(target: f64, ratio: f64, rate: f64) -> f64 {
    let LevitatedBall { gap, gravity, .. } = LevitatedBall::LABORATORY;
    let pole = 60.0;
    let (a0, a1, a2) = (pole * pole * pole, 3.0 * pole * pole, 3.0 * pole);
    let acceleration = gravity * (ratio * ratio - 1.0);
    let velocity = acceleration / (rate * ratio * ratio);
    let estimate = target - (a2 * acceleration + a1 * velocity) / a0;
    gap - ratio * (gap - estimate + velocity / (rate * ratio * ratio)) - target
}

fn frozen(runs: &Runs) -> Summary {
    let rows = FROZEN_RATES.iter().zip(&runs.frozen).map(|(rate, run)| {
        let end = |column: &[f64]| column.last().copied().unwrap_or(f64::NAN);
        vec![
            quantity(*rate, "1/s"),
            millimetres(end(&run[TRACKING_ERROR])),
            millimetres(offset_at_rest(FROZEN_TARGET, 1.0 - FROZEN_FLUX_ERROR, *rate)),
            quantity(1e3 * end(&run.error("velocity")), "mm/s"),
        ]
    });
    Summary::new(
        "A frozen flux error of 2 % at y* = 1 mm: the loop stays stable but biased; the mechanical gains \
         reduce the bias, so they do not explain an error that grows with a gain",
        ["w_p = w_y", "y - y* after 3 s", "in closed form", "error of the velocity estimate"],
        rows,
    )
}

/// rms of Delta without its scale after the first second.
pub fn excitation(run: &Run) -> f64 {
    root_mean_square(run.last(5.0, &run[EXCITATION]))
}

fn filters(runs: &Runs) -> Summary {
    let list = |rates: &[f64]| rates.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let rows = FILTER_SETS.iter().enumerate().map(|(k, (prefilters, filters))| {
        vec![
            list(prefilters),
            list(filters),
            format!("{:.1e}", excitation(&runs.filter_sets[0][k])),
            format!("{:.1e}", excitation(&runs.filter_sets[1][k])),
        ]
    });
    Summary::new(
        "Filters decide over the excitation: rms of Delta (kappa = 1), the observer only watching",
        ["alpha [1/s]", "beta [1/s]", "sinusoids", "steps"],
        rows,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_at_rest_are_those_of_the_continuous_loop() {
        for (rate, millimetres) in [(100.0, 0.6367), (200.0, 0.5067), (400.0, 0.4494)] {
            assert!((1e3 * offset_at_rest(1e-3, 0.98, rate) - millimetres).abs() < 5e-5);
        }
        assert_eq!(offset_at_rest(1e-3, 1.0, 200.0), 0.0);
    }
}
