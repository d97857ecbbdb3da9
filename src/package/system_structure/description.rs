//! `SystemStructure.ssd` (SSP 1.0.1 and 2.0, section 5).

use serde::Serialize;

use super::connectors::{Connections, Connectors, connectable};
use super::experiment::{COSIM_NAMESPACE, DefaultExperiment, OMSIMULATOR_NAMESPACE, SystemAnnotations};
use super::{COMMON, Component, DESCRIPTION, SystemForm};
use crate::package::model_description::GENERATION_TOOL;
use crate::package::{GenerationTime, licenses};
use crate::unit::quantity::UnitOfMeasure;
use crate::unit::system::System as UnitSystem;
use crate::unit::variable::{Kind, Variable};

#[derive(Serialize)]
pub struct SystemStructureDescription {
    #[serde(rename = "@xmlns:ssd")]
    description_namespace: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    common_namespace: &'static str,
    /// Declared here: libcosim takes a declaration on the annotation for part of it.
    #[serde(rename = "@xmlns:osp")]
    cosim_namespace: &'static str,
    #[serde(rename = "@xmlns:oms")]
    omsimulator_namespace: &'static str,
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
    #[serde(rename = "ssd:Connectors", skip_serializing_if = "Option::is_none")]
    connectors: Option<Connectors>,
    #[serde(rename = "ssd:Elements")]
    elements: Elements,
    #[serde(rename = "ssd:Connections")]
    connections: Connections,
    #[serde(rename = "ssd:Annotations")]
    annotations: SystemAnnotations,
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

impl SystemStructureDescription {
    pub fn new(system: &'static UnitSystem, form: SystemForm, time: GenerationTime) -> Self {
        let components = Component::all_of(system);
        Self {
            description_namespace: DESCRIPTION,
            common_namespace: COMMON,
            cosim_namespace: COSIM_NAMESPACE,
            omsimulator_namespace: OMSIMULATOR_NAMESPACE,
            version: form.version(),
            name: system.name,
            copyright: licenses::COPYRIGHT,
            license: licenses::NAME,
            generation_tool: GENERATION_TOOL,
            generation_time: time.to_string(),
            units: Units::of(components.iter().flat_map(|component| connectable(component, form))),
            default_experiment: DefaultExperiment::new(system),
            system: System::new(system, &components, form),
        }
    }
}

impl System {
    fn new(system: &'static UnitSystem, components: &[Component; 2], form: SystemForm) -> Self {
        let elements = components.iter().zip(0..).map(|(component, column)| element(component, column, form));
        Self {
            name: system.name,
            description: format!(
                "{} with {}",
                system.plant.description.name, system.controller.description.name
            ),
            connectors: form.has_system_connectors().then(|| Connectors::of_system(components, form)),
            elements: Elements { components: elements.collect() },
            connections: Connections::new(components, form),
            annotations: SystemAnnotations::new(system),
        }
    }
}

fn element(component: &Component, column: i32, form: SystemForm) -> ComponentElement {
    ComponentElement {
        name: component.name,
        description: component.unit.description.summary,
        media_type: "application/x-fmu-sharedlibrary",
        source: component.unit_path(),
        implementation: "CoSimulation",
        connectors: Connectors::of_component(component, form),
        geometry: ElementGeometry { x1: 300 * column, y1: 0, x2: 300 * column + 200, y2: 200 },
        bindings: ParameterBindings {
            binding: ParameterBinding {
                media_type: "application/x-ssp-parameter-set",
                source: component.parameters_path(),
            },
        },
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
