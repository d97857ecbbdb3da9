//! Connectors of components and of the system itself, and what connects them.

use serde::Serialize;

use super::{Component, SystemForm};
use crate::unit::variable::{Causality, Kind, Variable};

#[derive(Serialize)]
pub struct Connectors {
    #[serde(rename = "ssd:Connector")]
    connectors: Vec<Connector>,
}

#[derive(Serialize)]
struct Connector {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "@kind")]
    kind: &'static str,
    #[serde(rename = "$value")]
    data_type: DataType,
    #[serde(rename = "ssd:ConnectorGeometry")]
    geometry: ConnectorGeometry,
}

#[derive(Serialize)]
enum DataType {
    #[serde(rename = "ssc:Real")]
    Real {
        #[serde(rename = "@unit")]
        unit: &'static str,
    },
    #[serde(rename = "ssc:Float64")]
    Float64 {
        #[serde(rename = "@unit")]
        unit: &'static str,
    },
    #[serde(rename = "ssc:Integer")]
    Integer,
    #[serde(rename = "ssc:Int32")]
    Int32,
    #[serde(rename = "ssc:Boolean")]
    Boolean,
}

/// Place on the edge, both coordinates from 0 to 1, y upwards.
#[derive(Serialize)]
struct ConnectorGeometry {
    #[serde(rename = "@x")]
    x: f64,
    #[serde(rename = "@y")]
    y: f64,
}

#[derive(Serialize)]
pub struct Connections {
    #[serde(rename = "ssd:Connection")]
    connections: Vec<Connection>,
}

/// Without an element the connector is the system's.
#[derive(Serialize)]
struct Connection {
    #[serde(rename = "@startElement", skip_serializing_if = "Option::is_none")]
    start_element: Option<&'static str>,
    #[serde(rename = "@startConnector")]
    start_connector: String,
    #[serde(rename = "@endElement", skip_serializing_if = "Option::is_none")]
    end_element: Option<&'static str>,
    #[serde(rename = "@endConnector")]
    end_connector: String,
}

impl Connectors {
    /// Of a component: its inputs and outputs.
    pub fn of_component(component: &Component, form: SystemForm) -> Self {
        let on_side = |causality| {
            let rows = connectable(component, form).filter(move |variable| variable.causality == causality);
            rows.map(|variable| (variable.name.to_owned(), variable)).collect()
        };
        Self::on_both_sides(on_side(Causality::Input), on_side(Causality::Output), form)
    }

    /// Of the system: the inputs that the loop leaves open, and what both units compute in continuous quantities.
    pub fn of_system(components: &[Component; 2], form: SystemForm) -> Self {
        let named = |variable: &'static Variable| (system_name(variable), variable);
        let inputs = components.iter().flat_map(open_inputs).map(named).collect();
        let outputs = components.iter().flat_map(shown_outputs).map(named).collect();
        Self::on_both_sides(inputs, outputs, form)
    }

    /// Inputs on the left edge, outputs on the right.
    fn on_both_sides(
        inputs: Vec<(String, &'static Variable)>,
        outputs: Vec<(String, &'static Variable)>,
        form: SystemForm,
    ) -> Self {
        let side = |variables: Vec<(String, &'static Variable)>, kind, x| {
            let count = variables.len();
            variables.into_iter().enumerate().filter_map(move |(place, (name, variable))| {
                let y = 1.0 - (place as f64 + 0.5) / count as f64;
                Some(Connector {
                    name,
                    description: variable.description,
                    kind,
                    data_type: DataType::of(variable, form)?,
                    geometry: ConnectorGeometry { x, y },
                })
            })
        };
        Self { connectors: side(inputs, "input", 0.0).chain(side(outputs, "output", 1.0)).collect() }
    }
}

impl DataType {
    /// `None` for types that not every importer has.
    fn of(variable: &Variable, form: SystemForm) -> Option<Self> {
        match (variable.kind, form) {
            (Kind::Real(quantity), SystemForm::Closed | SystemForm::Driven) => {
                Some(Self::Real { unit: quantity.unit.name })
            }
            (Kind::Real(quantity), SystemForm::Two) => Some(Self::Float64 { unit: quantity.unit.name }),
            (Kind::Integer, SystemForm::Closed | SystemForm::Driven) => Some(Self::Integer),
            (Kind::Integer, SystemForm::Two) => Some(Self::Int32),
            (Kind::Boolean, _) => Some(Self::Boolean),
            _ => None,
        }
    }
}

impl Connections {
    /// The wires of the loop, then those from and to the system's own connectors.
    pub fn new(components: &[Component; 2], form: SystemForm) -> Self {
        let [controller, plant] = components;
        let wires = |from: &Component, to: &Component| {
            let (start_element, end_element) = (Some(from.name), Some(to.name));
            to.wired.iter().map(move |(output, input)| Connection {
                start_element,
                start_connector: (*output).to_owned(),
                end_element,
                end_connector: (*input).to_owned(),
            })
        };
        let from_outside = components.iter().flat_map(|component| {
            open_inputs(component).map(|input| Connection {
                start_element: None,
                start_connector: system_name(input),
                end_element: Some(component.name),
                end_connector: input.name.to_owned(),
            })
        });
        let to_outside = components.iter().flat_map(|component| {
            shown_outputs(component).map(|output| Connection {
                start_element: Some(component.name),
                start_connector: output.name.to_owned(),
                end_element: None,
                end_connector: system_name(output),
            })
        });
        let mut connections: Vec<_> = wires(plant, controller).chain(wires(controller, plant)).collect();
        if form.has_system_connectors() {
            connections.extend(from_outside.chain(to_outside));
        }
        Self { connections }
    }
}

/// Variables of a component that are connectors: outputs, and inputs that something is connected to.
pub fn connectable(
    component: &Component,
    form: SystemForm,
) -> impl Iterator<Item = &'static Variable> + use<> {
    let wired = component.wired;
    rows_of_common_types(component).filter(move |variable| match variable.causality {
        Causality::Input => form.has_system_connectors() || is_wired(variable, wired),
        causality => causality == Causality::Output,
    })
}

/// Rows of the types that every importer has.
fn rows_of_common_types(component: &Component) -> impl Iterator<Item = &'static Variable> + use<> {
    let rows = component.unit.description.variables.iter();
    rows.filter(|variable| matches!(variable.kind, Kind::Real(_) | Kind::Integer | Kind::Boolean))
}

fn is_wired(variable: &Variable, wires: &[(&str, &str)]) -> bool {
    wires.iter().any(|(_, input)| *input == variable.name)
}

/// Inputs that no wire of the loop ends at.
fn open_inputs(component: &Component) -> impl Iterator<Item = &'static Variable> + use<> {
    let wired = component.wired;
    rows_of_common_types(component)
        .filter(move |variable| variable.causality == Causality::Input && !is_wired(variable, wired))
}

fn shown_outputs(component: &Component) -> impl Iterator<Item = &'static Variable> + use<> {
    rows_of_common_types(component)
        .filter(|variable| variable.causality == Causality::Output && matches!(variable.kind, Kind::Real(_)))
}

/// Name of the system's connector for a variable. A dot in it would stand between an element and its connector.
fn system_name(variable: &Variable) -> String {
    variable.name.replace('.', "_")
}
