//! Values of units by name.

use maglev_fmu::unit::Unit;

/// Value reference of the variable called `name`.
pub fn reference(unit: &dyn Unit, name: &str) -> usize {
    unit.description().find(name).unwrap_or_else(|| panic!("no variable {name}")).0
}

/// Value of the variable called `name`.
pub fn get(unit: &dyn Unit, name: &str) -> f64 {
    unit.values()[reference(unit, name)]
}

/// Sets the variable called `name`, after the check that the C boundary makes, too.
pub fn set(unit: &mut dyn Unit, name: &str, value: f64) {
    let (reference, variable) = unit.description().find(name).unwrap_or_else(|| panic!("no variable {name}"));
    variable.check(value).unwrap();
    unit.values_mut()[reference] = value;
}
