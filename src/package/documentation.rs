//! `documentation/index.html`: what is modelled, the variables, where it comes from.

use std::borrow::Cow;

use quick_xml::escape::escape;

use super::loop_diagram::diagram_name;
use super::model_description::enumerations;
use super::registration::paragraphs;
use super::related_files::{DIRECTORY, INPUT, OUTPUT};
use super::run_figure::RUN_FIGURE;
use super::terminal::Terminal;
use super::{Form, GenerationTime, licenses, variable_text};
use crate::model::{Description, Edition, StartValues};

pub(super) const STYLE: &str = "\
body { font-family: sans-serif; line-height: 1.45; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #1d2733; }
h1, h2 { color: #1f4e79; }
table { border-collapse: collapse; width: 100%; font-size: 0.9em; }
th, td { border-bottom: 1px solid #d5dde5; padding: 0.3em 0.6em; text-align: left; vertical-align: top; }
th { background: #eef3f8; }
code { font-family: monospace; white-space: nowrap; }
img { max-width: 100%; }
h1 img { height: 1.6em; vertical-align: middle; }
";

/// The documentation page, self-contained.
pub fn documentation(
    description: &Description,
    start_values: &StartValues,
    form: Form,
    time: Option<GenerationTime>,
) -> String {
    let name = description.name;
    let summary = escape(description.summary);
    let paragraphs = lines(paragraphs(description).iter().map(|text| format!("<p>{}</p>", escape(text))));
    let variables = lines(description.variables.iter().enumerate().map(|(reference, variable)| {
        row([
            code(variable.name),
            variable_text::kind(variable).into(),
            escape(variable_text::unit(variable)),
            escape(variable_text::start(variable, start_values.of(reference, variable))),
            escape(variable_text::range(variable)),
            escape(variable.description),
        ])
    }));
    let loops = loops(description);
    let choices = choices(description);
    let provenance = provenance(description, start_values, form, time);
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
<h1><img src=\"../terminalsAndIcons/icon.svg\" alt=\"\"> {name}</h1>
<p><strong>{summary}.</strong></p>
{paragraphs}
{loops}<h2>Variables</h2>
<table>
<tr><th>Name</th><th>Kind</th><th>Unit</th><th>Start</th><th>Range</th><th>Description</th></tr>
{variables}
</table>
{choices}<h2>Reference run</h2>
<p><a href=\"../{DIRECTORY}/{INPUT}\">{INPUT}</a> holds inputs, one row per communication point,
<a href=\"../{DIRECTORY}/{OUTPUT}\">{OUTPUT}</a> the outputs after the initialization and after each step, with start
values everywhere. An importer that sets each row, steps, and reads the outputs gets the same digits, whether it sets
the first row before or after the end of the initialization.</p>
<p><img src=\"{RUN_FIGURE}\" alt=\"Inputs and outputs of the reference run\"></p>
<h2>Provenance</h2>
{provenance}
</body>
</html>
"
    )
}

/// The loops that the model is part of, with their wires.
fn loops(description: &Description) -> String {
    let mut text = String::new();
    for terminal in Terminal::all_of(description) {
        let system = terminal.system;
        let (plant, controller) = (system.plant.description.name, system.controller.description.name);
        let rows = lines(system.wires().map(|wire| {
            row([wire.source.name.into(), code(wire.output), wire.target.name.into(), code(wire.input)])
        }));
        text += &format!(
            "<h2>Loop</h2>\n<p><img src=\"{}\" alt=\"{controller} and {plant} in a loop\"></p>\n\
             <table>\n<tr><th>From</th><th>output</th><th>to</th><th>input</th></tr>\n{rows}\n</table>\n",
            diagram_name(system.name)
        );
    }
    text
}

/// The enumerations and what their items mean.
fn choices(description: &Description) -> String {
    let mut text = String::new();
    for enumeration in enumerations(description) {
        let items = enumeration.items.iter().map(|&(item, meaning)| row([code(item), escape(meaning)]));
        text += &format!(
            "<h2>Enumeration {}</h2>\n<p>{}.</p>\n<table>\n{}\n</table>\n",
            escape(enumeration.name),
            escape(enumeration.description),
            lines(items)
        );
    }
    text
}

fn provenance(
    description: &Description,
    start_values: &StartValues,
    form: Form,
    time: Option<GenerationTime>,
) -> String {
    let time = time.map_or(String::new(), |time| format!(", source as of {time}"));
    let version = form.version;
    let clocks = if form.edition == Edition::Clocked { ", with clocks," } else { "" };
    format!(
        "<p>Exported for FMI {version}{clocks} by maglev-fmu {}{time}. Library, model description and this page come from \
         one table of variables; its token is <code>{}</code>.</p>\n\
         <p>{}, {} license: <a href=\"licenses/license.txt\">license.txt</a>. The library contains software of \
         others: <a href=\"licenses/THIRD-PARTY.txt\">THIRD-PARTY.txt</a>.</p>",
        env!("CARGO_PKG_VERSION"),
        start_values.token(description, form.edition),
        licenses::COPYRIGHT,
        licenses::NAME,
    )
}

fn code(text: &str) -> Cow<'_, str> {
    format!("<code>{}</code>", escape(text)).into()
}

fn row<const COLUMNS: usize>(cells: [Cow<'_, str>; COLUMNS]) -> String {
    format!("<tr><td>{}</td></tr>", cells.join("</td><td>"))
}

fn lines(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join("\n")
}
