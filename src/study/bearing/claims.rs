//! What the paper says about its observer and loop, judged by the runs.

use super::scenario::{Run, Scenario, largest, simulate};
use super::{BIAS_FLUXES, LAWS, POSITIONS, Runs, SAMPLE_TIME, SIMULATION_TIME, VOLTAGES};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::claim::{Claim, Measurement, Verdict};
use crate::study::loop_packages::LoopPackages;

/// Share of a signal's peak up to which an error counts as zero in a figure.
const VISIBLE: f64 = 0.01;
/// Time after which the paper says the observer has converged \[s\].
const CONVERGENCE_TIME: f64 = 0.05;
const STATE_NAMES: [&str; 3] = ["position", "velocity", "flux"];

pub fn all(packages: &LoopPackages, runs: &Runs) -> Result<Vec<Claim>, StudyError> {
    Ok(vec![
        convergence(
            "observer_converges_within_50_ms",
            "With law (8a) the estimation error goes to zero within 0.05 s for all three states and every x1(0).",
            "Section 4, figures 2 and 3",
            &(0..3).map(|k| runs.of(0, k, 2)).collect::<Vec<_>>(),
        ),
        convergence(
            "observer_converges_for_every_initial_voltage",
            "The observer converges for u(0) = -50, -100 and -150 V.",
            "Section 4, figure 4",
            &(0..3).map(|k| runs.of(0, 2, k)).collect::<Vec<_>>(),
        ),
        convergence(
            "observer_converges_for_every_law",
            "The estimation errors converge to zero with the laws (8a), (8b) and (8c).",
            "Section 4, figure 5",
            &(0..3).map(|law| runs.of(law, 2, 2)).collect::<Vec<_>>(),
        ),
        largest_error(runs),
        voltage_limit(runs),
        agreement(runs),
        stabler_with_larger_voltage(runs),
        bias(runs),
        iterations(runs),
        settling(runs),
        exactness(packages)?,
        table_1(),
        global_stability(packages)?,
    ])
}

/// Last time \[s\] at which the estimation error of any state exceeds [`VISIBLE`] of that state's peak.
fn last_visible_error(run: &Run) -> f64 {
    (0..3)
        .flat_map(|state| {
            let limit = VISIBLE * run.peak(state);
            run.time
                .iter()
                .zip(run.error(state))
                .filter(move |(_, error)| error.abs() > limit)
                .map(|(t, _)| *t)
        })
        .fold(0.0, f64::max)
}

fn convergence(id: &'static str, statement: &str, source: &'static str, runs: &[&Run]) -> Claim {
    let last = runs.iter().map(|run| last_visible_error(run)).fold(0.0, f64::max);
    let after = |state: usize| {
        runs.iter().map(|run| run.largest_error_after(CONVERGENCE_TIME, state)).fold(0.0, f64::max)
    };
    Claim {
        id,
        statement: statement.to_owned(),
        source,
        verdict: Verdict::of(last <= CONVERGENCE_TIME),
        measured: vec![
            Measurement::new("last error above 1 % of the signal's peak", last, "s"),
            Measurement::new("largest position error after 0.05 s", after(0), "m"),
            Measurement::new("largest velocity error after 0.05 s", after(1), "m/s"),
            Measurement::new("largest flux error after 0.05 s", after(2), "Wb"),
        ],
        criterion: format!(
            "Over {} runs of 10 s: the last sample at which any state's estimation error exceeds 1 % of that state's \
             peak comes no later than 0.05 s.",
            runs.len()
        ),
    }
}

fn largest_error(runs: &Runs) -> Claim {
    let peaks: Vec<f64> = (0..3).map(|k| runs.of(0, k, 2).largest_error_after(0.0, 2)).collect();
    let ratio = peaks[2] / peaks[0].max(peaks[1]);
    let verdict =
        if (ratio - 1.0).abs() < VISIBLE { Verdict::CannotBeJudged } else { Verdict::of(ratio > 1.0) };
    Claim {
        id: "largest_convergence_error_from_10_mm",
        statement: "The convergence error is greatest for x1(0) = 0.01 m.".to_owned(),
        source: "Section 4, figure 3",
        verdict,
        measured: std::iter::once(Measurement::new("peak flux error at 0.01 m over the largest of the others", ratio, "1"))
            .chain(POSITIONS.iter().zip(&peaks).map(|(position, peak)| {
                Measurement::new(format!("peak flux error, x1(0) = {position} m"), *peak, "Wb")
            }))
            .collect(),
        criterion: "The peak of the flux estimation error is larger than with the other initial positions (law (8a), \
                    u(0) = -150 V); within 1 % of them it cannot be told. Position errors say nothing here, because \
                    until two past samples exist the estimate is the measured position."
            .to_owned(),
    }
}

fn voltage_limit(runs: &Runs) -> Claim {
    let peak = runs
        .grid
        .iter()
        .chain(&runs.biased)
        .map(|run| largest(run.voltage.iter().copied()))
        .fold(0.0, f64::max);
    let later = runs.grid.iter().map(|run| largest(run.voltage[1..].iter().copied())).fold(0.0, f64::max);
    Claim {
        id: "voltage_within_150_V",
        statement: "The control voltage does not exceed 150 V in absolute value.".to_owned(),
        source: "Section 4",
        verdict: Verdict::of(peak <= 150.0),
        measured: vec![
            Measurement::new("largest |u|", peak, "V"),
            Measurement::new("largest |u| after the first sample", later, "V"),
        ],
        criterion: "Largest |u| of all 30 observer-based runs is at most 150 V. The limit is only ever reached by u(0), \
                    which is prescribed."
            .to_owned(),
    }
}

fn agreement(runs: &Runs) -> Claim {
    let share = |state: usize| {
        (0..9)
            .map(|k| {
                let (observed, fed_back) = (runs.of(0, k / 3, k % 3), runs.with_state(k / 3, k % 3));
                let difference = observed.state[state].iter().zip(&fed_back.state[state]).map(|(a, b)| a - b);
                largest(difference) / fed_back.peak(state)
            })
            .fold(0.0, f64::max)
    };
    let shares: Vec<f64> = (0..3).map(share).collect();
    let worst = shares.iter().copied().fold(0.0, f64::max);
    Claim {
        id: "observer_loop_agrees_with_state_feedback",
        statement: "The observer-based loop follows the state feedback trajectories.".to_owned(),
        source: "Section 4, figure 4",
        verdict: Verdict::of(worst <= 0.05),
        measured: std::iter::once(Measurement::new("worst difference over the peak", worst, "1"))
            .chain(STATE_NAMES.iter().zip(&shares).map(|(name, share)| Measurement::new(*name, *share, "1")))
            .collect(),
        criterion: "Law (8a), nine starts: over 10 s the largest difference of each state is at most 5 % of its peak."
            .to_owned(),
    }
}

fn stabler_with_larger_voltage(runs: &Runs) -> Claim {
    // Root mean square of the displacement, per initial voltage, averaged over the three initial positions.
    let spread: Vec<f64> = (0..3)
        .map(|voltage| {
            let square =
                |run: &Run| run.state[0].iter().map(|x| x * x).sum::<f64>() / run.state[0].len() as f64;
            ((0..3).map(|position| square(runs.of(0, position, voltage))).sum::<f64>() / 3.0).sqrt()
        })
        .collect();
    let decreasing = spread.windows(2).all(|pair| pair[1] < pair[0]);
    Claim {
        id: "larger_initial_voltage_is_more_stable",
        statement: "A larger initial voltage gives a more stable closed loop.".to_owned(),
        source: "Section 4, figure 4",
        verdict: Verdict::of(decreasing),
        measured: VOLTAGES
            .iter()
            .zip(&spread)
            .map(|(voltage, spread)| Measurement::new(format!("rms displacement, u(0) = {voltage} V"), *spread, "m"))
            .collect(),
        criterion: "The paper does not say how it measures stability. Taken here: the rms displacement over 10 s, law \
                    (8a), over all three x1(0), falls from -50 to -100 to -150 V."
            .to_owned(),
    }
}

fn bias(runs: &Runs) -> Claim {
    let shares: Vec<f64> =
        runs.biased.iter().map(|run| run.largest_error_after(CONVERGENCE_TIME, 2) / run.peak(2)).collect();
    let worst = shares.iter().copied().fold(0.0, f64::max);
    let apart = largest(runs.biased[2].state[2].iter().zip(&runs.biased[0].state[2]).map(|(a, b)| a - b))
        / runs.biased[0].peak(2);
    Claim {
        id: "flux_estimates_alike_for_every_bias",
        statement: "The flux estimation is similar for bias fluxes of 0, 100 and 1000 µWb.".to_owned(),
        source: "Section 4, figure 6",
        verdict: Verdict::of(worst <= VISIBLE),
        measured: BIAS_FLUXES
            .iter()
            .zip(&shares)
            .map(|(bias, share)| {
                Measurement::new(
                    format!("flux error after 0.05 s over peak, bias {} µWb", (bias * 1e6).round()),
                    *share,
                    "1",
                )
            })
            .chain([Measurement::new("flux trajectories with 1000 and 0 µWb apart, over peak", apart, "1")])
            .collect(),
        criterion:
            "With each bias the flux estimation error after 0.05 s stays below 1 % of the flux peak. The \
                    trajectories themselves differ, since the bias changes the force."
                .to_owned(),
    }
}

fn iterations(runs: &Runs) -> Claim {
    let (ten, hundred) = (runs.of(0, 2, 2), &runs.many_iterations);
    let difference =
        largest(ten.estimate[2].iter().zip(&hundred.estimate[2]).map(|(a, b)| a - b)) / ten.peak(2);
    Claim {
        id: "more_iterations_change_little",
        statement: "Once big enough, the number d of Newton iterations has a small effect (the text takes 10, Table 1 \
                    says 100)."
            .to_owned(),
        source: "Remark 1 and Table 1",
        verdict: Verdict::of(difference <= VISIBLE),
        measured: vec![Measurement::new("flux estimates with d = 10 and 100 apart, over peak", difference, "1")],
        criterion: "Law (8a), x1(0) = 0.01 m, u(0) = -150 V: the flux estimates differ by at most 1 % of the peak."
            .to_owned(),
    }
}

/// Time \[s\] from which on the displacement stays within 2 % of its peak; `None` if it does not.
fn settling_time(run: &Run) -> Option<f64> {
    let limit = 0.02 * run.peak(0);
    let last = run.state[0].iter().rposition(|x| x.abs() > limit)?;
    run.time.get(last + 1).copied()
}

fn settling(runs: &Runs) -> Claim {
    let all: Vec<&Run> = runs.grid.iter().chain(&runs.biased).collect();
    let settled = all.iter().filter(|run| settling_time(run).is_some()).count();
    let at_end: Vec<f64> = all.iter().map(|run| run.state[0].last().map_or(0.0, |x| x.abs())).collect();
    let peaks: Vec<f64> = all.iter().map(|run| run.peak(0)).collect();
    let smallest = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    Claim {
        id: "settling_below_10_s",
        statement: "The settling time is below 10 s for all simulations.".to_owned(),
        source: "Section 4",
        verdict: Verdict::of(settled == all.len()),
        measured: vec![
            Measurement::new(format!("runs that settle, of {}", all.len()), settled as f64, "1"),
            Measurement::new("|x1(10 s)|, smallest", smallest(&at_end), "m"),
            Measurement::new("|x1(10 s)|, largest", largest(&at_end), "m"),
            Measurement::new("peak |x1|, smallest", smallest(&peaks), "m"),
            Measurement::new("peak |x1|, largest", largest(&peaks), "m"),
        ],
        criterion: "Every run enters, before 10 s, a band of 2 % of its own peak displacement and stays there. With the \
                    printed gains the loop without bias decays only algebraically."
            .to_owned(),
    }
}

/// One step of the plant across a flux zero crossing, by both maps.
fn exactness(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let step = |map: &str| -> Result<f64, StudyError> {
        let mut plant = packages.plant(&[
            ("map", Value::Text(map)),
            ("initial.position", Value::Real(0.0)),
            ("initial.flux", Value::Real(0.05)),
            ("voltage", Value::Real(-100.0)),
        ])?;
        plant.initialise(0.0, None)?;
        plant.step(0.0, SAMPLE_TIME)?;
        Ok(plant.get_by_name("velocity")?)
    };
    let difference = (step("printed")? - step("exact")?).abs();
    // Largest velocity that the force gives within the step.
    let scale = SAMPLE_TIME * 0.05 * 0.05 / 3.0;
    Ok(Claim {
        id: "discrete_model_is_exact",
        statement: "(4) is the exact sampled-data model of (3).".to_owned(),
        source: "Section 2, after (4b)",
        verdict: Verdict::of(difference <= 1e-12 * scale),
        measured: vec![
            Measurement::new("velocity error of (4a) over the velocity gained up to the crossing", difference / scale, "1"),
            Measurement::new("velocity error of (4a) in one step", difference, "m/s"),
        ],
        criterion: "One step of 1 ms from a flux of 0.05 Wb with -100 V, which crosses zero half way, by (4a) and split \
                    at the crossing. Without a sign change the two agree to the last digit; the paper itself notes that \
                    its derivatives do not hold at zero flux."
            .to_owned(),
    })
}

fn table_1() -> Claim {
    let printed_samples = 1000.0;
    let covered = printed_samples * SAMPLE_TIME;
    Claim {
        id: "table_1_is_consistent",
        statement: "T = 1 ms, k_max = 1000 samples and a simulation time of 10 s go together.".to_owned(),
        source: "Table 1",
        verdict: Verdict::of((covered - SIMULATION_TIME).abs() < 1e-9),
        measured: vec![
            Measurement::new("time that k_max samples cover", covered, "s"),
            Measurement::new("samples in 10 s", (SIMULATION_TIME / SAMPLE_TIME).round(), "1"),
        ],
        criterion: "k_max T equals t_max. The runs here last 10 s.".to_owned(),
    }
}

fn global_stability(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let duration = 400.0;
    let run = simulate(packages, &Scenario::new(0.01, -150.0), duration)?;
    // Peak of the displacement over the last period of the slow oscillation.
    let late =
        largest(run.time.iter().zip(&run.state[0]).filter(|(t, _)| **t > duration - 50.0).map(|(_, x)| *x));
    let early = run.peak(0);
    Ok(Claim {
        id: "globally_asymptotically_stable",
        statement: "The observer-based loop is globally asymptotically stable.".to_owned(),
        source: "Section 5",
        verdict: Verdict::CannotBeJudged,
        measured: vec![
            Measurement::new("peak |x1| from 350 to 400 s", late, "m"),
            Measurement::new("peak |x1| of the run", early, "m"),
            Measurement::new("runs looked at", (LAWS.len() * POSITIONS.len() * VOLTAGES.len()) as f64, "1"),
        ],
        criterion:
            "Finitely many runs prove no global property. Shown instead: law (8a) from x1(0) = 0.01 m, \
                    u(0) = -150 V over 400 s, which decays, but slowly."
                .to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run over 10 s whose displacement decays at `rate` \[1/s\] and whose flux estimate is off by `offset` \[Wb\]
    /// up to `until` \[s\].
    fn run(rate: f64, offset: f64, until: f64) -> Run {
        let time: Vec<f64> = (0..=10_000).map(|k| f64::from(k) * 1e-3).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.01 * (-rate * t).exp()).collect();
        let flux = vec![0.1; time.len()];
        let estimate = time.iter().map(|t| if *t <= until { 0.1 + offset } else { 0.1 }).collect();
        let zero = vec![0.0; time.len()];
        Run {
            state: [position.clone(), zero.clone(), flux],
            estimate: [position, zero.clone(), estimate],
            voltage: zero,
            time,
        }
    }

    #[test]
    fn settling_is_found_or_not() {
        // 2 % are reached at ln(50) / rate.
        let settled = settling_time(&run(1.0, 0.0, 0.0)).unwrap();
        assert!((settled - 50f64.ln()).abs() < 2e-3);
        assert_eq!(settling_time(&run(0.1, 0.0, 0.0)), None);
    }

    #[test]
    fn convergence_can_fail() {
        let judge = |run: &Run| convergence("id", "", "", &[run]).verdict;
        assert_eq!(judge(&run(1.0, 0.01, 0.04)), Verdict::Reproduced);
        assert_eq!(judge(&run(1.0, 0.01, 0.06)), Verdict::NotReproduced);
        // Less than 1 % of the flux cannot be seen.
        assert_eq!(judge(&run(1.0, 0.0009, 5.0)), Verdict::Reproduced);
    }
}
