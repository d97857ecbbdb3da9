//! `SystemStructure.ssd` (SSP 1.0.1, section 5).

use serde::Serialize;

use super::{COMMON, Component, DESCRIPTION, VERSION};
use crate::package::model_description::{GENERATION_TOOL, real};
use crate::package::{GenerationTime, licenses};
use crate::unit::Description;
use crate::unit::quantity::UnitOfMeasure;
use crate::unit::system::System as UnitSystem;
use crate::unit::variable::{Causality, Kind, Variable};

/// Annotations that libcosim reads: the standard has no communication step size.
const STEP_SIZE_ANNOTATION: &str = "com.opensimulationplatform";
const STEP_SIZE_NAMESPACE: &str = "http://opensimulationplatform.com/SSP/OSPAnnotations";

#[derive(Serialize)]
pub struct SystemStructureDescription {
    #[serde(rename = "@xmlns:ssd")]
    description_namespace: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    common_namespace: &'static str,
    /// Declared here: libcosim takes a declaration on the annotation for part of it.
    #[serde(rename = "@xmlns:osp")]
    step_size_namespace: &'static str,
    #[serde(rename = "@version")]
    version: &'static str,
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@copyright")]
    copyright: &'static str,
    #[serde(rename = "@license")]
    license: &'static str,
    #[serde(rename = "@generationTool")]
    generation_tool: &'static str,
    #[serde(rename = "@generationDateAndTime")]
    generation_time: String,
    #[serde(rename = "ssd:System")]
    system: System,
    #[serde(rename = "ssd:Units")]
    units: Units,
    #[serde(rename = "ssd:DefaultExperiment")]
    default_experiment: DefaultExperiment,
}

#[derive(Serialize)]
struct System {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@description")]
    description: String,
    #[serde(rename = "ssd:Elements")]
    elements: Elements,
    #[serde(rename = "ssd:Connections")]
    connections: Connections,
}

#[derive(Serialize)]
struct Elements {
    #[serde(rename = "ssd:Component")]
    components: Vec<ComponentElement>,
}

#[derive(Serialize)]
struct ComponentElement {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "@type")]
    media_type: &'static str,
    #[serde(rename = "@source")]
    source: String,
    #[serde(rename = "@implementation")]
    implementation: &'static str,
    #[serde(rename = "ssd:Connectors")]
    connectors: Connectors,
    #[serde(rename = "ssd:ElementGeometry")]
    geometry: ElementGeometry,
    #[serde(rename = "ssd:ParameterBindings")]
    bindings: ParameterBindings,
}

#[derive(Serialize)]
struct Connectors {
    #[serde(rename = "ssd:Connector")]
    connectors: Vec<Connector>,
}

#[derive(Serialize)]
struct Connector {
    #[serde(rename = "@name")]
    name: &'static str,
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
    #[serde(rename = "ssc:Integer")]
    Integer,
    #[serde(rename = "ssc:Boolean")]
    Boolean,
}

/// Place on the component's edge, both coordinates from 0 to 1, y upwards.
#[derive(Serialize)]
struct ConnectorGeometry {
    #[serde(rename = "@x")]
    x: f64,
    #[serde(rename = "@y")]
    y: f64,
}

/// Corners of the component, y upwards.
#[derive(Serialize)]
struct ElementGeometry {
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
struct ParameterBindings {
    #[serde(rename = "ssd:ParameterBinding")]
    binding: ParameterBinding,
}

#[derive(Serialize)]
struct ParameterBinding {
    #[serde(rename = "@type")]
    media_type: &'static str,
    #[serde(rename = "@source")]
    source: String,
}

#[derive(Serialize)]
struct Connections {
    #[serde(rename = "ssd:Connection")]
    connections: Vec<Connection>,
}

#[derive(Serialize)]
struct Connection {
    #[serde(rename = "@startElement")]
    start_element: &'static str,
    #[serde(rename = "@startConnector")]
    start_connector: &'static str,
    #[serde(rename = "@endElement")]
    end_element: &'static str,
    #[serde(rename = "@endConnector")]
    end_connector: &'static str,
}

#[derive(Serialize)]
pub struct Units {
    #[serde(rename = "ssc:Unit")]
    units: Vec<Unit>,
}

#[derive(Serialize)]
struct Unit {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "ssc:BaseUnit")]
    base: BaseUnit,
}

#[derive(Serialize)]
struct BaseUnit {
    #[serde(rename = "@kg")]
    kilogram: i8,
    #[serde(rename = "@m")]
    metre: i8,
    #[serde(rename = "@s")]
    second: i8,
    #[serde(rename = "@A")]
    ampere: i8,
}

#[derive(Serialize)]
struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    start_time: String,
    #[serde(rename = "@stopTime")]
    stop_time: String,
    #[serde(rename = "ssd:Annotations")]
    annotations: Annotations,
}

#[derive(Serialize)]
struct Annotations {
    #[serde(rename = "ssc:Annotation")]
    annotation: Annotation,
}

#[derive(Serialize)]
struct Annotation {
    #[serde(rename = "@type")]
    annotation_type: &'static str,
    #[serde(rename = "osp:Algorithm")]
    algorithm: Algorithm,
}

#[derive(Serialize)]
struct Algorithm {
    #[serde(rename = "osp:FixedStepAlgorithm")]
    fixed_step: FixedStepAlgorithm,
}

#[derive(Serialize)]
struct FixedStepAlgorithm {
    #[serde(rename = "@baseStepSize")]
    base_step_size: String,
}

impl SystemStructureDescription {
    pub fn new(system: &'static UnitSystem, time: GenerationTime) -> Self {
        let components = Component::all_of(system);
        let units = components.iter().flat_map(connectors_of);
        Self {
            description_namespace: DESCRIPTION,
            common_namespace: COMMON,
            step_size_namespace: STEP_SIZE_NAMESPACE,
            version: VERSION,
            name: system.name,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.to_string(),
            units: Units::of(units),
            default_experiment: DefaultExperiment::new(system),
            system: System::new(system, components),
        }
    }
}

impl System {
    fn new(system: &'static UnitSystem, components: [Component; 2]) -> Self {
        let [controller, plant] = &components;
        let wires = |from: &Component, to: &Component| {
            let (start_element, end_element) = (from.name, to.name);
            to.wired.iter().map(move |&(start_connector, end_connector)| Connection {
                start_element,
                start_connector,
                end_element,
                end_connector,
            })
        };
        let connections = wires(plant, controller).chain(wires(controller, plant)).collect();
        Self {
            name: system.name,
            description: format!(
                "{} with {}",
                system.plant.description.name, system.controller.description.name
            ),
            elements: Elements { components: components.iter().zip(0..).map(element).collect() },
            connections: Connections { connections },
        }
    }
}

fn element((component, column): (&Component, i32)) -> ComponentElement {
    let description = component.unit.description;
    ComponentElement {
        name: component.name,
        description: description.summary,
        media_type: "application/x-fmu-sharedlibrary",
        source: component.unit_path(),
        implementation: "CoSimulation",
        connectors: Connectors::new(component),
        geometry: ElementGeometry { x1: 300 * column, y1: 0, x2: 300 * column + 200, y2: 200 },
        bindings: ParameterBindings {
            binding: ParameterBinding {
                media_type: "application/x-ssp-parameter-set",
                source: component.parameters_path(),
            },
        },
    }
}

/// Variables of a component that other components can be connected to.
fn connectors_of(component: &Component) -> impl Iterator<Item = &'static Variable> {
    let Description { variables, .. } = component.unit.description;
    let wired = component.wired;
    variables.iter().filter(move |variable| match variable.causality {
        Causality::Input => wired.iter().any(|(_, input)| *input == variable.name),
        Causality::Output => DataType::of(variable).is_some(),
        _ => false,
    })
}

impl Connectors {
    /// Inputs on the left edge, outputs on the right.
    fn new(component: &Component) -> Self {
        let side = |causality| {
            let variables: Vec<_> =
                connectors_of(component).filter(|variable| variable.causality == causality).collect();
            let (count, x) = (variables.len(), f64::from(u8::from(causality == Causality::Output)));
            variables.into_iter().enumerate().filter_map(move |(place, variable)| {
                let y = 1.0 - (place as f64 + 0.5) / count as f64;
                Connector::new(variable, ConnectorGeometry { x, y })
            })
        };
        Self { connectors: side(Causality::Input).chain(side(Causality::Output)).collect() }
    }
}

impl Connector {
    fn new(variable: &'static Variable, geometry: ConnectorGeometry) -> Option<Self> {
        Some(Self {
            name: variable.name,
            description: variable.description,
            kind: if variable.causality == Causality::Input { "input" } else { "output" },
            data_type: DataType::of(variable)?,
            geometry,
        })
    }
}

impl DataType {
    /// `None` for types that SSP 1.0 or its importers do not have.
    fn of(variable: &Variable) -> Option<Self> {
        match variable.kind {
            Kind::Real(quantity) => Some(Self::Real { unit: quantity.unit.name }),
            Kind::Integer => Some(Self::Integer),
            Kind::Boolean => Some(Self::Boolean),
            _ => None,
        }
    }
}

impl Units {
    /// Units of measure of some variables, each once.
    pub fn of(variables: impl Iterator<Item = &'static Variable>) -> Self {
        let mut units: Vec<Unit> = Vec::new();
        for variable in variables {
            if let Kind::Real(quantity) = variable.kind
                && !units.iter().any(|known| known.name == quantity.unit.name)
            {
                units.push(Unit::new(quantity.unit));
            }
        }
        Self { units }
    }
}

impl Unit {
    fn new(unit: &UnitOfMeasure) -> Self {
        let [kilogram, metre, second, ampere] = unit.exponents;
        Self { name: unit.name, base: BaseUnit { kilogram, metre, second, ampere } }
    }
}

impl DefaultExperiment {
    fn new(system: &UnitSystem) -> Self {
        let [plant, controller] = [system.plant, system.controller].map(|unit| unit.description);
        Self {
            start_time: real(0.0),
            stop_time: real(plant.stop_time.max(controller.stop_time)),
            annotations: Annotations {
                annotation: Annotation {
                    annotation_type: STEP_SIZE_ANNOTATION,
                    algorithm: Algorithm {
                        fixed_step: FixedStepAlgorithm {
                            base_step_size: real(plant.step_size.min(controller.step_size)),
                        },
                    },
                },
            },
        }
    }
}
