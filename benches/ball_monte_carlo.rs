//! A part of the ball's Monte-Carlo on one core and on all: what the other cores are worth.

mod measure;

use std::error::Error;

use maglev_fmu::package::{GenerationTime, Library, build};
use maglev_fmu::study::ball_monte_carlo::{Extent, run_extent};
use measure::{Candidate, medians, verdict};
use rayon::ThreadPoolBuilder;

/// Some seconds of computing.
const EXTENT: Extent = Extent { runs: 10, stride: 60 };
const ROUNDS: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    build(directory.path(), &[Library::of_this_build()?], GenerationTime::from_epoch_seconds(0))?;
    let cores = std::thread::available_parallelism()?.get();
    let mut candidates = Vec::new();
    for (name, threads) in [("one thread", 1), ("a thread per core", cores)] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        let run = {
            let packages = directory.path();
            move || {
                let findings = pool.install(|| run_extent(packages, EXTENT, &|_, _| ())).expect("a run");
                assert!(!findings.claims.is_empty());
            }
        };
        candidates.push(Candidate { name, operations: 1, run: Box::new(run) });
    }
    let medians = medians(&mut candidates, ROUNDS);
    println!("A part of the ball's Monte-Carlo, medians");
    for (candidate, median) in candidates.iter().zip(&medians) {
        verdict(candidate.name, median * 1e-9, "s", None, None);
    }
    let speed_up = medians[0] / medians[1];
    verdict("speed-up", speed_up, "x", None, None);
    verdict("efficiency in percent", 100.0 * speed_up / cores as f64, "%", None, Some(90.0));
    Ok(())
}
