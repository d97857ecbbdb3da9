//! What the paper says of extended state observers at large, judged in the loop.

use super::force_step::Outcome;
use crate::study::claim::Claim;
use crate::study::metrics::indicator;

/// `outcomes` in the order of the force-step table: PID first, then disturbance rejection with the plant's b0.
pub fn all(outcomes: &[Outcome]) -> Vec<Claim> {
    vec![compensation(outcomes), printed_gain(outcomes)]
}

fn rms(outcome: &Outcome) -> f64 {
    outcome.errors[0].unwrap_or(f64::INFINITY)
}

fn compensation(outcomes: &[Outcome]) -> Claim {
    let (pid, rejection) = (&outcomes[0], &outcomes[1]);
    let ratio = rms(pid) / rms(rejection);
    let noisy = |outcome: &Outcome| outcome.errors[1].unwrap_or(f64::INFINITY);
    Claim::new(
        "extended_state_compensates_disturbances",
        "Section 3; the paper itself closes no loop through its observers",
    )
    .stating("An extended state observer lets a feedback compensate disturbances, with strong robustness.")
    .measured("rms error after a disturbance step, PID over disturbance rejection, no noise", ratio, "1")
    .measured("the same with 1 mV of noise", noisy(pid) / noisy(rejection), "1")
    .measured("PID, no noise", rms(pid), "V")
    .measured("disturbance rejection, no noise", rms(rejection), "V")
    .measured("loops that keep the ball with -20, 0, +20 % mass", rejection.kept as f64, "1")
    .judged(
        ratio > 1.0 && rejection.kept == pid.kept,
        "Disturbance step of 1 m/s² at 1 s: with LESO, wo = 300 rad/s, wc = 60 rad/s and b0 = -3705 the rms error over \
         2 s is smaller than with the PID, and as many loops with other masses keep the ball.",
    )
}

fn printed_gain(outcomes: &[Outcome]) -> Claim {
    let lost = |outcome: &Outcome| indicator(outcome.errors[0].is_none());
    let [.., linear, printed] = outcomes else { unreachable!("the list of laws has more than two") };
    Claim::new("printed_observer_serves_control", "Table 3 and section 3")
        .stating("The optimal parameters of LESO (b = 1, wo = 100) are those of a good observer for control.")
        .measured("ball lost with Table 3, wc = 60", lost(printed), "1")
        .measured("ball lost with wo = 100 and b0 = -3705, wc = 40", lost(linear), "1")
        .judged(
            printed.errors[0].is_some(),
            "The loop through the printed observer keeps the ball. b = 1 has the wrong sign and is 3705 \
             times too small; with the right one wo = 100 rad/s is too slow for a plant whose unstable pole \
             is at 47 rad/s.",
        )
}
