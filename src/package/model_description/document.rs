//! The document and its root element `fmiModelDescription` (texts of FMI 2.0.5, section 2.2.1, and 3.0.2, section 2.4.1).

use super::{fmi2, fmi3};
use crate::model::{Description, StartValues};
use crate::package::xml::{attribute, document, optional, origin};
use crate::package::{FmiVersion, Form, GenerationTime};

/// `modelDescription.xml` of a model in one form. `time` is left out of the file that is checked in.
pub fn model_description(
    description: &Description,
    start_values: &StartValues,
    form: Form,
    time: Option<GenerationTime>,
) -> String {
    let Form { version, edition } = form;
    let (token, event_indicators) = match version {
        FmiVersion::Two => {
            let count = || description.event_indicators().count();
            ("guid", description.offers_model_exchange().then(count))
        }
        FmiVersion::Three => ("instantiationToken", None),
    };
    let attributes = [
        attribute("fmiVersion", version.text()),
        attribute("modelName", description.name),
        attribute(token, start_values.token(description, edition)),
        attribute("description", description.summary),
        attribute("version", env!("CARGO_PKG_VERSION")),
    ];
    let attributes = attributes
        .into_iter()
        .chain(origin(time))
        .chain([attribute("variableNamingConvention", "structured")])
        .chain(optional("numberOfEventIndicators", event_indicators));
    document("fmiModelDescription", attributes, |writer| match version {
        FmiVersion::Two => fmi2::content(writer, description, start_values),
        FmiVersion::Three => fmi3::content(writer, description, edition, start_values),
    })
}
