//! Rules of the standards that a schema does not check, on the variables, types and units of every model description.

use super::model_description::{check_all, types, units_of_measure, variables};
use maglev_fmu::model::variable::Kind;
use maglev_fmu::package::FmiVersion;
use std::collections::BTreeSet;

#[test]
fn states_are_referred_to_by_their_derivatives() {
    check_all(|description, form, root| {
        let offset = if form.version == FmiVersion::Two { 1 } else { 0 };
        let variables = variables(root);
        for (variable, row) in variables.iter().zip(description.variables) {
            let state =
                variable.value.attribute("derivative").map(|text| text.parse::<usize>().unwrap() - offset);
            assert_eq!(state.map(|state| variables[state].name), row.derivative_of, "{}", row.name);
            let reinit = variable.value.attribute("reinit");
            assert_eq!(reinit, row.is_reinitialised.then_some("true"), "{}", row.name);
        }
        let count = description.event_indicators().count().to_string();
        let expected =
            (form.version == FmiVersion::Two && description.offers_model_exchange()).then_some(count);
        assert_eq!(root.attribute("numberOfEventIndicators"), expected.as_deref());
    });
}

#[test]
fn variables_are_the_rows_of_the_table() {
    check_all(|description, form, root| {
        let variables = variables(root);
        assert_eq!(variables.len(), description.variables.len());
        for (reference, (variable, row)) in variables.iter().zip(description.variables).enumerate() {
            assert_eq!(variable.name, row.name);
            assert_eq!(variable.head.attribute("valueReference"), Some(reference.to_string().as_str()));
            let kind = match (form.version, row.kind) {
                (FmiVersion::Two, Kind::Real(_)) => "Real",
                (FmiVersion::Three, Kind::Real(_)) => "Float64",
                (FmiVersion::Two, Kind::Integer) => "Integer",
                (FmiVersion::Three, Kind::Integer) => "Int32",
                (_, Kind::Boolean) => "Boolean",
                (_, Kind::Enumeration(_)) => "Enumeration",
            };
            assert_eq!(variable.value.name, kind, "{}", row.name);
        }
    });
}

#[test]
fn start_and_initial_follow_from_the_causality() {
    check_all(|_, _, root| {
        let mut independent = 0;
        for variable in variables(root) {
            let [causality, variability] =
                ["causality", "variability"].map(|name| variable.head.attribute(name).unwrap());
            let (initial, has_start) = match causality {
                "parameter" => (Some("exact"), true),
                "input" => (None, true),
                "calculatedParameter" | "output" | "local" => (Some("calculated"), false),
                "independent" => (None, false),
                other => panic!("{} is {other}", variable.name),
            };
            assert_eq!(variable.head.attribute("initial"), initial, "{}", variable.name);
            assert_eq!(variable.value.attribute("start").is_some(), has_start, "{}", variable.name);
            let allowed: &[&str] = match causality {
                "parameter" | "calculatedParameter" => &["fixed", "tunable"],
                "independent" => &["continuous"],
                _ => &["discrete", "continuous"],
            };
            assert!(allowed.contains(&variability), "{}: {variability}", variable.name);
            let is_real = ["Real", "Float64"].contains(&variable.value.name.as_str());
            assert!(is_real || variability != "continuous", "{} is no real number", variable.name);
            independent += usize::from(causality == "independent");
        }
        assert_eq!(independent, 1);
    });
}

#[test]
fn starts_lie_between_minimum_and_maximum() {
    check_all(|_, _, root| {
        let types = types(root);
        for variable in variables(root) {
            let name = variable.name;
            if variable.value.name == "Boolean" {
                assert!(matches!(variable.value.attribute("start"), None | Some("true" | "false")));
                continue;
            }
            let [minimum, start, maximum] = ["min", "start", "max"].map(|name| variable.number(name));
            for number in [minimum, start, maximum].into_iter().flatten() {
                assert!(number.is_finite(), "{name}");
            }
            let (minimum, maximum) = (minimum.unwrap_or(f64::MIN), maximum.unwrap_or(f64::MAX));
            assert!(minimum <= maximum, "{name}");
            let Some(start) = start else { continue };
            assert!((minimum..=maximum).contains(&start), "{name} = {start}");
            if variable.value.name == "Enumeration" {
                let items = &types[variable.value.attribute("declaredType").unwrap()].children;
                let number = start.to_string();
                assert!(
                    items.iter().any(|item| item.attribute("value") == Some(&number)),
                    "{name} = {start}"
                );
            }
        }
    });
}

#[test]
fn numbers_keep_all_their_digits() {
    check_all(|description, _, root| {
        for (variable, row) in variables(root).iter().zip(description.variables) {
            if matches!(row.kind, Kind::Real(_)) && !row.is_calculated() {
                assert_eq!(variable.number("start"), Some(row.start), "{}", row.name);
            }
        }
    });
}

#[test]
fn types_and_units_are_defined_and_used() {
    check_all(|_, form, root| {
        let (types, units) = (types(root), units_of_measure(root));
        let mut used = BTreeSet::new();
        for variable in variables(root) {
            assert!(!types.contains_key(variable.name), "{} is also a type", variable.name);
            let declared = variable.value.attribute("declaredType");
            match variable.value.name.as_str() {
                "Real" | "Float64" => {
                    let definition = types[declared.expect(variable.name)];
                    let unit = definition.attribute("unit").unwrap();
                    match form.version {
                        FmiVersion::Two => assert_eq!(variable.value.attribute("unit"), Some(unit)),
                        FmiVersion::Three => {
                            for attribute in ["unit", "displayUnit", "nominal", "quantity"] {
                                assert_eq!(variable.value.attribute(attribute), None, "{}", variable.name);
                            }
                        }
                    }
                    let display = definition.attribute("displayUnit");
                    assert!(display.is_none_or(|name| units[unit].contains(&name)), "{display:?}");
                    let nominal: f64 = definition.attribute("nominal").unwrap().parse().unwrap();
                    assert!(nominal > 0.0);
                }
                "Enumeration" => {
                    let items = &types[declared.expect(variable.name)].children;
                    for attribute in ["name", "value"] {
                        let distinct: BTreeSet<_> =
                            items.iter().map(|item| item.attribute(attribute).unwrap()).collect();
                        assert_eq!(distinct.len(), items.len(), "{declared:?}");
                    }
                }
                _ => assert_eq!(declared, None),
            }
            used.extend(declared);
        }
        assert_eq!(used, types.keys().copied().collect());
        if form.version == FmiVersion::Three {
            // FMPy before 0.3.24 refuses types with any other attribute, a description for one.
            let read = ["name", "quantity", "unit", "displayUnit", "min", "max", "nominal"];
            for definition in types.values() {
                let unread = definition.attributes.iter().find(|(name, _)| !read.contains(&name.as_str()));
                assert_eq!(unread, None, "{definition:?}");
            }
        }
        let of_types: BTreeSet<_> = types.values().filter_map(|element| element.attribute("unit")).collect();
        assert_eq!(of_types, units.keys().copied().collect());
    });
}
