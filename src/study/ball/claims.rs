//! What the paper says about its observer and loop, judged by the runs.

use super::runs::{ALL_OBSERVERS, FILTER_SETS, GAINS, POORLY_EXCITED_GAINS, REFERENCES, Runs, SAMPLE_TIMES};
use super::scenario::{POSITION, Run, VELOCITY, largest, root_mean_square};
use super::tables::excitation;
use crate::study::claim::{Claim, Measurement, Verdict};

/// Share of lam0 up to which a flux error counts as zero.
const VISIBLE: f64 = 0.01;
const BEYOND: &str = "not in the paper";

pub fn all(runs: &Runs) -> Vec<Claim> {
    vec![
        regulation(runs),
        flux(runs),
        mechanical(runs),
        full_information(runs),
        faster_with_gain(runs),
        steady_state_error(runs),
        still_satisfactory(runs),
        choice_of_filters(runs),
        excitation_is_needed(runs),
        open_integration(runs),
        works_sampled(runs),
        newton(runs),
    ]
}

/// Runs of figures 2 and 3.
fn figures_2_and_3(runs: &Runs) -> impl Iterator<Item = &Run> + Clone {
    runs.flux_errors.iter().flatten()
}

fn worst<'a>(runs: impl Iterator<Item = &'a Run>, value: impl Fn(&Run) -> f64) -> f64 {
    runs.map(value).fold(0.0, f64::max)
}

fn last_second(run: &Run, column: &[f64]) -> f64 {
    root_mean_square(run.tail(column, 1.0))
}

fn lost<'a>(runs: impl Iterator<Item = &'a Run>) -> f64 {
    runs.filter(|run| run.lost_at.is_some()).count() as f64
}

fn regulation(runs: &Runs) -> Claim {
    let all = figures_2_and_3(runs);
    let settled: Vec<f64> =
        all.clone().map(|run| run.tracking_settled(1e-4)).filter(|time| time.is_finite()).collect();
    let within = all.clone().filter(|run| run.tracking_settled(0.05e-3).is_finite()).count();
    let count = all.clone().count();
    Claim {
        id: "ball_follows_without_position_sensor",
        statement: "The sensorless controller makes the ball follow sinusoids and steps from wrong initial fluxes.".to_owned(),
        source: "(5), Proposition 9, figures 2 and 3",
        verdict: Verdict::of(settled.len() == count && lost(all.clone()) == 0.0),
        measured: vec![
            Measurement::new(
                format!("runs of {count} with |y - y*| < 0.1 mm for good"),
                settled.len() as f64,
                "1",
            ),
            Measurement::new("slowest of these", largest(&settled), "s"),
            Measurement::new("runs with |y - y*| < 0.05 mm for good", within as f64, "1"),
            Measurement::new("largest |y - y*|", 1e3 * worst(all.clone(), |run| largest(&run.tracking_error())), "mm"),
            Measurement::new(
                "largest rms |y - y*| of the last second",
                1e3 * worst(all, |run| last_second(run, &run.tracking_error())),
                "mm",
            ),
        ],
        criterion: "Two references, initial flux offsets of +-5 and +-10 %, T = 0.1 ms: |y - y*| stays below 0.1 mm, a fiftieth of \
                    the gap, from some time on and the ball touches no stop. All numbers are those of the assumed rig."
            .to_owned(),
    }
}

fn flux(runs: &Runs) -> Claim {
    let count = figures_2_and_3(runs).count();
    let settled = |runs: &[Run]| -> Vec<f64> {
        runs.iter().map(Run::flux_settled).filter(|time| time.is_finite()).collect()
    };
    let [sinusoids, steps] = [settled(&runs.flux_errors[0]), settled(&runs.flux_errors[1])];
    let converged = sinusoids.len() + steps.len();
    Claim {
        id: "flux_estimate_converges",
        statement: "The DREM estimator of Proposition 6 makes the flux error vanish.".to_owned(),
        source: "Proposition 6, figures 2 and 3",
        verdict: Verdict::of(converged == count),
        measured: vec![
            Measurement::new(format!("runs of {count} with an error below 1 % for good"), converged as f64, "1"),
            Measurement::new("slowest of the sinusoids", largest(&sinusoids), "s"),
            Measurement::new("slowest of the steps", largest(&steps), "s"),
            Measurement::new(
                "largest rms error of the last second, share of lam0",
                worst(figures_2_and_3(runs), |run| last_second(run, &run.flux_error())),
                "1",
            ),
        ],
        criterion: "In all runs the flux error stays below 1 % of lam0 from some time on. The regression is a valid one of \
                    the announced kind, not necessarily the authors'."
            .to_owned(),
    }
}

fn mechanical(runs: &Runs) -> Claim {
    let error = |state: usize| worst(figures_2_and_3(runs), |run| last_second(run, &run.error(state)));
    let (velocity, position) = (error(VELOCITY), error(POSITION));
    Claim {
        id: "speed_and_position_follow_from_the_flux",
        statement: "Speed and position estimates converge once the flux does.".to_owned(),
        source: "Propositions 7 and 8",
        verdict: Verdict::of(velocity <= 1e-3 && position <= 0.05e-3),
        measured: vec![
            Measurement::new("largest rms position error of the last second", 1e3 * position, "mm"),
            Measurement::new("largest rms velocity error of the last second", 1e3 * velocity, "mm/s"),
        ],
        criterion: "Runs of figures 2 and 3: the rms errors of the last second are at most 0.05 mm and 1 mm/s. Both observers \
                    are reconstructed from the text."
            .to_owned(),
    }
}

fn full_information(runs: &Runs) -> Claim {
    let difference = |reference: usize| -> Vec<f64> {
        let (sensorless, full) = (&runs.flux_errors[reference][0], &runs.state_feedback[reference]);
        sensorless.state[POSITION].iter().zip(&full.state[POSITION]).map(|(a, b)| a - b).collect()
    };
    let differences = [difference(0), difference(1)];
    let late = (0..REFERENCES.len())
        .map(|k| largest(runs.flux_errors[k][0].tail(&differences[k], 1.0)))
        .fold(0.0, f64::max);
    let early = differences.iter().map(|difference| largest(difference)).fold(0.0, f64::max);
    Claim {
        id: "as_good_as_full_information",
        statement: "The regulation performance of the sensorless controller is very similar to that with the full state.".to_owned(),
        source: "Section 5, conclusions",
        verdict: Verdict::of(late <= 0.05e-3),
        measured: vec![
            Measurement::new("largest difference of the positions in the last second", 1e3 * late, "mm"),
            Measurement::new("largest difference while the flux error decays", 1e3 * early, "mm"),
        ],
        criterion: "Flux offset +10 %: in the last second the ball is nowhere further than 0.05 mm from where state feedback \
                    takes it. While the flux error decays the two differ by half the gap: similar is what comes after."
            .to_owned(),
    }
}

fn faster_with_gain(runs: &Runs) -> Claim {
    // 10 s, the length of the run, stand for never.
    let times: Vec<f64> = runs.gains[0].iter().map(|run| run.flux_settled().min(10.0)).collect();
    let left: Vec<f64> =
        runs.gains[1].iter().map(|run| root_mean_square(run.tail(&run.flux_error(), 0.1))).collect();
    let falls = times[..3].windows(2).all(|pair| pair[1] < pair[0])
        && left[..3].windows(2).all(|pair| pair[1] < pair[0]);
    let of = |name: &str, values: &[f64], unit: &'static str| -> Vec<Measurement> {
        let label = |gain: &f64| format!("{name}, gamma = {gain} 1/s");
        GAINS.iter().zip(values).map(|(gain, value)| Measurement::new(label(gain), *value, unit)).collect()
    };
    let mut measured = of("sinusoids: time to a flux error below 1 %", &times, "s");
    measured.extend(of("steps: share of lam0 left at 10 s", &left, "1"));
    Claim {
        id: "gain_speeds_up_convergence",
        statement: "The adaptation gain sets how fast the observation errors vanish.".to_owned(),
        source: "Section 5, figures 4 and 5",
        verdict: Verdict::of(falls),
        measured,
        criterion: "The paper only says that the effect is shown. Taken here: from gamma = 1 to 3 to 10 the flux converges \
                    sooner on the sinusoids and less is left after 10 s of steps. Beyond that the excitation limits."
            .to_owned(),
    }
}

fn final_errors(runs: &[Run]) -> Vec<f64> {
    runs.iter().map(|run| run.flux_error().last().map_or(f64::NAN, |error| error.abs())).collect()
}

fn steady_state_error(runs: &Runs) -> Claim {
    let (poor, well) = (final_errors(&runs.poorly_excited), final_errors(&runs.well_started));
    let grows = poor.windows(2).all(|pair| pair[1] >= pair[0]) && poor[5] > 1.1 * poor[0];
    let drift = well.iter().map(|error| (error - well[0]).abs()).fold(0.0, f64::max);
    let measured = POORLY_EXCITED_GAINS
        .iter()
        .zip(&poor)
        .rev()
        .map(|(gain, error)| {
            Measurement::new(format!("|flux error| / lam0 after 10 s, gamma = {gain} 1/s"), *error, "1")
        })
        .chain([Measurement::new("the same, filters from rest: moves by at most", drift, "1")]);
    Claim {
        id: "steady_state_error_grows_with_gain",
        statement: "A steady-state error is left that is larger for larger adaptation gains, since the excitation condition is \
                    not satisfied."
            .to_owned(),
        source: "Section 5, figure 7",
        verdict: Verdict::of(grows),
        measured: measured.collect(),
        criterion: "Reproduced under a hypothesis, as the text does not say how it comes about: filters that start from zero, no \
                    start-up hold, steps, kappa = 1e4, the observer only watching. The error then grows with each gain, by more \
                    than a tenth in all. With filters that start from rest the same gains move nothing: the error is the \
                    start's, not the method's. Neither the sinusoids nor the mechanical gains give this picture."
            .to_owned(),
    }
}

fn still_satisfactory(runs: &Runs) -> Claim {
    let run = &runs.poorly_excited_loop[0];
    let deviation = run.tracking_error();
    let rms = last_second(run, &deviation);
    Claim {
        id: "performance_still_satisfactory",
        statement: "With that steady-state error the overall performance is still satisfactory.".to_owned(),
        source: "Section 5, figure 7",
        verdict: Verdict::CannotBeJudged,
        measured: vec![
            Measurement::new("time at which the ball touches a stop, 10 s if it does not", run.lost_at.unwrap_or(10.0), "s"),
            Measurement::new("rms |y - y*| of the last second", 1e3 * rms, "mm"),
            Measurement::new("largest |y - y*|", 1e3 * largest(&deviation), "mm"),
        ],
        criterion: "What is satisfactory is not said, nor the size of the error. Shown: the estimates fed back under the \
                    hypothesis of figure 7, gamma = 1 1/s."
            .to_owned(),
    }
}

fn choice_of_filters(runs: &Runs) -> Claim {
    let spread = |reference: usize| {
        let values: Vec<f64> = runs.filter_sets[reference].iter().map(excitation).collect();
        let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(0.0, f64::max) / smallest
    };
    let (sinusoids, steps) = (spread(0), spread(1));
    Claim {
        id: "excitation_depends_on_the_filters",
        statement: "The excitation conditions depend critically on the choice of the filters.".to_owned(),
        source: "Section 6, conclusions",
        verdict: Verdict::of(sinusoids >= 10.0 && steps >= 10.0),
        measured: vec![
            Measurement::new("largest over smallest rms Delta, sinusoids", sinusoids, "1"),
            Measurement::new("largest over smallest rms Delta, steps", steps, "1"),
            Measurement::new("sets of filters", FILTER_SETS.len() as f64, "1"),
        ],
        criterion: "Over the sets of prefilters and filters in the table the rms of Delta differs by more than ten times on both \
                    references; the rate of convergence goes with its square."
            .to_owned(),
    }
}

fn excitation_is_needed(runs: &Runs) -> Claim {
    let errors: Vec<f64> = runs.constant.iter().map(|run| last_second(run, &run.flux_error())).collect();
    let energy = runs.constant[0].excitation.iter().map(|delta| delta * delta * 1e-3).sum::<f64>();
    let late = runs.constant[0].tail(&runs.constant[0].excitation, 1.0);
    Claim {
        id: "excitation_is_needed",
        statement: "Some excitation has to be imposed on the signals for the observer to converge.".to_owned(),
        source: "Section 1; condition of Proposition 6",
        verdict: Verdict::of(errors[0] > VISIBLE),
        measured: ALL_OBSERVERS
            .iter()
            .zip(&errors)
            .map(|(name, error)| Measurement::new(format!("{name}: rms flux error of the last second, share of lam0"), *error, "1"))
            .chain([
                Measurement::new("integral of (kappa Delta)^2 of drem", energy, "s"),
                Measurement::new("largest kappa Delta of its last second", largest(late), "1"),
            ])
            .collect(),
        criterion: "Constant reference, flux offset +10 %, hold of 0.1 s, 4 s: more than 1 % of lam0 is left with DREM. The two \
                    Newton variants on the same regression need no excitation."
            .to_owned(),
    }
}

fn open_integration(runs: &Runs) -> Claim {
    let measured = ALL_OBSERVERS.iter().zip(&runs.wrong_resistance).flat_map(|(name, run)| {
        let lost_at = run.lost_at.unwrap_or(4.0);
        let rms =
            if run.lost_at.is_some() { f64::NAN } else { 1e3 * last_second(run, &run.tracking_error()) };
        let time = Measurement::new(
            format!("{name}: time at which the ball touches a stop, 4 s if it does not"),
            lost_at,
            "s",
        );
        let rms = Measurement::new(format!("{name}: rms |y - y*| of the last second"), rms, "mm");
        [Some(time), rms.value.is_finite().then_some(rms)].into_iter().flatten()
    });
    let drem = &runs.wrong_resistance[0];
    let biased = last_second(drem, &drem.flux_error()) > VISIBLE;
    Claim {
        id: "open_loop_integration_is_problematic",
        statement: "The observer relies on open-loop integration, which may be problematic in practice.".to_owned(),
        source: "Remark 4 and conclusions",
        verdict: Verdict::of(drem.lost_at.is_some() || biased),
        measured: measured.collect(),
        criterion: "Sinusoids, resistance wrong by 0.1 %: with DREM the ball is lost within 4 s or the flux error exceeds 1 %. \
                    The adaptive variant is a safety net of the kind that the paper asks for."
            .to_owned(),
    }
}

/// Index of 0.1 ms and of 1 ms in [`SAMPLE_TIMES`].
fn place_of(sample_time: f64) -> usize {
    SAMPLE_TIMES.iter().position(|candidate| *candidate == sample_time).unwrap_or_default()
}

fn works_sampled(runs: &Runs) -> Claim {
    let place = place_of(1e-4);
    let both = || (0..REFERENCES.len()).map(|reference| &runs.sample_times[0][reference][place]);
    let flux = worst(both(), |run| last_second(run, &run.flux_error()));
    let tracking = worst(both(), |run| last_second(run, &run.tracking_error()));
    Claim {
        id: "drem_works_sampled",
        statement: "DREM works as a sampled controller at 0.1 ms.".to_owned(),
        source: BEYOND,
        verdict: Verdict::of(lost(both()) == 0.0 && flux <= VISIBLE && tracking <= 0.1e-3),
        measured: vec![
            Measurement::new("largest rms flux error of the last second, share of lam0", flux, "1"),
            Measurement::new("largest rms |y - y*| of the last second", 1e3 * tracking, "mm"),
            Measurement::new(
                "longest sample time at which both references work",
                1e3 * SAMPLE_TIMES
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| {
                        (0..2).all(|reference| runs.sample_times[0][reference][*k].flux_settled().is_finite())
                    })
                    .map(|(_, time)| *time)
                    .fold(0.0, f64::max),
                "ms",
            ),
        ],
        criterion: "Hold of 0.2 s, flux offset +10 %, both references: flux error at most 1 %, rms position error at most 0.1 mm."
            .to_owned(),
    }
}

fn newton(runs: &Runs) -> Claim {
    let place = place_of(1e-3);
    let both = || (0..REFERENCES.len()).map(|reference| &runs.sample_times[1][reference][place]);
    let flux = worst(both(), |run| last_second(run, &run.flux_error()));
    let constant = last_second(&runs.constant[1], &runs.constant[1].flux_error());
    Claim {
        id: "newton_needs_no_excitation_and_no_fast_sampling",
        statement: "A scalar Newton iteration on the same regression needs neither excitation nor 0.1 ms.".to_owned(),
        source: BEYOND,
        verdict: Verdict::of(lost(both()) == 0.0 && flux <= 1e-3 && constant <= 1e-9),
        measured: vec![
            Measurement::new("largest rms flux error at T = 1 ms, share of lam0", flux, "1"),
            Measurement::new("rms flux error on a constant reference, share of lam0", constant, "1"),
        ],
        criterion: "polynomial_newton: at T = 1 ms the flux error is at most 0.1 % on both references, and on a constant reference \
                    at T = 0.1 ms at most 1e-9."
            .to_owned(),
    }
}
