//! What the paper says about its observers, judged by the runs.

use super::observers::{KINDS, PRINTED_INPUT_GAIN, holding};
use super::ranking::{
    Comparison, MEASUREMENTS, NOISES, PRINTED_EXPERIMENT, PRINTED_SIMULATION, REFERENCES, Start, Table5,
};
use super::recording::{GAINS, Reference, SET_POINT};
use super::searches::{SWARMS, Searches, best, final_velocity};
use super::simulation::{Measurement, Scenario, control_error, errors, simulate};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::claim::Claim;
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::{falls, indicator, peak, rises};
use crate::study::tuning::candidate::Candidate;

pub fn all(
    packages: &LoopPackages,
    table: &Table5,
    comparisons: &[Comparison],
    searches: &Searches,
) -> Result<Vec<Claim>, StudyError> {
    Ok(vec![
        simulation_row(table),
        experiment_row(table),
        better_as_simulated(table),
        better_in_general(comparisons),
        better_under_noise(comparisons),
        swarm(searches),
        optimal(searches),
        pid(packages)?,
        bandwidth(packages)?,
    ])
}

fn simulation_row(table: &Table5) -> Claim {
    let [linear, nonlinear] = table.simulation_errors;
    let off = [linear / PRINTED_SIMULATION[0] - 1.0, nonlinear / PRINTED_SIMULATION[1] - 1.0];
    Claim::new("table_5_simulation", "Table 5, first row")
        .stating("By simulation the RMSE is 2.9797e-4 with LESO and 3.36361e-4 with NESO.")
        .measured("worst deviation from the printed numbers", peak(off), "1")
        .measured("LESO", linear, "m")
        .measured("NESO", nonlinear, "m")
        .measured("NESO over LESO (printed 1.1288)", nonlinear / linear, "1")
        .judged(
            peak(off) <= 0.01,
            "Within 1 % through the packaged models in this configuration, found by search: position in \
             metres, estimates from zero, at rest at 8.5 mm, 2 s, one Runge-Kutta step per ms, rms e1. It \
             is nothing but the start-up transient, x0 sqrt(c / T_sim); neither x0 nor T_sim is printed, so \
             only the ratio, which depends on neither, is evidence.",
        )
}

fn experiment_row(table: &Table5) -> Claim {
    let [linear, nonlinear] = table.experiment_errors;
    Claim::new("table_5_experiment", "Table 5, second row")
        .stating("By experiment the RMSE is 9.3599e-4 with LESO and 9.5948e-4 with NESO.")
        .measured("NESO over LESO (printed 1.0251)", nonlinear / linear, "1")
        .measured("LESO", linear, "V")
        .measured("NESO", nonlinear, "V")
        .measured("LESO, off the printed number", linear / PRINTED_EXPERIMENT[0] - 1.0, "1")
        .measured("NESO, off the printed number", nonlinear / PRINTED_EXPERIMENT[1] - 1.0, "1")
        .not_judged(
            "The rig is not at hand and the paper names neither reference, noise nor unit. One of many \
             simulated configurations that come close: innovation in sensor volts, reference sine of 0.71 V \
             at 0.5 Hz, noise 0.1 mV, 10 s of which the first is not scored.",
        )
}

fn better_as_simulated(table: &Table5) -> Claim {
    let [linear, nonlinear] = table.simulation_errors;
    Claim::new("leso_better_in_table_5", "Section 5")
        .stating("The RMSE of LESO is less than that of NESO in the simulation.")
        .measured("NESO over LESO", nonlinear / linear, "1")
        .judged(
            linear < nonlinear,
            "In the configuration that yields Table 5, where the start-up from zero decides.",
        )
}

/// Cases of one kind, and in how many of them LESO wins.
fn wins<'a>(cases: impl Iterator<Item = &'a Comparison>) -> (f64, f64) {
    cases
        .filter_map(Comparison::linear_wins)
        .fold((0.0, 0.0), |(wins, all), linear_wins| (wins + indicator(linear_wins), all + 1.0))
}

fn better_in_general(comparisons: &[Comparison]) -> Claim {
    let of = |measurement: Measurement, start: Start, noisy: bool| {
        wins(comparisons.iter().filter(move |case| {
            (case.measurement, case.start, case.noise > 0.0) == (measurement, start, noisy)
        }))
    };
    let (all_wins, all) = wins(comparisons.iter());
    let flip = comparisons
        .iter()
        .find(|case| {
            (case.measurement, case.start, case.noise) == (Measurement::Volts, Start::Steady, 0.0)
                && REFERENCES[case.reference].0 == Reference::SineAndStep
        })
        .map_or([f64::NAN; 3], |case| case.ratios);
    let mut claim = Claim::new("leso_better_than_neso", "Conclusion")
        .stating("LESO has better performance than NESO in terms of estimation error.")
        .measured(format!("share of {all} conditions in which LESO is better"), all_wins / all, "1")
        .measured("NESO over LESO of z1: sine and step, volts, steady start, no noise", flip[0], "1")
        .measured("the same of z2", flip[1], "1");
    for (start, start_name) in [(Start::FromZero, "from zero"), (Start::Steady, "steady start")] {
        for (measurement, unit) in MEASUREMENTS {
            for (noisy, noise) in [(false, "no noise"), (true, "noise")] {
                let (wins, count) = of(measurement, start, noisy);
                if count > 0.0 {
                    let what = format!("LESO better: {unit}, {start_name}, {noise} (of {count})");
                    claim = claim.measured(what, wins, "1");
                }
            }
        }
    }
    claim.judged(
        all_wins == all,
        "The rms error of z1 with the printed parameters is smaller with LESO in every condition: metres \
         and volts, from zero and from a steady start, four references, seven noises. Conditions in which \
         LESO makes no error but round-off are left out. The ranking flips with the unit when both start \
         from zero, since delta = 0.01 is more than the error in metres and far less in volts; and from a \
         steady start with the motion, where NESO is the better one if the noise is low and the voltage \
         jumps.",
    )
}

fn better_under_noise(comparisons: &[Comparison]) -> Claim {
    let hold = |case: &&Comparison| {
        (case.measurement, case.start, case.noise) == (Measurement::Volts, Start::Steady, 1e-3)
            && REFERENCES[case.reference].0 == Reference::Hold
    };
    let ratios = comparisons.iter().find(hold).map_or([f64::NAN; 3], |case| case.ratios);
    let steady = |case: &&Comparison| case.start == Start::Steady;
    let threshold = NOISES.iter().copied().rfind(|noise| {
        comparisons
            .iter()
            .filter(steady)
            .any(|case| case.noise == *noise && case.linear_wins() == Some(false))
    });
    Claim::new("leso_better_under_noise", "Section 5, second scenario")
        .stating("On the rig, with a real sensor, LESO shows better performance than NESO.")
        .measured("largest noise at which NESO is better for some reference", threshold.unwrap_or(0.0), "V")
        .measured("NESO over LESO of z1: ball at rest, 1 mV", ratios[0], "1")
        .measured("the same of z2", ratios[1], "1")
        .measured("the same of z3", ratios[2], "1")
        .not_judged(
            "The noise of the rig is not known. Steady start: above the first number LESO has the smaller \
             error of z1 for every reference tried, in metres and in volts. NESO multiplies small errors by \
             up to 32, and noise is a small error. Of z3 NESO is hardly worse or better there: both mostly \
             follow the voltage that the noise moves.",
        )
}

fn swarm(searches: &Searches) -> Claim {
    let [printed, falling, constriction] = [0, 1, 2].map(|swarm| final_velocity(&searches.linear[swarm]));
    Claim::new("printed_swarm_settles", "Section 4, (14) and Table 2")
        .stating("PSO with w = 1 and c1 = c2 = 1.5 finds the optimal observer parameters.")
        .measured("rms velocity over range after 60 iterations, as printed", printed, "1")
        .measured(SWARMS[1].0, falling, "1")
        .measured(SWARMS[2].0, constriction, "1")
        .measured("the same for NESO, as printed", final_velocity(&searches.nonlinear[0]), "1")
        .measured("best J for LESO, as printed", best(&searches.linear[0]), "1")
        .measured("best J for LESO, w from 0.9 to 0.4", best(&searches.linear[1]), "1")
        .judged(
            printed < 1.0,
            "30 particles, 60 iterations, middle one of 5 seeds: the particles still move by less than the \
             whole range per iteration. With w = 1 the expected squares of the velocities grow by 1.22 per \
             iteration whatever is to be minimised; only walls or a limit, which the paper does not \
             mention, keep the swarm together.",
        )
}

fn optimal(searches: &Searches) -> Claim {
    let (linear, nonlinear) = (best(&searches.linear[1]), best(&searches.nonlinear[1]));
    let (bandwidth, input_gain) = match searches.linear[1][0].candidate {
        Candidate::Linear { bandwidth, input_gain } => (bandwidth, input_gain),
        Candidate::Nonlinear { .. } => (f64::NAN, f64::NAN),
    };
    let factors = [searches.printed[0] / linear, searches.printed[1] / nonlinear];
    Claim::new("printed_parameters_are_optimal", "Tables 3 and 4, (15)")
        .stating("Tables 3 and 4 give the observers' optimal parameters.")
        .measured("J of Table 3 over the best found", factors[0], "1")
        .measured("J of Table 4 over the best found", factors[1], "1")
        .measured("J of Table 3", searches.printed[0], "1")
        .measured("best J of LESO", linear, "1")
        .measured("its bandwidth (lower end of the box)", bandwidth, "rad/s")
        .measured(
            "its input gain (in volts at 9 mm the plant's is -3705, in metres -25.8)",
            input_gain,
            "m/(s2 V)",
        )
        .measured("J of Table 4", searches.printed[1], "1")
        .measured("best J of NESO", nonlinear, "1")
        .judged(
            factors.iter().all(|factor| *factor < 1.01),
            "J of the printed parameters is within 1 % of the best found with a swarm that settles. The \
             form of (15), its weights and the overshoots are reconstructed; position in metres, estimates \
             from zero, sine of 0.15 V at 0.5 Hz, 2 s. With NESO for alpha = 1 being LESO, the best NESO \
             cannot be worse than the best LESO: the paper's ranking comes from giving both the same gains.",
        )
}

fn pid(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let run = simulate(packages, &Scenario::new(Reference::SineAndStep, 4.0, &[]))?;
    let negated = [
        ("controller.kp", Value::Real(-GAINS[0])),
        ("controller.ki", Value::Real(-GAINS[1])),
        ("controller.kd", Value::Real(-GAINS[2])),
    ];
    let other_sign = simulate(packages, &Scenario::new(Reference::SineAndStep, 4.0, &negated))?;
    let furthest = peak(run.state("position").iter().map(|position| position - SET_POINT));
    let settled = peak(run.since(3.0, &control_error(&run)));
    Ok(Claim::new("pid_holds_the_ball", "Section 5")
        .stating("The PID with Kp = 4.2, Ki = 2.2, Kd = 0.02 stabilises the rig.")
        .measured("runs that touch a stop", indicator(run.lost_at.is_some()), "1")
        .measured("largest way from 9 mm", furthest, "m")
        .measured("largest control error from 3 s on", settled, "V")
        .measured(
            "with the error r - y instead of y - r: touches a stop",
            indicator(other_sign.lost_at.is_some()),
            "1",
        )
        .judged(
            run.lost_at.is_none(),
            "Sine of 0.15 V at 0.5 Hz and step of 0.1 V at 2 s: the ball touches no stop. The position must \
             be in sensor volts and the error y - r, neither of which is printed; in metres these gains are \
             143 times too small.",
        ))
}

fn bandwidth(packages: &LoopPackages) -> Result<Claim, StudyError> {
    const BANDWIDTHS: [f64; 4] = [50.0, 100.0, 200.0, 400.0];
    let errors = |reference: Reference, noise: f64| -> Result<Vec<f64>, StudyError> {
        BANDWIDTHS
            .iter()
            .map(|bandwidth| {
                let mut parameters = holding(Measurement::Volts, "steady");
                parameters.extend([KINDS[0], ("observer.bandwidth", Value::Real(*bandwidth))]);
                let scenario = Scenario { noise, ..Scenario::new(reference, 4.0, &parameters) };
                Ok(errors(&simulate(packages, &scenario)?, Measurement::Volts, PRINTED_INPUT_GAIN, 1.0)[1])
            })
            .collect()
    };
    let (moving, noisy) = (errors(Reference::SineAndStep, 0.0)?, errors(Reference::Hold, 1e-3)?);
    let holds = falls(&moving) && rises(&noisy);
    let names = |what: &'static str| {
        BANDWIDTHS.map(|bandwidth| format!("rms e2 at {bandwidth} rad/s, {what}")).into_iter()
    };
    Ok(Claim::new("bandwidth_trades_accuracy_for_noise", "Section 3.2")
        .stating("A larger bandwidth gives a more accurate estimate and more sensitivity to noise.")
        .measured_each(names("moving, no noise").zip(moving), "V/s")
        .measured_each(names("at rest, 1 mV").zip(noisy), "V/s")
        .judged(
            holds,
            "LESO in sensor volts, steady start: from 50 to 400 rad/s the velocity error falls with each \
             step for the moving ball without noise, and rises with each step for the resting ball with 1 \
             mV of noise.",
        ))
}
