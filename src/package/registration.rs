//! What tools know of the library's models beside what the library does: icons, documentation, and what variables follow from.

use maglev_models::for_all_models;

use crate::model::structure::Dependencies;
use crate::model::{self, Description, Registration};

/// The icon of each model is the drawing in `assets` with its name, its documentation stands beside its table.
macro_rules! registrations {
    ($($name:ident: $model:ident = $module:ident;)*) => {
        static REGISTRATIONS: &[Registration] = &[$(Registration::of::<model::$model>(
            &model::$name,
            include_str!(concat!("../../assets/", stringify!($model), ".svg")),
            include_str!(concat!("../../models/src/model/", stringify!($module), "/documentation.txt")),
        )),*];
    };
}

for_all_models!(registrations);

/// Registration of the model described, if it is one.
pub(super) fn registration(description: &Description) -> Option<&'static Registration> {
    let mut all = REGISTRATIONS.iter().chain(model::added_models());
    all.find(|registration| core::ptr::eq(registration.model.description, description))
}

/// Dependencies per row of the table, found anew at each call; none if this is the description of no model.
pub fn dependencies(description: &Description) -> Vec<Dependencies> {
    let unknown = || vec![Dependencies::default(); description.variables.len()];
    registration(description).map_or_else(unknown, |model| (model.dependencies)())
}

/// Paragraphs of the model's documentation, each in one line.
pub(super) fn paragraphs(description: &Description) -> Vec<String> {
    // Git may have put the line ends of Windows into the file.
    let text = registration(description).map_or("", |model| model.documentation).replace("\r\n", "\n");
    let in_one_line = |paragraph: &str| paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    text.split("\n\n").map(in_one_line).collect()
}
