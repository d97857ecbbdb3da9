//! The host reads model descriptions of both versions, and says what is wrong with broken ones.

use maglev_fmu::host::{Causality, FmiVersion, HostError, Kind, ModelDescription, Storage, Variability};

const FMI2: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Rotor &amp; bearing" guid="{abc}" numberOfEventIndicators="0"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <ModelExchange modelIdentifier="Other"/>
  <CoSimulation modelIdentifier="Rotor" canHandleVariableCommunicationStepSize="1" canGetAndSetFMUstate="false">
    <SourceFiles><File name="all.c"/></SourceFiles>
  </CoSimulation>
  <UnitDefinitions><Unit name="m"><BaseUnit m="1"/><DisplayUnit name="mm" factor="1000"/></Unit></UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Position" description="along the axis"><Real quantity="Length" unit="m"/></SimpleType>
    <SimpleType name="Law"><Enumeration><Item name="off" value="0"/><Item name="PID" value="3"/></Enumeration></SimpleType>
    <SimpleType name="Count"><Integer min="0"/></SimpleType>
  </TypeDefinitions>
  <LogCategories><Category name="logEvents"/></LogCategories>
  <DefaultExperiment startTime="0.5" stopTime="1e1" stepSize="1e-4"/>
  <VendorAnnotations><Tool name="any"><anything deep="1"><nested/></anything></Tool></VendorAnnotations>
  <ModelVariables>
    <!-- a comment -->
    <ScalarVariable name="time" valueReference="0" causality="independent"><Real/></ScalarVariable>
    <ScalarVariable name="position" valueReference="1" causality="output" description="gap > 0">
      <Annotations><Tool name="any"/></Annotations>
      <Real declaredType="Position" start="2.5e-3"/>
    </ScalarVariable>
    <ScalarVariable name="force" valueReference="2"><Real declaredType="Position" unit="N"/></ScalarVariable>
    <ScalarVariable name="law" valueReference="1" causality="parameter" variability="tunable">
      <Enumeration declaredType="Law" start="3"/>
    </ScalarVariable>
    <ScalarVariable name="steps" valueReference="2" variability="discrete"><Integer declaredType="Count"/></ScalarVariable>
    <ScalarVariable name="on" valueReference="1" causality="input"><Boolean start="true"/></ScalarVariable>
    <ScalarVariable name="label" valueReference="1" causality="parameter"><String start="a b"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="2"/></Outputs></ModelStructure>
</fmiModelDescription>"#;

const FMI3: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="Rotor" instantiationToken="{abc}">
  <CoSimulation modelIdentifier="Rotor" hasEventMode="true" fixedInternalStepSize="1e-5" canGetAndSetFMUState="true"/>
  <TypeDefinitions>
    <Float64Type name="Position" unit="m"/>
    <Int32Type name="Count"/>
    <EnumerationType name="Law"><Item name="off" value="-1"/><Item name="PID" value="3"/></EnumerationType>
    <Float32Type name="Current" unit="A"/>
    <BinaryType name="Blob"/>
  </TypeDefinitions>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <Float64 name="position" valueReference="1" causality="output" declaredType="Position">
      <Alias name="gap" description="the same"/><Alias name="h"/>
    </Float64>
    <Float32 name="current" valueReference="2" causality="input" start="0.5" declaredType="Current"/>
    <Float64 name="matrix" valueReference="3" causality="parameter" variability="fixed" start="1 0 0 1">
      <Dimension start="2"/><Dimension start="2"/>
    </Float64>
    <Int8 name="i8" valueReference="4"/>
    <UInt64 name="size" valueReference="5" causality="structuralParameter" variability="fixed" start="2"/>
    <Boolean name="on" valueReference="6" causality="input" start="false"/>
    <String name="label" valueReference="7" causality="parameter" variability="fixed"><Start value="a b"/></String>
    <Binary name="blob" valueReference="8" causality="input"><Start value="00ff"/></Binary>
    <Clock name="tick" valueReference="9" causality="input" intervalVariability="triggered"/>
    <Enumeration name="law" valueReference="10" declaredType="Law" causality="parameter" variability="tunable" start="3"/>
    <Complex128 name="later" valueReference="11"><Anything/></Complex128>
  </ModelVariables>
  <ModelStructure><Output valueReference="1"/></ModelStructure>
</fmiModelDescription>"#;

#[test]
fn reads_fmi2() {
    let description = ModelDescription::parse(FMI2).unwrap();
    assert_eq!(description.fmi_version, FmiVersion::Two);
    assert_eq!(description.model_name, "Rotor & bearing");
    assert_eq!(description.instantiation_token, "{abc}");
    let interface = description.co_simulation.as_ref().unwrap();
    assert_eq!(interface.model_identifier, "Rotor");
    assert!(interface.can_handle_variable_step && !interface.can_get_and_set_state);
    let experiment = description.default_experiment;
    assert_eq!((experiment.start_time, experiment.stop_time), (Some(0.5), Some(10.0)));
    assert_eq!((experiment.tolerance, experiment.step_size), (None, Some(1e-4)));

    let names: Vec<_> = description.variables.iter().map(|variable| variable.name.as_str()).collect();
    assert_eq!(names, ["time", "position", "force", "law", "steps", "on", "label"]);
    let position = description.variable("position").unwrap();
    assert_eq!((position.kind, position.storage), (Kind::Real, Storage::Float64));
    assert_eq!((position.value_reference, position.causality), (1, Causality::Output));
    assert_eq!(position.start.as_deref(), Some("2.5e-3"));
    assert_eq!(position.unit.as_deref(), Some("m"), "from the declared type");
    assert_eq!(position.description.as_deref(), Some("gap > 0"));
    let force = description.variable("force").unwrap();
    assert_eq!(force.unit.as_deref(), Some("N"), "its own unit wins");
    assert_eq!((force.causality, force.variability), (Causality::Local, Variability::Continuous));
    let law = description.variable("law").unwrap();
    assert_eq!((law.kind, law.storage), (Kind::Enumeration, Storage::Int32));
    let items = description.enumeration_items(law);
    assert_eq!((items[1].name.as_str(), items[1].value), ("PID", 3));
    assert!(description.enumeration_items(position).is_empty());
    assert_eq!(description.variable("steps").unwrap().kind, Kind::Integer);
    assert_eq!(description.variable("on").unwrap().kind, Kind::Boolean);
    assert_eq!(description.variable("label").unwrap().kind, Kind::String);
}

#[test]
fn reads_fmi3() {
    let description = ModelDescription::parse(&format!("\u{feff}{FMI3}")).unwrap();
    assert_eq!(description.fmi_version, FmiVersion::Three);
    let interface = description.co_simulation.as_ref().unwrap();
    assert!(
        interface.has_event_mode && interface.can_get_and_set_state && !interface.can_handle_variable_step
    );
    assert_eq!(interface.fixed_internal_step_size, Some(1e-5));
    assert_eq!(description.default_experiment.stop_time, None);

    let storage = |name: &str| {
        let variable = description.variable(name).unwrap();
        (variable.kind, variable.storage, variable.variability)
    };
    assert_eq!(storage("current"), (Kind::Real, Storage::Float32, Variability::Continuous));
    assert_eq!(storage("i8"), (Kind::Integer, Storage::Int8, Variability::Discrete));
    assert_eq!(storage("size"), (Kind::Integer, Storage::UInt64, Variability::Fixed));
    assert_eq!(storage("on"), (Kind::Boolean, Storage::Boolean, Variability::Discrete));
    assert_eq!(storage("blob"), (Kind::Other, Storage::Other, Variability::Discrete));
    assert_eq!(storage("tick"), (Kind::Other, Storage::Other, Variability::Discrete));
    assert_eq!(storage("law"), (Kind::Enumeration, Storage::Int64, Variability::Tunable));

    assert_eq!(description.variable("current").unwrap().unit.as_deref(), Some("A"));
    assert_eq!(description.variable("label").unwrap().start.as_deref(), Some("a b"));
    assert!(description.variable("matrix").unwrap().is_array);
    let alias = description.variable("h").unwrap();
    assert_eq!((alias.value_reference, alias.unit.as_deref()), (1, Some("m")));
    assert_eq!(description.enumeration("Law").unwrap()[0].value, -1);
    assert!(description.variable("later").is_err(), "an unknown element is passed over");
}

#[test]
fn an_unknown_variable_is_named_with_a_suggestion() {
    let description = ModelDescription::parse(FMI2).unwrap();
    let message = |name: &str| description.variable(name).unwrap_err().to_string();
    assert_eq!(
        message("Position"),
        "model `Rotor & bearing` has no variable `Position`, did you mean `position`?"
    );
    assert_eq!(message("speed"), "model `Rotor & bearing` has no variable `speed`");
    assert_eq!(message(""), "model `Rotor & bearing` has no variable ``");
}

/// Guards: names from a file that write a line of their own into a message, or colour the terminal.
#[test]
fn names_are_told_in_one_line() {
    let steering = "position&#10;error:&#27;[2J".replace("&#27;", "\u{7f}");
    let model = FMI2.replace("modelName=\"Rotor &amp; bearing\"", &format!("modelName=\"{steering}\""));
    assert_ne!(model, FMI2);
    let description = ModelDescription::parse(&model).unwrap();
    let message = description.variable("speed").unwrap_err().to_string();
    assert_eq!(message, r"model `position\nerror:\u{7f}[2J` has no variable `speed`");

    let wrong = FMI2.replace("fmiVersion=\"2.0\"", &format!("fmiVersion=\"{steering}\""));
    let message = ModelDescription::parse(&wrong).unwrap_err().to_string();
    assert!(message.contains(r"position\nerror:\u{7f}[2J"), "{message}");
}

#[test]
fn broken_descriptions_are_refused_with_the_reason() {
    let refused = |xml: &str| ModelDescription::parse(xml).unwrap_err();
    assert!(matches!(refused(""), HostError::Description { .. }));
    assert!(matches!(refused("not xml"), HostError::Description { .. }));
    assert!(matches!(refused(&FMI2[..FMI2.len() / 2]), HostError::Description { .. }));
    assert!(matches!(refused(&FMI2.replace("</ModelVariables>", "</Wrong>")), HostError::Description { .. }));
    assert!(refused(&FMI2.replace("guid=\"{abc}\"", "")).to_string().contains("guid"));
    assert!(matches!(
        refused(&FMI2.replace("fmiVersion=\"2.0\"", "fmiVersion=\"1.0\"")),
        HostError::UnsupportedVersion { version } if version == "1.0"
    ));
    assert_eq!(
        refused(&FMI3.replace("valueReference=\"5\"", "valueReference=\"-5\"")).to_string(),
        "cannot read modelDescription.xml: valueReference=\"-5\" of the variable `size` is not an unsigned 32 bit number"
    );
    assert_eq!(
        refused(&FMI3.replace("hasEventMode=\"true\"", "hasEventMode=\"yes\"")).to_string(),
        "cannot read modelDescription.xml: hasEventMode=\"yes\" of CoSimulation is not true or false"
    );
    assert_eq!(
        refused(&FMI2.replace("<Real declaredType=\"Position\" start=\"2.5e-3\"/>", "")).to_string(),
        "cannot read modelDescription.xml: the variable `position` has no type"
    );
}

/// Both standards ask for unique names, and FMI 3.0 (section 2.4.7.4) for unique value references; in FMI 2.0 (section
/// 2.2.7) equal references of one base type are aliases.
#[test]
fn what_two_variables_may_not_share_is_refused_by_name() {
    let message = |xml: &str| ModelDescription::parse(xml).unwrap_err().to_string();
    let twice = message(&FMI2.replace("name=\"force\"", "name=\"position\""));
    assert!(twice.contains("the name `position` is given to two variables"), "{twice}");
    assert!(
        twice.contains("value reference 1 (Float64)") && twice.contains("value reference 2 (Float64)"),
        "{twice}"
    );
    let alias = message(&FMI3.replace("<Alias name=\"h\"/>", "<Alias name=\"current\"/>"));
    assert!(alias.contains("the name `current`"), "{alias}");
    let reference =
        message(&FMI3.replace("name=\"i8\" valueReference=\"4\"", "name=\"i8\" valueReference=\"2\""));
    assert!(
        reference.contains("the value reference 2 is given to two variables, `current` and `i8`"),
        "{reference}"
    );
    ModelDescription::parse(
        &FMI2.replace("name=\"force\" valueReference=\"2\"", "name=\"force\" valueReference=\"1\""),
    )
    .unwrap();
}

/// Guards: times that no simulation can start or end at.
#[test]
fn experiments_that_cannot_be_run_are_refused() {
    let parse = |experiment: &str| {
        let old = "startTime=\"0.5\" stopTime=\"1e1\" stepSize=\"1e-4\"";
        ModelDescription::parse(&FMI2.replace(old, experiment))
    };
    for (experiment, expected) in [
        ("startTime=\"NaN\"", "startTime=\"NaN\" of DefaultExperiment is not a finite number"),
        ("startTime=\"-INF\"", "startTime=\"-INF\" of DefaultExperiment is not a finite number"),
        ("stopTime=\"1e999\"", "stopTime=\"1e999\" of DefaultExperiment is not a finite number"),
        (
            "startTime=\"2\" stopTime=\"1\"",
            "stopTime=\"1\" of DefaultExperiment is not a finite number that is not below",
        ),
        ("stopTime=\"-1\"", "not below startTime"),
        ("stepSize=\"0\"", "stepSize=\"0\" of DefaultExperiment is not a finite number greater than 0"),
        ("stepSize=\"-1e-3\"", "greater than 0"),
        (
            "tolerance=\"-1e-6\"",
            "tolerance=\"-1e-6\" of DefaultExperiment is not a finite number, 0 or greater",
        ),
    ] {
        let message = parse(experiment).unwrap_err().to_string();
        assert!(message.contains(expected), "{experiment}: {message}");
    }
    let experiment = parse("startTime=\"-2\" stopTime=\"-1\"").unwrap().default_experiment;
    assert_eq!(
        (experiment.start_time, experiment.stop_time),
        (Some(-2.0), Some(-1.0)),
        "time may be negative"
    );
}
