//! Model descriptions as an importer reads them: the checked-in files, not the tables that they are written from. Of models
//! that a test adds, which no file describes, what would be packaged.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use maglev_fmu::model::{ADDED_MODELS, StartValues};
use maglev_fmu::package::{Form, model_description};
use roxmltree::{Document, Node};

use super::super::harness::Standard;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Real,
    Integer,
    Boolean,
    Enumeration,
    Clock,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    Independent,
    Parameter,
    CalculatedParameter,
    Input,
    Output,
    Local,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    Fixed,
    Tunable,
    Discrete,
    Continuous,
}

#[derive(Clone, Debug)]
pub struct Variable {
    pub reference: u32,
    pub name: String,
    pub kind: Kind,
    pub causality: Causality,
    pub variability: Variability,
    pub is_initially_exact: bool,
    pub is_initial_unknown: bool,
    /// Start value as a number.
    pub start: Option<f64>,
    /// Declared limits; of an enumeration its first and last item.
    pub range: (f64, f64),
    pub is_state: bool,
    pub is_state_derivative: bool,
    /// reinit
    pub may_jump: bool,
    /// intermediateUpdate
    pub may_be_updated: bool,
    /// Value references of the clocks it is bound to.
    pub clocks: Vec<u32>,
    /// Of a clock: intervalDecimal.
    pub has_interval: bool,
}

pub struct ModelDescription {
    pub standard: Standard,
    pub name: String,
    /// Directory of the file: which package it is of.
    pub package: String,
    pub token: String,
    pub variables: Vec<Variable>,
    pub state_count: usize,
    pub event_indicator_count: usize,
    /// Elements of interface types and their attributes.
    interfaces: Vec<(String, Vec<(String, String)>)>,
}

impl ModelDescription {
    /// All that are checked in, then those of added models.
    pub fn all() -> &'static [Self] {
        static ALL: LazyLock<Vec<ModelDescription>> = LazyLock::new(|| {
            let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription");
            let files = entries(&directory).into_iter().flat_map(|package| entries(&package));
            let checked_in = files.map(|file| {
                let package = file.parent().unwrap().file_name().unwrap().to_str().unwrap();
                ModelDescription::read(package, &std::fs::read_to_string(&file).unwrap())
            });
            let added = ADDED_MODELS.iter().map(|added| added.model).flat_map(|model| {
                Form::all_of(model.description).map(|form| {
                    let text = model_description(model.description, StartValues::TABLE, form, None);
                    ModelDescription::read(form.directory(), &text)
                })
            });
            checked_in.chain(added).collect()
        });
        &ALL
    }

    pub fn offers(&self, interface: &str) -> bool {
        self.interfaces.iter().any(|(name, _)| name == interface)
    }

    /// Whether an interface type declares a capability: true, or a number above 0.
    pub fn can(&self, interface: &str, capability: &str) -> bool {
        let found = self.interfaces.iter().find(|(name, _)| name == interface);
        let value = found.and_then(|(_, attributes)| attributes.iter().find(|(name, _)| name == capability));
        value.is_some_and(|(_, value)| value == "true" || value.parse().is_ok_and(|number: u32| number > 0))
    }

    pub fn find(&self, reference: u32) -> Option<&Variable> {
        // References count from 0 without gaps in these files, which `read` asserts.
        self.variables.get(reference as usize)
    }

    fn read(package: &str, text: &str) -> Self {
        let document = Document::parse(text).unwrap();
        let root = document.root_element();
        let standard =
            if root.attribute("fmiVersion") == Some("2.0") { Standard::Fmi2 } else { Standard::Fmi3 };
        let interfaces = ["ModelExchange", "CoSimulation", "ScheduledExecution"];
        let interfaces = root.children().filter(|node| interfaces.contains(&node.tag_name().name()));
        let interfaces = interfaces.map(|node| {
            let attributes = node.attributes().map(|a| (a.name().to_owned(), a.value().to_owned()));
            (node.tag_name().name().to_owned(), attributes.collect())
        });
        let structure = child(root, "ModelStructure").unwrap();
        let list = child(root, "ModelVariables").unwrap();
        let mut variables: Vec<Variable> =
            elements(list).map(|node| variable(standard, root, node)).collect();
        // Value reference that an element of the model structure or an attribute `derivative` means.
        let meant = |number: u32| if standard == Standard::Fmi2 { number - 1 } else { number };
        for node in elements(list) {
            let described = if standard == Standard::Fmi2 { elements(node).next().unwrap() } else { node };
            if let Some(state) = described.attribute("derivative") {
                variables[meant(state.parse().unwrap()) as usize].is_state = true;
                variables[number(node, "valueReference") as usize].is_state_derivative = true;
            }
        }
        let (unknowns, key) = match standard {
            Standard::Fmi2 => {
                (child(structure, "InitialUnknowns").into_iter().flat_map(elements).collect(), "index")
            }
            Standard::Fmi3 => {
                let all = elements(structure).filter(|node| node.has_tag_name("InitialUnknown"));
                (all.collect::<Vec<_>>(), "valueReference")
            }
        };
        for unknown in unknowns {
            variables[meant(number(unknown, key)) as usize].is_initial_unknown = true;
        }
        for (reference, variable) in variables.iter().enumerate() {
            assert_eq!(variable.reference as usize, reference, "{}", variable.name);
        }
        let count = |name| elements(structure).filter(|node| node.has_tag_name(name)).count();
        Self {
            standard,
            name: root.attribute("modelName").unwrap().to_owned(),
            package: package.to_owned(),
            token: root.attribute("guid").or(root.attribute("instantiationToken")).unwrap().to_owned(),
            state_count: variables.iter().filter(|variable| variable.is_state).count(),
            event_indicator_count: match standard {
                Standard::Fmi2 => {
                    root.attribute("numberOfEventIndicators").map_or(0, |count| count.parse().unwrap())
                }
                Standard::Fmi3 => count("EventIndicator"),
            },
            interfaces: interfaces.collect(),
            variables,
        }
    }
}

fn variable(standard: Standard, root: Node, node: Node) -> Variable {
    let described = if standard == Standard::Fmi2 { elements(node).next().unwrap() } else { node };
    let kind = match described.tag_name().name() {
        "Real" | "Float64" => Kind::Real,
        "Integer" | "Int32" => Kind::Integer,
        "Boolean" => Kind::Boolean,
        "Enumeration" => Kind::Enumeration,
        "Clock" => Kind::Clock,
        other => panic!("{other}"),
    };
    let bound = |name, otherwise| described.attribute(name).map_or(otherwise, |text| text.parse().unwrap());
    let range = if kind == Kind::Enumeration {
        (1.0, item_count(root, described.attribute("declaredType").unwrap()) as f64)
    } else {
        (bound("min", f64::NEG_INFINITY), bound("max", f64::INFINITY))
    };
    let clocks = described.attribute("clocks").unwrap_or_default().split_whitespace();
    Variable {
        reference: number(node, "valueReference"),
        name: node.attribute("name").unwrap().to_owned(),
        kind,
        causality: match node.attribute("causality").unwrap() {
            "independent" => Causality::Independent,
            "parameter" => Causality::Parameter,
            "calculatedParameter" => Causality::CalculatedParameter,
            "input" => Causality::Input,
            "output" => Causality::Output,
            "local" => Causality::Local,
            other => panic!("{other}"),
        },
        variability: match node.attribute("variability").unwrap() {
            "fixed" => Variability::Fixed,
            "tunable" => Variability::Tunable,
            "discrete" => Variability::Discrete,
            "continuous" => Variability::Continuous,
            other => panic!("{other}"),
        },
        is_initially_exact: node.attribute("initial") == Some("exact"),
        is_initial_unknown: false,
        start: described.attribute("start").map(value),
        range,
        is_state: false,
        is_state_derivative: false,
        may_jump: described.attribute("reinit") == Some("true"),
        may_be_updated: described.attribute("intermediateUpdate") == Some("true"),
        clocks: clocks.map(|reference| reference.parse().unwrap()).collect(),
        has_interval: described.attribute("intervalDecimal").is_some(),
    }
}

fn value(text: &str) -> f64 {
    match text {
        "true" => 1.0,
        "false" => 0.0,
        number => number.parse().unwrap(),
    }
}

/// Number of items of an enumeration type.
fn item_count(root: Node, name: &str) -> usize {
    let types = child(root, "TypeDefinitions").unwrap();
    let found = elements(types).find(|node| node.attribute("name") == Some(name)).unwrap();
    found.descendants().filter(|node| node.has_tag_name("Item")).count()
}

fn number(node: Node, attribute: &str) -> u32 {
    node.attribute(attribute).unwrap().parse().unwrap()
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> + use<'a, 'input> {
    node.children().filter(Node::is_element)
}

/// What is in a directory, in the order of the names.
fn entries(directory: &Path) -> Vec<PathBuf> {
    let found = std::fs::read_dir(directory).unwrap();
    let mut paths: Vec<_> = found.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}
