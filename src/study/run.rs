//! What was recorded of a run, as columns with names.

use std::ops::Index;

use super::metrics::{difference, settling_time};
use crate::host::Trace;

/// One row per sample. Columns are found by name, as `run["plant.position"]`, which panics if there is none.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// \[s\]
    pub time: Vec<f64>,
    /// Time \[s\] at which `plant.contact` first told of a stop.
    pub lost_at: Option<f64>,
    columns: Vec<(String, Vec<f64>)>,
}

impl Run {
    pub fn new(time: Vec<f64>) -> Self {
        Self { time, ..Self::default() }
    }

    pub fn with(mut self, name: &str, column: Vec<f64>) -> Self {
        self.columns.push((name.to_owned(), column));
        self
    }

    /// Every `stride`th row.
    pub fn every(&self, stride: usize) -> Self {
        let thin = |column: &[f64]| column.iter().step_by(stride).copied().collect();
        let columns = self.columns.iter().map(|(name, column)| (name.clone(), thin(column)));
        Self { time: thin(&self.time), lost_at: self.lost_at, columns: columns.collect() }
    }

    /// First row at `time` \[s\] or later.
    pub fn row_at(&self, time: f64) -> usize {
        // Times are multiples of the sample time up to rounding.
        self.time.partition_point(|candidate| *candidate < time - 1e-9)
    }

    /// The part of a column, recorded or computed, from `start` \[s\] on.
    pub fn since<'a>(&self, start: f64, column: &'a [f64]) -> &'a [f64] {
        &column[self.row_at(start).min(column.len())..]
    }

    /// The part of a column within the last `duration` \[s\].
    pub fn last<'a>(&self, duration: f64, column: &'a [f64]) -> &'a [f64] {
        self.since(self.time.last().map_or(0.0, |end| end - duration), column)
    }

    /// True values of a state of the plant.
    pub fn state(&self, name: &str) -> &[f64] {
        &self[&format!("plant.{name}")]
    }

    /// What the controller's observer makes of it.
    pub fn estimate(&self, name: &str) -> &[f64] {
        &self[&format!("controller.estimate.{name}")]
    }

    /// Estimate of a state minus the truth.
    pub fn error(&self, name: &str) -> Vec<f64> {
        difference(self.estimate(name), self.state(name))
    }

    /// Time \[s\] from which on a column, recorded or computed, stays within `limit`; infinite if it does not, or if the
    /// plant is lost.
    pub fn settled(&self, column: &[f64], limit: f64) -> f64 {
        if self.lost_at.is_some() { f64::INFINITY } else { settling_time(&self.time, column, limit) }
    }

    /// A column, times `factor`, over time.
    pub fn points(&self, name: &str, factor: f64) -> Vec<(f64, f64)> {
        self.over_time(&self[name], factor)
    }

    /// Values, times `factor`, over time.
    pub fn over_time(&self, values: &[f64], factor: f64) -> Vec<(f64, f64)> {
        self.time.iter().zip(values).map(|(time, value)| (*time, factor * value)).collect()
    }

    /// Magnitudes of values, times `factor`, over time, for a logarithmic axis: none is below `floor`.
    pub fn magnitudes(&self, values: &[f64], factor: f64, floor: f64) -> Vec<(f64, f64)> {
        let magnitude = |value: &f64| (factor * value.abs()).max(floor);
        self.time.iter().zip(values).map(|(time, value)| (*time, magnitude(value))).collect()
    }
}

impl Index<&str> for Run {
    type Output = [f64];

    fn index(&self, name: &str) -> &[f64] {
        let column = self.columns.iter().find(|(candidate, _)| candidate == name);
        &column.unwrap_or_else(|| panic!("{name} was not recorded")).1
    }
}

impl From<Trace> for Run {
    fn from(trace: Trace) -> Self {
        let contacts = trace.column("plant.contact").unwrap_or_default();
        let lost_at = contacts.iter().position(|contact| *contact != 0.0).map(|row| trace.time[row]);
        Self { time: trace.time, lost_at, columns: trace.names.into_iter().zip(trace.columns).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_found_by_time() {
        let run = Run::new(vec![0.0, 1.0, 2.0, 3.0]).with("a", vec![1.0, 2.0, 3.0, 4.0]);
        assert_eq!(run.last(1.0, &run["a"]), [3.0, 4.0]);
        assert_eq!(run.since(2.0, &run["a"]), [3.0, 4.0]);
        assert_eq!(run.every(2)["a"], [1.0, 3.0]);
        assert_eq!(run.settled(&run["a"], 5.0), 0.0);
        let lost = Run { lost_at: Some(1.0), ..run.clone() };
        assert_eq!(lost.settled(&run["a"], 5.0), f64::INFINITY);
        assert_eq!(run.points("a", 2.0).last(), Some(&(3.0, 8.0)));
    }
}
