//! What the paper says of extended state observers at large, judged in the loop.

use super::force_step::Outcome;
use crate::study::claim::{Claim, Measurement, Verdict};

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
    Claim {
        id: "extended_state_compensates_disturbances",
        statement: "An extended state observer lets a feedback compensate disturbances, with strong robustness."
            .to_owned(),
        source: "Section 3; the paper itself closes no loop through its observers",
        verdict: Verdict::of(ratio > 1.0 && rejection.kept == pid.kept),
        measured: vec![
            Measurement::new("rms error after a push, PID over disturbance rejection, no noise", ratio, "1"),
            Measurement::new("the same with 1 mV of noise", noisy(pid) / noisy(rejection), "1"),
            Measurement::new("PID, no noise", rms(pid), "V"),
            Measurement::new("disturbance rejection, no noise", rms(rejection), "V"),
            Measurement::new("loops that keep the ball with -20, 0, +20 % mass", rejection.kept as f64, "1"),
        ],
        criterion: "Push of 1 m/s² at 1 s: with LESO, wo = 300 rad/s, wc = 60 rad/s and b0 = -3705 the rms error over 2 s \
                    is smaller than with the PID, and as many loops with other masses keep the ball."
            .to_owned(),
    }
}

fn printed_gain(outcomes: &[Outcome]) -> Claim {
    let lost = |outcome: &Outcome| f64::from(u8::from(outcome.errors[0].is_none()));
    let [.., linear, printed] = outcomes else { unreachable!("the list of laws has more than two") };
    Claim {
        id: "printed_observer_serves_control",
        statement: "The optimal parameters of LESO (b = 1, wo = 100) are those of a good observer for control.".to_owned(),
        source: "Table 3 and section 3",
        verdict: Verdict::of(printed.errors[0].is_some()),
        measured: vec![
            Measurement::new("ball lost with Table 3, wc = 60", lost(printed), "1"),
            Measurement::new("ball lost with wo = 100 and b0 = -3705, wc = 40", lost(linear), "1"),
        ],
        criterion: "The loop through the printed observer keeps the ball. b = 1 has the wrong sign and is 3705 times too \
                    small; with the right one wo = 100 rad/s is too slow for a plant whose unstable pole is at 47 rad/s."
            .to_owned(),
    }
}
