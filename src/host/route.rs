//! Moving values from one instance to another, without allocation.

use super::error::Result;
use super::instance::Instance;
use super::value::Handle;

/// Connected variables of two instances, all in one direction.
#[derive(Debug, Default)]
pub(super) struct Route {
    sources: Vec<u32>,
    targets: Vec<u32>,
    values: Vec<f64>,
    /// What is added on the way, with the place of the value.
    offsets: Vec<(usize, f64)>,
    /// What the batch functions do not take: integers, booleans, enumerations, `Float32`.
    singles: Vec<Single>,
}

#[derive(Debug)]
struct Single {
    source: Handle,
    target: Handle,
    value: f64,
}

impl Route {
    /// Resolves `(output of the source, input of the target)` names.
    ///
    /// # Errors
    /// Those of [`Instance::variable`].
    pub(super) fn resolve(
        source: &Instance,
        target: &Instance,
        connections: &[(&str, &str)],
    ) -> Result<Self> {
        let mut route = Self::default();
        for (output, input) in connections {
            let (from, to) = (source.variable(output)?, target.variable(input)?);
            if from.is_float64() && to.is_float64() {
                route.sources.push(from.value_reference());
                route.targets.push(to.value_reference());
            } else {
                route.singles.push(Single { source: from, target: to, value: 0.0 });
            }
        }
        route.values.resize(route.sources.len(), 0.0);
        Ok(route)
    }

    /// Adds `offset` to what the `Float64` input of this value reference gets; false if no wire leads there.
    pub(super) fn add_offset(&mut self, target: u32, offset: f64) -> bool {
        let place = self.targets.iter().position(|candidate| *candidate == target);
        self.offsets.extend(place.map(|place| (place, offset)));
        place.is_some()
    }

    /// Reads the outputs of `source`.
    #[inline]
    pub(super) fn read(&mut self, source: &Instance) -> Result<()> {
        if !self.sources.is_empty() {
            source.get_reals(&self.sources, &mut self.values)?;
            for &(place, offset) in &self.offsets {
                self.values[place] += offset;
            }
        }
        for single in &mut self.singles {
            single.value = source.get(single.source)?;
        }
        Ok(())
    }

    /// Writes what was read to the inputs of `target`.
    #[inline]
    pub(super) fn write(&self, target: &mut Instance) -> Result<()> {
        if !self.targets.is_empty() {
            target.set_reals(&self.targets, &self.values)?;
        }
        for single in &self.singles {
            target.set(single.target, single.value)?;
        }
        Ok(())
    }
}
