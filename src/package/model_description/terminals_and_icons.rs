//! `terminalsAndIcons.xml` of FMI 3.0 (text of 3.0.2, section 2.4.9): where the icon lies in a diagram, and the plug
//! that fits the other unit of the loop. FMI 2.0 (text of 2.0.5, section 2.3) takes the same file.

use serde::Serialize;

use super::document;
use crate::package::plug::{Member, Plug};
use crate::package::{FmiVersion, PackageError};
use crate::unit::Description;

#[derive(Serialize)]
struct TerminalsAndIcons {
    #[serde(rename = "@fmiVersion")]
    fmi_version: &'static str,
    #[serde(rename = "GraphicalRepresentation")]
    graphical_representation: GraphicalRepresentation,
    #[serde(rename = "Terminals", skip_serializing_if = "Option::is_none")]
    terminals: Option<Terminals>,
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

#[derive(Serialize)]
struct Terminals {
    #[serde(rename = "Terminal")]
    terminals: Vec<Terminal>,
}

#[derive(Serialize)]
struct Terminal {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@matchingRule")]
    matching_rule: &'static str,
    #[serde(rename = "@terminalKind")]
    kind: String,
    #[serde(rename = "@description")]
    description: String,
    #[serde(rename = "TerminalMemberVariable")]
    members: Vec<TerminalMemberVariable>,
}

#[derive(Serialize)]
struct TerminalMemberVariable {
    #[serde(rename = "@variableName")]
    variable_name: &'static str,
    #[serde(rename = "@memberName")]
    member_name: &'static str,
    #[serde(rename = "@variableKind")]
    kind: &'static str,
}

impl Terminals {
    /// A plug for each loop the unit is part of; `None` if there is none, since the element must not be empty.
    fn new(description: &'static Description) -> Option<Self> {
        let terminals: Vec<_> =
            Plug::all_of(description).iter().map(|plug| Terminal::new(description, plug)).collect();
        (!terminals.is_empty()).then_some(Self { terminals })
    }
}

impl Terminal {
    fn new(description: &'static Description, plug: &Plug) -> Self {
        let ends = [plug.system.plant, plug.system.controller].map(|unit| unit.description.name);
        let other = if ends[0] == description.name { ends[1] } else { ends[0] };
        Self {
            name: plug.system.name,
            matching_rule: "plug",
            kind: plug.kind(),
            description: format!("Everything that is exchanged with {other}"),
            members: plug.members.iter().map(TerminalMemberVariable::new).collect(),
        }
    }
}

impl TerminalMemberVariable {
    fn new(member: &Member) -> Self {
        Self { variable_name: member.variable, member_name: member.name, kind: "signal" }
    }
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
        terminals: Terminals::new(description),
    };
    document("fmiTerminalsAndIcons", &content).map_err(|source| PackageError::ModelDescription {
        unit: description.name,
        version: FmiVersion::Three,
        source,
    })
}
