//! What a run recorded.

use super::error::Result;
use super::instance::Instance;

/// Sampled variables over time, one column per variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// `model.variable`, for example `plant.position`.
    pub names: Vec<String>,
    /// The unit of each column as the model description has it.
    pub units: Vec<Option<String>>,
    /// Communication points in seconds.
    pub time: Vec<f64>,
    /// One per name, each as long as `time`.
    pub columns: Vec<Vec<f64>>,
}

impl Trace {
    /// The column called `model.variable`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let place = self.names.iter().position(|candidate| candidate == name)?;
        self.columns.get(place).map(Vec::as_slice)
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Makes room for `rows` more rows, so that sampling them does not allocate.
    pub fn reserve(&mut self, rows: usize) {
        self.time.reserve(rows);
        for column in &mut self.columns {
            column.reserve(rows);
        }
    }
}

/// The recorded variables of one instance.
#[derive(Debug, Default)]
pub(super) struct Probe {
    references: Vec<u32>,
    /// The trace's column of each reference.
    places: Vec<usize>,
    values: Vec<f64>,
    /// What the batch functions do not take, with the column of each.
    singles: Vec<(super::value::Handle, usize)>,
}

impl Probe {
    /// Adds the variable called `variable`, to be written to the trace's column number `place`.
    ///
    /// # Errors
    /// Those of [`Instance::variable`].
    pub(super) fn add(&mut self, instance: &Instance, variable: &str, place: usize) -> Result<()> {
        let handle = instance.variable(variable)?;
        if handle.is_float64() {
            self.references.push(handle.value_reference());
            self.places.push(place);
            self.values.push(0.0);
        } else {
            self.singles.push((handle, place));
        }
        Ok(())
    }

    /// Appends one value to each of its columns.
    #[inline]
    pub(super) fn sample(&mut self, instance: &Instance, columns: &mut [Vec<f64>]) -> Result<()> {
        if !self.references.is_empty() {
            instance.get_reals(&self.references, &mut self.values)?;
            for (&place, &value) in self.places.iter().zip(&self.values) {
                columns[place].push(value);
            }
        }
        for &(handle, place) in &self.singles {
            columns[place].push(instance.get(handle)?);
        }
        Ok(())
    }
}
