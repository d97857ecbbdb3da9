//! Block diagram of a loop as SVG, drawn from the table of systems.

use quick_xml::escape::escape;

use crate::model::Description;
use crate::model::system::System;
use crate::model::variable::{Causality, Kind, Variable};

/// Lengths in the picture \[pixel\].
const BOX_WIDTH: i32 = 300;
const HEAD: i32 = 44;
const PIN: i32 = 24;
/// Between the two boxes, and from wire to wire on the way back.
const GAP: i32 = 90;
const WIRE: i32 = 12;
const MARGIN: i32 = 16;
/// Room for the arrows of free inputs above a box.
const ABOVE: i32 = 54;

const STYLE: &str = "text{font:13px sans-serif;fill:#1d2733}.name{font-weight:bold;fill:#1f4e79}\
    .wire{fill:none;stroke:#3c5063;stroke-width:1.5;stroke-linejoin:round}.free{stroke:#c0392b}";

/// Where the parts of the picture are.
struct Layout {
    controller_x: i32,
    plant_x: i32,
    top: i32,
    bottom: i32,
    width: i32,
    height: i32,
}

impl Layout {
    fn new(system: &System) -> Self {
        let pins = system.sensing.len().max(system.actuation.len()) as i32;
        let back = MARGIN + WIRE * (system.sensing.len() as i32 + 1);
        let plant_x = back + BOX_WIDTH + GAP;
        let bottom = ABOVE + HEAD + PIN * pins + MARGIN / 2;
        Self {
            controller_x: back,
            plant_x,
            top: ABOVE,
            bottom,
            width: plant_x + BOX_WIDTH + back,
            height: bottom + back,
        }
    }

    /// Height of a pin's middle.
    fn pin(&self, index: usize) -> i32 {
        self.top + HEAD + PIN * index as i32 + PIN / 2
    }
}

/// File name of the block diagram of a loop, beside the documentation's first page.
pub fn diagram_name(system: &str) -> String {
    format!("{system}.svg")
}

/// The diagram; the box of the model `shown`, if any, is filled.
pub fn loop_diagram(system: &System, shown: Option<&Description>) -> String {
    let layout = Layout::new(system);
    let Layout { width, height, .. } = layout;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">\n<style>{STYLE}</style>\n<defs><marker id=\"arrow\" viewBox=\"0 0 8 8\" \
         refX=\"8\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\"><path d=\"M0 0l8 4l-8 4z\" \
         fill=\"#3c5063\"/></marker></defs>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for (model, x) in [(system.controller, layout.controller_x), (system.plant, layout.plant_x)] {
        let is_shown = shown.is_some_and(|shown| std::ptr::eq(shown, model.description));
        text += &block(&layout, model.description.name, x, is_shown);
    }
    let right = layout.controller_x + BOX_WIDTH;
    for (index, (output, input)) in system.actuation.iter().enumerate() {
        let y = layout.pin(index);
        text += &wire(&format!("M{right} {y}H{}", layout.plant_x), "wire");
        text += &label(right - 8, y, "end", output);
        text += &label(layout.plant_x + 8, y, "start", input);
    }
    // The uppermost pins have the outermost wires, so none cross.
    let right = layout.plant_x + BOX_WIDTH;
    for (index, (output, input)) in system.sensing.iter().enumerate() {
        let y = layout.pin(index);
        let out = WIRE * (system.sensing.len() - index) as i32;
        let path = format!(
            "M{right} {y}H{}V{}H{}V{y}H{}",
            right + out,
            layout.bottom + out,
            layout.controller_x - out,
            layout.controller_x
        );
        text += &wire(&path, "wire");
        text += &label(right - 8, y, "end", output);
        text += &label(layout.controller_x + 8, y, "start", input);
    }
    text += &free_inputs(&layout, system.controller.description, layout.controller_x, system.sensing);
    text += &free_inputs(&layout, system.plant.description, layout.plant_x, system.actuation);
    text + "</svg>\n"
}

fn block(layout: &Layout, name: &str, x: i32, is_shown: bool) -> String {
    let fill = if is_shown { "#dbe9f6" } else { "#f5f7f9" };
    let (top, height) = (layout.top, layout.bottom - layout.top);
    let middle = x + BOX_WIDTH / 2;
    format!(
        "<rect x=\"{x}\" y=\"{top}\" width=\"{BOX_WIDTH}\" height=\"{height}\" rx=\"8\" fill=\"{fill}\" \
         stroke=\"#1f4e79\" stroke-width=\"2\"/>\n<text class=\"name\" x=\"{middle}\" y=\"{}\" \
         text-anchor=\"middle\">{}</text>\n",
        top + 26,
        escape(name)
    )
}

/// Inputs that no wire of the loop ends at, as arrows from above.
fn free_inputs(
    layout: &Layout,
    description: &Description,
    x: i32,
    wires: &[(&'static str, &'static str)],
) -> String {
    let is_free = |variable: &&Variable| {
        variable.causality == Causality::Input
            && matches!(variable.kind, Kind::Real(_))
            && !wires.iter().any(|(_, input)| *input == variable.name)
    };
    let free: Vec<&str> =
        description.variables.iter().filter(is_free).map(|variable| variable.name).collect();
    let mut text = String::new();
    for (index, name) in free.iter().enumerate() {
        let x = x + BOX_WIDTH * (2 * index as i32 + 1) / (2 * free.len() as i32);
        text += &wire(&format!("M{x} {}V{}", layout.top - 26, layout.top), "wire free");
        let y = layout.top - 34;
        text += &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{}</text>\n", escape(*name));
    }
    text
}

fn wire(path: &str, class: &str) -> String {
    format!("<path class=\"{class}\" d=\"{path}\" marker-end=\"url(#arrow)\"/>\n")
}

fn label(x: i32, y: i32, anchor: &str, name: &str) -> String {
    format!("<text x=\"{x}\" y=\"{}\" text-anchor=\"{anchor}\">{}</text>\n", y + 4, escape(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::system::systems;

    #[test]
    fn diagrams_are_drawings_with_all_wires() {
        for system in systems() {
            let text = loop_diagram(system, Some(system.plant.description));
            let drawing = resvg::usvg::Tree::from_str(&text, &resvg::usvg::Options::default()).unwrap();
            assert!(drawing.size().width() > 600.0);
            let wires = system.sensing.len() + system.actuation.len();
            assert!(text.matches("class=\"wire\"").count() == wires, "{}", system.name);
            for (output, input) in system.sensing.iter().chain(system.actuation) {
                assert!(text.contains(&format!(">{output}<")) && text.contains(&format!(">{input}<")));
            }
        }
    }
}
