//! What the paper says about its observer and loop, judged by the runs.

use super::runs::{BIAS_FLUXES, LAWS, POSITIONS, Runs, SIMULATION_TIME, VOLTAGES};
use super::scenario::{SAMPLE_TIME, STATES, Scenario, largest_error, simulate};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::claim::Claim;
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::{difference, falls, largest, peak, root_mean_square, smallest};
use crate::study::run::Run;
use crate::study::sweep::indices;

/// Share of a signal's peak up to which an error counts as zero in a figure.
const VISIBLE: f64 = 0.01;
/// Time after which the paper says the observer has converged \[s\].
const CONVERGENCE_TIME: f64 = 0.05;

pub fn all(packages: &LoopPackages, runs: &Runs) -> Result<Vec<Claim>, StudyError> {
    Ok(vec![
        convergence(
            "observer_converges_within_50_ms",
            "With law (8a) the estimation error goes to zero within 0.05 s for all three states and every \
             x1(0).",
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
        largest_from_afar(runs),
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
    largest(STATES.iter().flat_map(|state| {
        let limit = VISIBLE * peak(run.state(state));
        let errors = run.time.iter().zip(run.error(state));
        errors.filter(move |(_, error)| error.abs() > limit).map(|(time, _)| *time)
    }))
}

fn convergence(id: &'static str, statement: &str, source: &'static str, runs: &[&Run]) -> Claim {
    let last = largest(runs.iter().map(|run| last_visible_error(run)));
    let after = |state: &str| largest(runs.iter().map(|run| largest_error(run, CONVERGENCE_TIME, state)));
    Claim::new(id, source)
        .stating(statement)
        .measured("last error above 1 % of the signal's peak", last, "s")
        .measured("largest position error after 0.05 s", after("position"), "m")
        .measured("largest velocity error after 0.05 s", after("velocity"), "m/s")
        .measured("largest flux error after 0.05 s", after("flux"), "Wb")
        .judged(
            last <= CONVERGENCE_TIME,
            format!(
                "Over {} runs of 10 s: the last sample at which any state's estimation error exceeds 1 % of \
                 that state's peak comes no later than 0.05 s.",
                runs.len()
            ),
        )
}

fn largest_from_afar(runs: &Runs) -> Claim {
    let peaks: Vec<f64> = (0..3).map(|k| largest_error(runs.of(0, k, 2), 0.0, "flux")).collect();
    let ratio = peaks[2] / peaks[0].max(peaks[1]);
    let claim = Claim::new("largest_convergence_error_from_10_mm", "Section 4, figure 3")
        .stating("The convergence error is greatest for x1(0) = 0.01 m.")
        .measured("peak flux error at 0.01 m over the largest of the others", ratio, "1")
        .measured_each(
            POSITIONS.map(|position| format!("peak flux error, x1(0) = {position} m")).into_iter().zip(peaks),
            "Wb",
        );
    let criterion = "The peak of the flux estimation error is larger than with the other initial positions \
                     (law (8a), u(0) = -150 V); within 1 % of them it cannot be told. Position errors say \
                     nothing here, because until two past samples exist the estimate is the measured \
                     position.";
    if (ratio - 1.0).abs() < VISIBLE {
        claim.not_judged(criterion)
    } else {
        claim.judged(ratio > 1.0, criterion)
    }
}

fn voltage_limit(runs: &Runs) -> Claim {
    let voltage = |run: &Run| peak(&run["controller.voltage"]);
    let later = |run: &Run| peak(&run["controller.voltage"][1..]);
    let highest = largest(runs.grid.iter().chain(&runs.biased).map(voltage));
    Claim::new("voltage_within_150_V", "Section 4")
        .stating("The control voltage does not exceed 150 V in absolute value.")
        .measured("largest |u|", highest, "V")
        .measured("largest |u| after the first sample", largest(runs.grid.iter().map(later)), "V")
        .judged(
            highest <= 150.0,
            "Largest |u| of all 30 observer-based runs is at most 150 V. The limit is only ever reached by \
             u(0), which is prescribed.",
        )
}

fn agreement(runs: &Runs) -> Claim {
    let share = |state: &str| {
        largest(indices([POSITIONS.len(), VOLTAGES.len()]).into_iter().map(|[position, voltage]| {
            let fed_back = runs.with_state(position, voltage).state(state);
            peak(difference(runs.of(0, position, voltage).state(state), fed_back)) / peak(fed_back)
        }))
    };
    let shares = STATES.map(share);
    let worst = largest(shares);
    Claim::new("observer_loop_agrees_with_state_feedback", "Section 4, figure 4")
        .stating("The observer-based loop follows the state feedback trajectories.")
        .measured("worst difference over the peak", worst, "1")
        .measured_each(STATES.into_iter().zip(shares), "1")
        .judged(
            worst <= 0.05,
            "Law (8a), nine starts: over 10 s the largest difference of each state is at most 5 % of its \
             peak.",
        )
}

fn stabler_with_larger_voltage(runs: &Runs) -> Claim {
    // Root mean square of the displacement, per initial voltage, averaged over the three initial positions.
    let spread = [0, 1, 2].map(|voltage| {
        let square = |position| root_mean_square(runs.of(0, position, voltage).state("position")).powi(2);
        ((0..3).map(square).sum::<f64>() / 3.0).sqrt()
    });
    Claim::new("larger_initial_voltage_is_more_stable", "Section 4, figure 4")
        .stating("A larger initial voltage gives a more stable closed loop.")
        .measured_each(
            VOLTAGES.map(|voltage| format!("rms displacement, u(0) = {voltage} V")).into_iter().zip(spread),
            "m",
        )
        .judged(
            falls(&spread),
            "The paper does not say how it measures stability. Taken here: the rms displacement over 10 s, \
             law (8a), over all three x1(0), falls from -50 to -100 to -150 V.",
        )
}

fn bias(runs: &Runs) -> Claim {
    let flux = |run: usize| runs.biased[run].state("flux");
    let shares =
        [0, 1, 2].map(|run| largest_error(&runs.biased[run], CONVERGENCE_TIME, "flux") / peak(flux(run)));
    let apart = peak(difference(flux(2), flux(0))) / peak(flux(0));
    let name = |bias: f64| format!("flux error after 0.05 s over peak, bias {} µWb", (bias * 1e6).round());
    Claim::new("flux_estimates_alike_for_every_bias", "Section 4, figure 6")
        .stating("The flux estimation is similar for bias fluxes of 0, 100 and 1000 µWb.")
        .measured_each(BIAS_FLUXES.map(name).into_iter().zip(shares), "1")
        .measured("flux trajectories with 1000 and 0 µWb apart, over peak", apart, "1")
        .judged(
            largest(shares) <= VISIBLE,
            "With each bias the flux estimation error after 0.05 s stays below 1 % of the flux peak. The \
             trajectories themselves differ, since the bias changes the force.",
        )
}

fn iterations(runs: &Runs) -> Claim {
    let (ten, hundred) = (runs.of(0, 2, 2), &runs.many_iterations);
    let apart = peak(difference(ten.estimate("flux"), hundred.estimate("flux"))) / peak(ten.state("flux"));
    Claim::new("more_iterations_change_little", "Remark 1 and Table 1")
        .stating(
            "Once big enough, the number d of Newton iterations has a small effect (the text takes 10, \
             Table 1 says 100).",
        )
        .measured("flux estimates with d = 10 and 100 apart, over peak", apart, "1")
        .judged(
            apart <= VISIBLE,
            "Law (8a), x1(0) = 0.01 m, u(0) = -150 V: the flux estimates differ by at most 1 % of the peak.",
        )
}

/// Time \[s\] from which on the displacement stays within 2 % of its peak; infinite if it does not.
fn displacement_settled(run: &Run) -> f64 {
    let displacement = run.state("position");
    run.settled(displacement, 0.02 * peak(displacement))
}

fn settling(runs: &Runs) -> Claim {
    let all: Vec<&Run> = runs.grid.iter().chain(&runs.biased).collect();
    let settled = all.iter().filter(|run| displacement_settled(run).is_finite()).count();
    let at_end: Vec<f64> = all.iter().map(|run| peak(run.state("position").last())).collect();
    let peaks: Vec<f64> = all.iter().map(|run| peak(run.state("position"))).collect();
    Claim::new("settling_below_10_s", "Section 4")
        .stating("The settling time is below 10 s for all simulations.")
        .measured(format!("runs that settle, of {}", all.len()), settled as f64, "1")
        .measured("|x1(10 s)|, smallest", smallest(&at_end), "m")
        .measured("|x1(10 s)|, largest", largest(&at_end), "m")
        .measured("peak |x1|, smallest", smallest(&peaks), "m")
        .measured("peak |x1|, largest", largest(&peaks), "m")
        .judged(
            settled == all.len(),
            "Every run enters, before 10 s, a band of 2 % of its own peak displacement and stays there. \
             With the printed gains the loop without bias decays only algebraically.",
        )
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
    Ok(Claim::new("discrete_model_is_exact", "Section 2, after (4b)")
        .stating("(4) is the exact sampled-data model of (3).")
        .measured(
            "velocity error of (4a) over the velocity gained up to the crossing",
            difference / scale,
            "1",
        )
        .measured("velocity error of (4a) in one step", difference, "m/s")
        .judged(
            difference <= 1e-12 * scale,
            "One step of 1 ms from a flux of 0.05 Wb with -100 V, which crosses zero half way, by (4a) and \
             split at the crossing. Without a sign change the two agree to the last digit; the paper itself \
             notes that its derivatives do not hold at zero flux.",
        ))
}

fn table_1() -> Claim {
    let printed_samples = 1000.0;
    let covered = printed_samples * SAMPLE_TIME;
    Claim::new("table_1_is_consistent", "Table 1")
        .stating("T = 1 ms, k_max = 1000 samples and a simulation time of 10 s go together.")
        .measured("time that k_max samples cover", covered, "s")
        .measured("samples in 10 s", (SIMULATION_TIME / SAMPLE_TIME).round(), "1")
        .judged((covered - SIMULATION_TIME).abs() < 1e-9, "k_max T equals t_max. The runs here last 10 s.")
}

fn global_stability(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let duration = 400.0;
    let run = simulate(packages, &Scenario::new(0.01, -150.0), duration)?;
    // Peak of the displacement over the last period of the slow oscillation.
    let displacement = run.state("position");
    let late = peak(run.last(50.0, displacement));
    Ok(Claim::new("globally_asymptotically_stable", "Section 5")
        .stating("The observer-based loop is globally asymptotically stable.")
        .measured("peak |x1| from 350 to 400 s", late, "m")
        .measured("peak |x1| of the run", peak(displacement), "m")
        .measured("runs looked at", (LAWS.len() * POSITIONS.len() * VOLTAGES.len()) as f64, "1")
        .not_judged(
            "Finitely many runs prove no global property. Shown instead: law (8a) from x1(0) = 0.01 m, u(0) \
             = -150 V over 400 s, which decays, but slowly.",
        ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::claim::Verdict;

    /// A run over 10 s whose displacement decays at `rate` \[1/s\] and whose flux estimate is off by `offset` \[Wb\]
    /// up to `until` \[s\].
    fn run(rate: f64, offset: f64, until: f64) -> Run {
        let time: Vec<f64> = (0..=10_000).map(|k| f64::from(k) * 1e-3).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.01 * (-rate * t).exp()).collect();
        let estimate = time.iter().map(|t| if *t <= until { 0.1 + offset } else { 0.1 }).collect();
        let (flux, zero) = (vec![0.1; time.len()], vec![0.0; time.len()]);
        Run::new(time)
            .with("plant.position", position.clone())
            .with("plant.velocity", zero.clone())
            .with("plant.flux", flux)
            .with("controller.estimate.position", position)
            .with("controller.estimate.velocity", zero)
            .with("controller.estimate.flux", estimate)
    }

    #[test]
    fn settling_is_found_or_not() {
        // 2 % are reached at ln(50) / rate.
        let settled = displacement_settled(&run(1.0, 0.0, 0.0));
        assert!((settled - 50f64.ln()).abs() < 2e-3);
        assert_eq!(displacement_settled(&run(0.1, 0.0, 0.0)), f64::INFINITY);
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
