//! `terminalsAndIcons.xml` of FMI 3.0 (text of 3.0.2, section 2.4.9): where the icon lies in a diagram.

use serde::Serialize;

use super::document;
use crate::package::{FmiVersion, PackageError};
use crate::unit::Description;

#[derive(Serialize)]
struct TerminalsAndIcons {
    #[serde(rename = "@fmiVersion")]
    fmi_version: &'static str,
    #[serde(rename = "GraphicalRepresentation")]
    graphical_representation: GraphicalRepresentation,
}

#[derive(Serialize)]
struct GraphicalRepresentation {
    #[serde(rename = "CoordinateSystem")]
    coordinate_system: CoordinateSystem,
    #[serde(rename = "Icon")]
    icon: Icon,
}

/// Corners of the diagram and the size of a unit of length in it.
#[derive(Serialize)]
struct CoordinateSystem {
    #[serde(rename = "@x1")]
    x1: i32,
    #[serde(rename = "@y1")]
    y1: i32,
    #[serde(rename = "@x2")]
    x2: i32,
    #[serde(rename = "@y2")]
    y2: i32,
    #[serde(rename = "@suggestedScalingFactorTo_mm")]
    suggested_scaling_factor: f32,
}

/// Corners of the icon.
#[derive(Serialize)]
struct Icon {
    #[serde(rename = "@x1")]
    x1: i32,
    #[serde(rename = "@y1")]
    y1: i32,
    #[serde(rename = "@x2")]
    x2: i32,
    #[serde(rename = "@y2")]
    y2: i32,
}

/// Places the icon on the whole of the standard's default square of 20 mm.
pub fn terminals_and_icons(description: &'static Description) -> Result<String, PackageError> {
    let content = TerminalsAndIcons {
        fmi_version: FmiVersion::Three.text(),
        graphical_representation: GraphicalRepresentation {
            coordinate_system: CoordinateSystem {
                x1: -100,
                y1: -100,
                x2: 100,
                y2: 100,
                suggested_scaling_factor: 0.1,
            },
            icon: Icon { x1: -100, y1: -100, x2: 100, y2: 100 },
        },
    };
    document("fmiTerminalsAndIcons", &content).map_err(|source| PackageError::ModelDescription {
        unit: description.name,
        version: FmiVersion::Three,
        source,
    })
}
