//! `terminalsAndIcons.xml` of FMI 3.0 (text of 3.0.2, section 2.4.9): where the icon lies in a diagram, and the terminal
//! that fits the other model of the loop. FMI 2.0 (text of 2.0.5, section 2.3) takes the same file.

use std::io;

use crate::model::Description;
use crate::package::FmiVersion;
use crate::package::terminal::Terminal;
use crate::package::xml::{Writer, attribute, document, element, empty_element};

/// The document `fmiTerminalsAndIcons`.
pub fn terminals_and_icons(description: &Description) -> String {
    let version = attribute("fmiVersion", FmiVersion::Three.text());
    document("fmiTerminalsAndIcons", [version], |writer| {
        graphical_representation(writer)?;
        let terminals = Terminal::all_of(description);
        // The list must not be empty.
        if terminals.is_empty() {
            return Ok(());
        }
        element(writer, "Terminals", [], |writer| {
            terminals.iter().try_for_each(|terminal| write_terminal(writer, description, terminal))
        })
    })
}

/// `GraphicalRepresentation` (section 2.4.9.1): the icon fills the standard's default square of 20 mm.
fn graphical_representation(writer: &mut Writer) -> io::Result<()> {
    let corners =
        || [attribute("x1", -100), attribute("y1", -100), attribute("x2", 100), attribute("y2", 100)];
    let scale = attribute("suggestedScalingFactorTo_mm", 0.1);
    element(writer, "GraphicalRepresentation", [], |writer| {
        empty_element(writer, "CoordinateSystem", corners().into_iter().chain([scale]))?;
        empty_element(writer, "Icon", corners())
    })
}

/// `Terminal` (section 2.4.9.2): a terminal of the model.
fn write_terminal(writer: &mut Writer, description: &Description, terminal: &Terminal) -> io::Result<()> {
    let ends = [terminal.system.plant, terminal.system.controller].map(|model| model.description.name);
    let other = if ends[0] == description.name { ends[1] } else { ends[0] };
    let attributes = [
        attribute("name", terminal.system.name),
        attribute("matchingRule", "plug"),
        attribute("terminalKind", terminal.kind()),
        attribute("description", format!("Everything that is exchanged with {other}")),
    ];
    element(writer, "Terminal", attributes, |writer| {
        terminal.members.iter().try_for_each(|member| {
            let attributes = [
                attribute("variableName", member.variable),
                attribute("memberName", member.name),
                attribute("variableKind", "signal"),
            ];
            empty_element(writer, "TerminalMemberVariable", attributes)
        })
    })
}
