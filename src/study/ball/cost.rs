//! What a tick of the observers costs.

use std::hint::black_box;
use std::time::Instant;

use super::scenario::{DREM, NEWTON};
use crate::host::Value;
use crate::study::StudyError;
use crate::study::claim::Claim;
use crate::study::loop_packages::LoopPackages;

/// Shortest sample time that is used \[s\].
const SAMPLE_TIME: f64 = 1e-4;
const TICKS: u32 = 20_000;
/// The fastest of some repetitions is what the machine can do.
const REPETITIONS: u32 = 7;

/// Time of a tick in the packaged model \[s\].
fn tick(packages: &LoopPackages, observer: &str) -> Result<f64, StudyError> {
    // Something to work on: the current that carries the ball, and a ripple.
    let currents: Vec<f64> = (0..1000).map(|k| 0.8 + 0.1 * (f64::from(k) * 0.02).sin()).collect();
    let mut fastest = f64::INFINITY;
    for _ in 0..REPETITIONS {
        let mut controller = packages.controller(&[
            ("observer.kind", Value::Text(observer)),
            ("observer.startup_hold", Value::Real(0.0)),
            ("current", Value::Real(0.8)),
            ("sample_time", Value::Real(SAMPLE_TIME)),
        ])?;
        controller.initialise(0.0, None)?;
        let current = controller.variable("current")?;
        let start = Instant::now();
        for k in 0..TICKS {
            controller.set(current, currents[k as usize % currents.len()])?;
            controller.step(f64::from(k) * SAMPLE_TIME, SAMPLE_TIME)?;
        }
        fastest = fastest.min(start.elapsed().as_secs_f64() / f64::from(TICKS));
        black_box(controller.get_by_name("voltage")?);
    }
    Ok(fastest)
}

pub fn claim(packages: &LoopPackages) -> Result<Claim, StudyError> {
    let (drem, newton) = (tick(packages, DREM)?, tick(packages, NEWTON)?);
    Ok(Claim::new("computational_complexity_is_high", "Section 6, conclusions")
        .stating("The computational complexity is relatively high for this kind of application.")
        .measured("time of a tick of drem, law included, on this machine", 1e6 * drem, "µs")
        .measured("time of a tick of polynomial_newton", 1e6 * newton, "µs")
        .measured("sample time", 1e6 * SAMPLE_TIME, "µs")
        .measured("first-order filters of drem", 32.0, "1")
        .judged(
            drem > 0.1 * SAMPLE_TIME,
            "More than a tenth of the sample time, on the machine that wrote this; scale it to yours. A \
             tick is 12 prefilters, 20 filters, two 4 x 4 determinants and an exponential or two.",
        ))
}
