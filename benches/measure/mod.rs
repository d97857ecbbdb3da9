//! Medians and ratios of runs that take turns, so that a busy machine slows all of them alike.

use std::time::Instant;

/// A piece of work and how many operations one run of it makes.
pub struct Candidate<'a> {
    pub name: &'a str,
    pub operations: usize,
    pub run: Box<dyn FnMut() + 'a>,
}

/// Median time per operation \[ns\] of each candidate over interleaved rounds.
pub fn medians(candidates: &mut [Candidate<'_>], rounds: usize) -> Vec<f64> {
    let mut samples = vec![Vec::with_capacity(rounds); candidates.len()];
    for round in 0..=rounds {
        for (candidate, samples) in candidates.iter_mut().zip(&mut samples) {
            let start = Instant::now();
            (candidate.run)();
            let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / candidate.operations as f64;
            // The first round warms up.
            if round > 0 {
                samples.push(nanoseconds);
            }
        }
    }
    samples
        .into_iter()
        .map(|mut samples| {
            samples.sort_by(f64::total_cmp);
            samples[samples.len() / 2]
        })
        .collect()
}

/// Prints one line: a measured figure, its target and whether it is met.
pub fn verdict(what: &str, measured: f64, unit: &str, at_most: Option<f64>, at_least: Option<f64>) {
    let (relation, target, met) = match (at_most, at_least) {
        (Some(limit), _) => ("<=", limit, measured <= limit),
        (_, Some(limit)) => (">=", limit, measured >= limit),
        _ => return println!("{what:<64} {measured:>9.1} {unit}"),
    };
    let word = if met { "met" } else { "MISSED" };
    println!("{what:<64} {measured:>9.1} {unit:<3} target {relation} {target} {word}");
}
