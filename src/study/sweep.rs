//! Many cases in parallel, with progress.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::{Progress, StudyError};

/// Runs all cases and returns what came of them in their order; says how far it is as `action`.
pub fn sweep<C: Sync, R: Send>(
    cases: &[C],
    progress: Progress<'_>,
    action: &str,
    run: impl Fn(&C) -> Result<R, StudyError> + Sync,
) -> Result<Vec<R>, StudyError> {
    let done = AtomicUsize::new(0);
    cases
        .par_iter()
        .map(|case| {
            let outcome = run(case)?;
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(count as f64 / cases.len() as f64, action);
            Ok(outcome)
        })
        .collect()
}

/// Progress of a part of the work, which goes `from` one share `to` another.
pub fn part(progress: Progress<'_>, from: f64, to: f64) -> impl Fn(f64, &str) + Sync {
    move |share, action| progress(from + (to - from) * share, action)
}

/// All indices of an array of these lengths, the last one running fastest.
pub fn indices<const N: usize>(lengths: [usize; N]) -> Vec<[usize; N]> {
    (0..lengths.iter().product())
        .map(|mut place| {
            let mut index = [0; N];
            for (digit, length) in index.iter_mut().zip(lengths).rev() {
                *digit = place % length;
                place /= length;
            }
            index
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_index_runs_fastest() {
        assert_eq!(indices([2, 2]), [[0, 0], [0, 1], [1, 0], [1, 1]]);
        assert_eq!(indices([2, 0, 3]), [[0; 3]; 0]);
    }
}
