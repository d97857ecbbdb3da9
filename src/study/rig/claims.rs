//! What the paper says about its observers, judged by the runs.

use super::observers::{KINDS, PRINTED_INPUT_GAIN, holding};
use super::ranking::{Comparison, NOISES, PRINTED_EXPERIMENT, PRINTED_SIMULATION, REFERENCES, Start, Table5};
use super::recording::{GAINS, Reference, SET_POINT};
use super::searches::{SWARMS, Searches, best, final_velocity};
use super::simulation::{Measurement, Scenario, largest, simulate};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::claim::{Claim, Measurement as Measured, Verdict};
use crate::study::loop_packages::LoopPackages;
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
    Claim {
        id: "table_5_simulation",
        statement: "By simulation the RMSE is 2.9797e-4 with LESO and 3.36361e-4 with NESO.".to_owned(),
        source: "Table 5, first row",
        verdict: Verdict::of(largest(off) <= 0.01),
        measured: vec![
            Measured::new("worst deviation from the printed numbers", largest(off), "1"),
            Measured::new("LESO", linear, "m"),
            Measured::new("NESO", nonlinear, "m"),
            Measured::new("NESO over LESO (printed 1.1288)", nonlinear / linear, "1"),
        ],
        criterion: "Within 1 % through the packaged units in this configuration, found by search: position in metres, \
                    estimates from zero, at rest at 8.5 mm, 2 s, one Runge-Kutta step per ms, rms e1. It is nothing but \
                    the start-up transient, x0 sqrt(c / T_sim); neither x0 nor T_sim is printed, so only the ratio, \
                    which depends on neither, is evidence."
            .to_owned(),
    }
}

fn experiment_row(table: &Table5) -> Claim {
    let [linear, nonlinear] = table.experiment_errors;
    Claim {
        id: "table_5_experiment",
        statement: "By experiment the RMSE is 9.3599e-4 with LESO and 9.5948e-4 with NESO.".to_owned(),
        source: "Table 5, second row",
        verdict: Verdict::CannotBeJudged,
        measured: vec![
            Measured::new("NESO over LESO (printed 1.0251)", nonlinear / linear, "1"),
            Measured::new("LESO", linear, "V"),
            Measured::new("NESO", nonlinear, "V"),
            Measured::new("LESO, off the printed number", linear / PRINTED_EXPERIMENT[0] - 1.0, "1"),
            Measured::new("NESO, off the printed number", nonlinear / PRINTED_EXPERIMENT[1] - 1.0, "1"),
        ],
        criterion: "The rig is not at hand and the paper names neither reference, noise nor unit. One of many simulated \
                    configurations that come close: innovation in sensor volts, reference sine of 0.71 V at 0.5 Hz, noise \
                    0.1 mV, 10 s of which the first is not scored."
            .to_owned(),
    }
}

fn better_as_simulated(table: &Table5) -> Claim {
    let [linear, nonlinear] = table.simulation_errors;
    Claim {
        id: "leso_better_in_table_5",
        statement: "The RMSE of LESO is less than that of NESO in the simulation.".to_owned(),
        source: "Section 5",
        verdict: Verdict::of(linear < nonlinear),
        measured: vec![Measured::new("NESO over LESO", nonlinear / linear, "1")],
        criterion: "In the configuration that yields Table 5, where the start-up from zero decides."
            .to_owned(),
    }
}

/// Cases of one kind, and in how many of them LESO wins.
fn wins<'a>(cases: impl Iterator<Item = &'a Comparison>) -> (f64, f64) {
    cases
        .filter_map(Comparison::linear_wins)
        .fold((0.0, 0.0), |(wins, all), linear_wins| (wins + f64::from(u8::from(linear_wins)), all + 1.0))
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
    let mut measured = vec![
        Measured::new(format!("share of {all} conditions in which LESO is better"), all_wins / all, "1"),
        Measured::new("NESO over LESO of z1: sine and step, volts, steady start, no noise", flip[0], "1"),
        Measured::new("the same of z2", flip[1], "1"),
    ];
    for (start, start_name) in [(Start::FromZero, "from zero"), (Start::Steady, "steady start")] {
        for (measurement, unit) in [(Measurement::Metres, "metres"), (Measurement::Volts, "volts")] {
            for (noisy, noise) in [(false, "no noise"), (true, "noise")] {
                let (wins, count) = of(measurement, start, noisy);
                if count > 0.0 {
                    let what = format!("LESO better: {unit}, {start_name}, {noise} (of {count})");
                    measured.push(Measured::new(what, wins, "1"));
                }
            }
        }
    }
    Claim {
        id: "leso_better_than_neso",
        statement: "LESO has better performance than NESO in terms of estimation error.".to_owned(),
        source: "Conclusion",
        verdict: Verdict::of(all_wins == all),
        measured,
        criterion: "The rms error of z1 with the printed parameters is smaller with LESO in every condition: metres and \
                    volts, from zero and from a steady start, four references, seven noises. Conditions in which LESO \
                    makes no error but round-off are left out. The ranking flips with the unit when both start from zero, \
                    since delta = 0.01 is more than the error in metres and far less in volts; and from a steady start \
                    with the motion, where NESO is the better one if the noise is low and the voltage jumps."
            .to_owned(),
    }
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
    Claim {
        id: "leso_better_under_noise",
        statement: "On the rig, with a real sensor, LESO shows better performance than NESO.".to_owned(),
        source: "Section 5, second scenario",
        verdict: Verdict::CannotBeJudged,
        measured: vec![
            Measured::new("largest noise at which NESO is better for some reference", threshold.unwrap_or(0.0), "V"),
            Measured::new("NESO over LESO of z1: ball at rest, 1 mV", ratios[0], "1"),
            Measured::new("the same of z2", ratios[1], "1"),
            Measured::new("the same of z3", ratios[2], "1"),
        ],
        criterion: "The noise of the rig is not known. Steady start: above the first number LESO has the smaller error of z1 \
                    for every reference tried, in metres and in volts. NESO multiplies small errors by up to 32, and noise \
                    is a small error. Of z3 NESO is hardly worse or better there: both mostly follow the voltage that the \
                    noise moves."
            .to_owned(),
    }
}

fn swarm(searches: &Searches) -> Claim {
    let [printed, falling, constriction] = [0, 1, 2].map(|swarm| final_velocity(&searches.linear[swarm]));
    Claim {
        id: "printed_swarm_settles",
        statement: "PSO with w = 1 and c1 = c2 = 1.5 finds the optimal observer parameters.".to_owned(),
        source: "Section 4, (14) and Table 2",
        verdict: Verdict::of(printed < 1.0),
        measured: vec![
            Measured::new("rms velocity over range after 60 iterations, as printed", printed, "1"),
            Measured::new(SWARMS[1].0, falling, "1"),
            Measured::new(SWARMS[2].0, constriction, "1"),
            Measured::new("the same for NESO, as printed", final_velocity(&searches.nonlinear[0]), "1"),
            Measured::new("best J for LESO, as printed", best(&searches.linear[0]), "1"),
            Measured::new("best J for LESO, w from 0.9 to 0.4", best(&searches.linear[1]), "1"),
        ],
        criterion: "30 particles, 60 iterations, middle one of 5 seeds: the particles still move by less than the whole \
                    range per iteration. With w = 1 the expected squares of the velocities grow by 1.22 per iteration \
                    whatever is to be minimised; only walls or a limit, which the paper does not mention, keep the swarm \
                    together."
            .to_owned(),
    }
}

fn optimal(searches: &Searches) -> Claim {
    let (linear, nonlinear) = (best(&searches.linear[1]), best(&searches.nonlinear[1]));
    let (bandwidth, input_gain) = match searches.linear[1][0].candidate {
        Candidate::Linear { bandwidth, input_gain } => (bandwidth, input_gain),
        Candidate::Nonlinear { .. } => (f64::NAN, f64::NAN),
    };
    let factors = [searches.printed[0] / linear, searches.printed[1] / nonlinear];
    Claim {
        id: "printed_parameters_are_optimal",
        statement: "Tables 3 and 4 give the observers' optimal parameters.".to_owned(),
        source: "Tables 3 and 4, (15)",
        verdict: Verdict::of(factors.iter().all(|factor| *factor < 1.01)),
        measured: vec![
            Measured::new("J of Table 3 over the best found", factors[0], "1"),
            Measured::new("J of Table 4 over the best found", factors[1], "1"),
            Measured::new("J of Table 3", searches.printed[0], "1"),
            Measured::new("best J of LESO", linear, "1"),
            Measured::new("its bandwidth (lower end of the box)", bandwidth, "rad/s"),
            Measured::new("its input gain (in volts at 9 mm the plant's is -3705, in metres -25.8)", input_gain, "m/(s2 V)"),
            Measured::new("J of Table 4", searches.printed[1], "1"),
            Measured::new("best J of NESO", nonlinear, "1"),
        ],
        criterion: "J of the printed parameters is within 1 % of the best found with a swarm that settles. The form of (15), \
                    its weights and the overshoots are reconstructed; position in metres, estimates from zero, sine of \
                    0.15 V at 0.5 Hz, 2 s. With NESO for alpha = 1 being LESO, the best NESO cannot be worse than the \
                    best LESO: the paper's ranking comes from giving both the same gains."
            .to_owned(),
    }
}

fn pid(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let run = simulate(packages, &Scenario::new(Reference::SineAndStep, 4.0, &[]))?;
    let negated = [
        ("controller.kp", Value::Real(-GAINS[0])),
        ("controller.ki", Value::Real(-GAINS[1])),
        ("controller.kd", Value::Real(-GAINS[2])),
    ];
    let other_sign = simulate(packages, &Scenario::new(Reference::SineAndStep, 4.0, &negated))?;
    let furthest = largest(run.position.iter().map(|position| position - SET_POINT));
    let settled = largest(
        run.time
            .iter()
            .zip(run.sensor_voltage.iter().zip(&run.reference))
            .filter(|(time, _)| **time > 3.0)
            .map(|(_, (sensor, reference))| sensor - reference),
    );
    Ok(Claim {
        id: "pid_holds_the_ball",
        statement: "The PID with Kp = 4.2, Ki = 2.2, Kd = 0.02 stabilises the rig.".to_owned(),
        source: "Section 5",
        verdict: Verdict::of(!run.contact),
        measured: vec![
            Measured::new("runs that touch a stop", f64::from(u8::from(run.contact)), "1"),
            Measured::new("largest way from 9 mm", furthest, "m"),
            Measured::new("largest control error from 3 s on", settled, "V"),
            Measured::new("with the error r - y instead of y - r: touches a stop", f64::from(u8::from(other_sign.contact)), "1"),
        ],
        criterion: "Sine of 0.15 V at 0.5 Hz and step of 0.1 V at 2 s: the ball touches no stop. The position must be in \
                    sensor volts and the error y - r, neither of which is printed; in metres these gains are 143 times \
                    too small."
            .to_owned(),
    })
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
                Ok(simulate(packages, &scenario)?.errors(Measurement::Volts, PRINTED_INPUT_GAIN, 1.0)[1])
            })
            .collect()
    };
    let (moving, noisy) = (errors(Reference::SineAndStep, 0.0)?, errors(Reference::Hold, 1e-3)?);
    let more_accurate = moving.windows(2).all(|pair| pair[1] < pair[0]);
    let noisier = noisy.windows(2).all(|pair| pair[1] > pair[0]);
    let name = |what: &str, bandwidth: &f64| format!("rms e2 at {bandwidth} rad/s, {what}");
    let rows = |what: &'static str, values: Vec<f64>| {
        BANDWIDTHS
            .iter()
            .zip(values)
            .map(move |(bandwidth, value)| Measured::new(name(what, bandwidth), value, "V/s"))
    };
    Ok(Claim {
        id: "bandwidth_trades_accuracy_for_noise",
        statement: "A larger bandwidth gives a more accurate estimate and more sensitivity to noise.".to_owned(),
        source: "Section 3.2",
        verdict: Verdict::of(more_accurate && noisier),
        measured: rows("moving, no noise", moving).chain(rows("at rest, 1 mV", noisy)).collect(),
        criterion: "LESO in sensor volts, steady start: from 50 to 400 rad/s the velocity error falls with each step for the \
                    moving ball without noise, and rises with each step for the resting ball with 1 mV of noise."
            .to_owned(),
    })
}
