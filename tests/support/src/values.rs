//! Values of models by name.

use maglev_fmu::model::Model;

/// Value reference of the variable called `name`.
pub fn reference(model: &dyn Model, name: &str) -> usize {
    model.description().find(name).unwrap_or_else(|| panic!("no variable {name}")).0
}

/// Value of the variable called `name`.
pub fn get(model: &dyn Model, name: &str) -> f64 {
    model.values()[reference(model, name)]
}

/// Sets the variable called `name`, after the check that the C boundary makes, too.
pub fn set(model: &mut dyn Model, name: &str, value: f64) {
    let (reference, variable) =
        model.description().find(name).unwrap_or_else(|| panic!("no variable {name}"));
    variable.check(value).unwrap();
    model.values_mut()[reference] = value;
}
