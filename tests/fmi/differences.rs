//! Differences of values, which derivatives in closed form are compared with.

use maglev_fmu::model::variable::{Causality, Kind, Variability};

use super::harness::Component;

/// Derivative of `f` at 0 by central differences with Richardson extrapolation over three step sizes.
pub fn slope(size: f64, f: impl Fn(f64) -> f64) -> f64 {
    let difference = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let [coarse, middle, fine] = [1e-2, 5e-3, 2.5e-3].map(|share| difference(share * size));
    let [first, second] = [(4.0 * middle - coarse) / 3.0, (4.0 * fine - middle) / 3.0];
    (16.0 * second - first) / 15.0
}

/// Value references of real variables that `keep` keeps.
pub fn reals(component: &Component, keep: impl Fn(u32) -> bool) -> Vec<u32> {
    (0..component.description.variables.len() as u32)
        .filter(|row| matches!(component.variable(*row).kind, Kind::Real(_)) && keep(*row))
        .collect()
}

pub fn is_derivative(component: &Component, row: u32) -> bool {
    component.variable(row).derivative_of.is_some()
}

/// Continuous outputs and state derivatives.
pub fn unknowns(component: &Component) -> Vec<u32> {
    reals(component, |row| {
        let variable = component.variable(row);
        let is_output =
            variable.causality == Causality::Output && variable.variability == Variability::Continuous;
        is_output || is_derivative(component, row)
    })
}

pub fn inputs(component: &Component) -> Vec<u32> {
    reals(component, |row| component.variable(row).causality == Causality::Input)
}

/// A quantity's usual size.
pub fn nominal(component: &Component, row: u32) -> f64 {
    let Kind::Real(quantity) = component.variable(row).kind else { unreachable!() };
    quantity.nominal
}

pub fn assert_close(exact: f64, difference: f64, scale: f64, context: &str) {
    let error = (exact - difference).abs();
    assert!(error <= 1e-8 * exact.abs().max(scale), "{context}: {exact} against {difference}");
}

/// Unit in which a derivative of `unknown` with respect to `known` is measured.
pub fn scale(component: &Component, unknown: u32, known: u32) -> f64 {
    let value = component.get_reference(unknown).1.abs();
    nominal(component, unknown).max(value) / nominal(component, known)
}
