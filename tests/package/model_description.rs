//! Rules of the standards that a schema does not check, on the XML of every model.

use std::collections::{BTreeMap, BTreeSet};

use maglev_fmu::model::{Description, Edition, MODELS, StartValues, models};
use maglev_fmu::package::{Capabilities, FmiVersion, Form, GenerationTime, model_description};

use super::xml::Element;

/// A variable of either standard.
pub(super) struct Variable<'a> {
    pub name: &'a str,
    /// Element with causality, variability, initial.
    pub head: &'a Element,
    /// Element with type, start, min, max; the same as `head` in FMI 3.0.
    pub value: &'a Element,
}

impl Variable<'_> {
    pub fn number(&self, attribute: &str) -> Option<f64> {
        self.value.attribute(attribute).map(|text| text.parse().unwrap())
    }
}

pub(super) fn variables(root: &Element) -> Vec<Variable<'_>> {
    // Clocks have a test of their own.
    let elements = root.child("ModelVariables").children.iter().filter(|element| element.name != "Clock");
    elements
        .map(|head| {
            let value = if head.name == "ScalarVariable" { &head.children[0] } else { head };
            Variable { name: head.attribute("name").unwrap(), head, value }
        })
        .collect()
}

/// Name to element of all type definitions; in FMI 2.0 the element inside `SimpleType`.
pub(super) fn types(root: &Element) -> BTreeMap<&str, &Element> {
    let definitions = &root.child("TypeDefinitions").children;
    let types: BTreeMap<&str, &Element> = definitions
        .iter()
        .map(|element| {
            let definition = if element.name == "SimpleType" { &element.children[0] } else { element };
            (element.attribute("name").unwrap(), definition)
        })
        .collect();
    assert_eq!(types.len(), definitions.len(), "two types of one name");
    types
}

/// Unit name to display unit names.
pub(super) fn units_of_measure(root: &Element) -> BTreeMap<&str, Vec<&str>> {
    let definitions = &root.child("UnitDefinitions").children;
    assert!(definitions.iter().all(|element| element.children_named("BaseUnit").count() == 1));
    let units: BTreeMap<&str, Vec<&str>> = definitions
        .iter()
        .map(|element| {
            let names = element.children_named("DisplayUnit").map(|unit| unit.attribute("name").unwrap());
            (element.attribute("name").unwrap(), names.collect())
        })
        .collect();
    assert_eq!(units.len(), definitions.len(), "two units of one name");
    units
}

pub(super) fn check_all(check: impl Fn(&'static Description, Form, &Element)) {
    for model in models() {
        for form in Form::all_of(model.description) {
            let text = model_description(model.description, StartValues::TABLE, form, None);
            check(model.description, form, &Element::parse(&text));
        }
    }
}

#[test]
fn heads_name_the_model_and_its_token() {
    check_all(|description, form, root| {
        let (fmi_version, token) = match form.version {
            FmiVersion::Two => ("2.0", "guid"),
            FmiVersion::Three => ("3.0", "instantiationToken"),
        };
        assert_eq!(root.name, "fmiModelDescription");
        for (attribute, value) in [
            ("fmiVersion", fmi_version),
            ("modelName", description.name),
            (token, form.edition.token(description).as_str()),
            ("version", env!("CARGO_PKG_VERSION")),
            ("license", "MIT"),
            ("variableNamingConvention", "structured"),
        ] {
            assert_eq!(root.attribute(attribute), Some(value), "{attribute}");
        }
        assert_eq!(root.attribute("generationDateAndTime"), None);
        let identifier = root.child("CoSimulation").attribute("modelIdentifier").unwrap();
        assert_eq!(identifier, description.name);
        assert!(identifier.starts_with(|first: char| first.is_ascii_alphabetic()));
        assert!(identifier.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_'));
    });
}

#[test]
fn packages_carry_their_time() {
    let time = Some(GenerationTime::from_epoch_seconds(1_234_567_890));
    for form in Form::all_of(MODELS[0].description) {
        let root = Element::parse(&model_description(MODELS[0].description, StartValues::TABLE, form, time));
        assert_eq!(root.attribute("generationDateAndTime"), Some("2009-02-13T23:31:30Z"));
    }
}

#[test]
fn flags_are_those_of_the_library() {
    check_all(|description, form, root| {
        let can = Capabilities::of(description, form.edition);
        let flags = root.child("CoSimulation");
        let mut expected = vec![
            ("needsExecutionTool", can.needs_execution_tool),
            ("canHandleVariableCommunicationStepSize", can.can_handle_variable_communication_step_size),
            ("canBeInstantiatedOnlyOncePerProcess", can.can_be_instantiated_only_once_per_process),
        ];
        expected.extend(match form.version {
            FmiVersion::Two => vec![
                ("canInterpolateInputs", can.can_interpolate_inputs),
                ("canRunAsynchronuously", can.can_run_asynchronously),
                ("canNotUseMemoryManagementFunctions", can.can_not_use_memory_management_functions),
                ("canGetAndSetFMUstate", can.can_get_and_set_fmu_state),
                ("canSerializeFMUstate", can.can_serialize_fmu_state),
                ("providesDirectionalDerivative", can.provides_directional_derivatives),
            ],
            FmiVersion::Three => vec![
                ("canGetAndSetFMUState", can.can_get_and_set_fmu_state),
                ("canSerializeFMUState", can.can_serialize_fmu_state),
                ("providesDirectionalDerivatives", can.provides_directional_derivatives),
                ("providesAdjointDerivatives", can.provides_adjoint_derivatives),
                ("providesPerElementDependencies", can.provides_per_element_dependencies),
                ("providesIntermediateUpdate", can.provides_intermediate_update),
                ("mightReturnEarlyFromDoStep", can.might_return_early_from_do_step),
                ("canReturnEarlyAfterIntermediateUpdate", can.can_return_early_after_intermediate_update),
                ("hasEventMode", can.has_event_mode),
                ("providesEvaluateDiscreteStates", can.provides_evaluate_discrete_states),
            ],
        });
        for (flag, value) in &expected {
            assert_eq!(flags.attribute(flag), Some(value.to_string().as_str()), "{flag}");
        }
        let order = can.max_output_derivative_order.to_string();
        assert_eq!(flags.attribute("maxOutputDerivativeOrder"), Some(order.as_str()));
        // Nothing but those, the order and the identifier.
        assert_eq!(flags.attributes.len(), expected.len() + 2);
    });
}

#[test]
fn flags_of_model_exchange_are_those_of_the_library() {
    check_all(|description, form, root| {
        let can = Capabilities::of(description, form.edition);
        let elements: Vec<&Element> = root.children_named("ModelExchange").collect();
        assert_eq!(elements.len(), usize::from(description.offers_model_exchange()), "{}", description.name);
        let Some(flags) = elements.first() else { return };
        assert_eq!(flags.attribute("modelIdentifier"), Some(description.name));
        let mut expected = vec![
            ("needsExecutionTool", can.needs_execution_tool),
            ("canBeInstantiatedOnlyOncePerProcess", can.can_be_instantiated_only_once_per_process),
        ];
        expected.extend(match form.version {
            FmiVersion::Two => vec![
                ("completedIntegratorStepNotNeeded", !can.needs_completed_integrator_step),
                ("canNotUseMemoryManagementFunctions", can.can_not_use_memory_management_functions),
                ("canGetAndSetFMUstate", can.can_get_and_set_fmu_state),
                ("canSerializeFMUstate", can.can_serialize_fmu_state),
                ("providesDirectionalDerivative", can.provides_directional_derivatives),
            ],
            FmiVersion::Three => vec![
                ("needsCompletedIntegratorStep", can.needs_completed_integrator_step),
                ("canGetAndSetFMUState", can.can_get_and_set_fmu_state),
                ("canSerializeFMUState", can.can_serialize_fmu_state),
                ("providesDirectionalDerivatives", can.provides_directional_derivatives),
                ("providesAdjointDerivatives", can.provides_adjoint_derivatives),
                ("providesPerElementDependencies", can.provides_per_element_dependencies),
                ("providesEvaluateDiscreteStates", can.provides_evaluate_discrete_states),
            ],
        });
        for (flag, value) in &expected {
            assert_eq!(flags.attribute(flag), Some(value.to_string().as_str()), "{flag}");
        }
        assert_eq!(flags.attributes.len(), expected.len() + 1);
    });
}

#[test]
fn clocked_editions_have_two_clocks_and_may_be_scheduled_and_plain_ones_have_neither() {
    check_all(|description, form, root| {
        let elements = root.child("ModelVariables").children.iter();
        let clocks: Vec<_> = elements.filter(|element| element.name == "Clock").collect();
        let scheduled = root.children_named("ScheduledExecution").count();
        let has_events = root.child("CoSimulation").attribute("hasEventMode");
        let intermediate = variables(root)
            .iter()
            .filter(|variable| variable.head.attribute("intermediateUpdate") == Some("true"))
            .map(|variable| (variable.head.attribute("causality"), variable.head.attribute("variability")))
            .collect::<BTreeSet<_>>();
        // Within a step only continuous inputs may be set, and nothing that is discrete may be asked for.
        let calls_back = form.version == FmiVersion::Three && description.is_sampled();
        let expected = calls_back.then_some((Some("input"), Some("continuous")));
        assert_eq!(intermediate, expected.into_iter().collect());
        let structure = &root.child("ModelStructure").children;
        let rows = structure.iter().filter_map(|row| row.attribute("valueReference")?.parse::<usize>().ok());
        let of_clocks = rows.filter(|reference| *reference >= description.variables.len()).count();
        if form.edition == Edition::Plain {
            // Many importers misread clocks and what goes with them.
            assert_eq!((clocks.len(), scheduled, of_clocks), (0, 0, 0));
            assert!(matches!(has_events, None | Some("false")));
            return;
        }
        assert_eq!((scheduled, has_events), (1, Some("true")));
        let identifier = root.child("ScheduledExecution").attribute("modelIdentifier");
        assert_eq!(identifier, Some(description.name));
        let expected = [
            [Some("tick"), Some("input"), Some("fixed"), Some("0"), Some("true")],
            [Some("ticked"), Some("output"), Some("triggered"), None, None],
        ];
        assert_eq!(clocks.len(), expected.len());
        for (index, (clock, expected)) in clocks.iter().zip(expected).enumerate() {
            let names = ["name", "causality", "intervalVariability", "priority", "supportsFraction"];
            assert_eq!(names.map(|name| clock.attribute(name)), expected);
            let reference = (description.variables.len() + index).to_string();
            assert_eq!(clock.attribute("valueReference"), Some(reference.as_str()));
            assert_eq!(clock.attribute("variability"), Some("discrete"));
            // "This attribute is required if Clock type is constant, fixed or tunable", section 2.4.5.1.
            let interval =
                clock.attribute("intervalDecimal").map(|interval| interval.parse::<f64>().unwrap());
            let (_, sample_time) = description.find("sample_time").unwrap();
            assert_eq!(interval, (index == 0).then_some(sample_time.start));
        }
        // Outputs can be read outside of ticks, `ticked` at ticks only.
        assert!(variables(root).iter().all(|variable| variable.head.attribute("clocks").is_none()));
        let [tick, ticked] = [clocks[0], clocks[1]];
        let bound_to = [tick, ticked].map(|clock| clock.attribute("clocks"));
        assert_eq!(bound_to, [None, tick.attribute("valueReference")]);
        // It is listed as an output and, being bound to a clock, not among the initial unknowns.
        assert_eq!(of_clocks, 1);
        let output = root.child("ModelStructure").children_named("Output").last().unwrap();
        assert_eq!(output.attribute("valueReference"), clocks[1].attribute("valueReference"));
        assert_eq!(output.attribute("dependencies"), clocks[0].attribute("valueReference"));
    });
}

#[test]
fn experiment_and_log_categories_are_given() {
    check_all(|description, _, root| {
        let experiment = root.child("DefaultExperiment");
        for (attribute, value) in
            [("startTime", 0.0), ("stopTime", description.stop_time), ("stepSize", description.step_size)]
        {
            assert_eq!(experiment.attribute(attribute).unwrap().parse(), Ok(value));
        }
        assert_eq!(experiment.attribute("tolerance"), None);
        let categories = &root.child("LogCategories").children;
        let names: Vec<&str> =
            categories.iter().map(|category| category.attribute("name").unwrap()).collect();
        assert_eq!(names, ["logStatusError", "logStatusFatal", "logEvents", "logObserver"]);
        assert!(categories.iter().all(|category| !category.attribute("description").unwrap().is_empty()));
    });
}
