//! First page of a system's documentation.

use super::form::SystemForm;
use crate::model::system::System;
use crate::package::GenerationTime;
use crate::package::documentation::STYLE;
use crate::package::loop_diagram::diagram_name;

/// The page as HTML, with the communication step \[s\].
pub fn page(system: &System, form: SystemForm, step_size: f64, time: GenerationTime) -> String {
    let diagram = diagram_name(system.name);
    let [controller, plant] = [system.controller, system.plant].map(|model| model.description);
    let (controller_name, plant_name) = (controller.name, plant.name);
    let connectors = if form.has_system_connectors() {
        "Inputs that the loop leaves open, and all outputs of both models, are connectors of the system."
    } else {
        "Inputs that the loop leaves open keep their start values unless a tool sets them."
    };
    format!(
        "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<title>{name}</title>
<style>
{STYLE}</style>
</head>
<body>
<h1>{name}</h1>
<p><img src=\"{diagram}\" alt=\"{controller_name} and {plant_name} in a loop\"></p>
<p><code>{controller_name}</code>: {}. <code>{plant_name}</code>: {}. Their own documentation is inside
<code>resources/{controller_name}.fmu</code> and <code>resources/{plant_name}.fmu</code>. {connectors}</p>
<p>Communication step: {:?} s, so in the default experiment; the controller refuses steps beyond its
<code>longest_step</code>. The models start as a master needs it that steps both at once and then exchanges values: the
observer gets the voltage that acted (<code>observer.voltage_source = applied</code>), and the controller lets the first
step pass (<code>start_delay</code>), in which wires may carry zeros.{remark}</p>
<p>Parameters are in <code>resources/{controller_name}.ssv</code> and <code>resources/{plant_name}.ssv</code>, at the
start values of the models in this package and ready to be changed. Choices (enumerations) are not among them, since not
every importer takes these files with enumerations; set them in the tool.</p>
<p>Written by maglev-fmu {}, source as of {time}.</p>
</body>
</html>
",
        controller.summary,
        plant.summary,
        step_size,
        env!("CARGO_PKG_VERSION"),
        name = system.name,
        remark = system.remark,
    )
}
