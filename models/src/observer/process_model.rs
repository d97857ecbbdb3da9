//! A plant as an estimator sees it, apart from the estimator.

/// A plant of `N` states from sample to sample, of which the first is measured. An estimator predicts by it, corrects the
/// prediction with the measurement, and is reset where neither makes sense any more.
pub trait ProcessModel<const N: usize> {
    /// The state after a sample under a held `input`.
    fn predict(&self, state: &[f64; N], input: f64) -> [f64; N];

    /// The same, and its derivative by the state, row by row.
    fn linearised(&self, state: &[f64; N], input: f64) -> ([f64; N], [[f64; N]; N]);
}
