//! Outputs, states, unknowns and what they depend on, in the XML of every model.

use std::collections::BTreeSet;

use maglev_fmu::model::Edition;
use maglev_fmu::model::structure::DependencyKind;
use maglev_fmu::model::variable::Causality;
use maglev_fmu::package::{FmiVersion, dependencies};

use super::model_description::check_all;
use super::xml::Element;

#[test]
fn structure_lists_outputs_and_initial_unknowns_exactly() {
    check_all(|description, form, root| {
        let structure = root.child("ModelStructure");
        let (mut outputs, mut unknowns, key, offset): (Vec<&Element>, Vec<&Element>, _, _) =
            match form.version {
                FmiVersion::Two => (
                    structure.child("Outputs").children.iter().collect(),
                    structure.child("InitialUnknowns").children.iter().collect(),
                    "index",
                    1,
                ),
                FmiVersion::Three => (
                    structure.children_named("Output").collect(),
                    structure.children_named("InitialUnknown").collect(),
                    "valueReference",
                    0,
                ),
            };
        let row = |text: &str| text.parse::<usize>().unwrap() - offset;
        // The clock that the model activates is an output, too; it has nothing to do with what follows.
        for (elements, elements_are_outputs) in [(&mut outputs, true), (&mut unknowns, false)] {
            let count = elements.len();
            elements.retain(|element| row(element.attribute(key).unwrap()) < description.variables.len());
            let clocks = form.edition == Edition::Clocked && elements_are_outputs;
            assert_eq!(count - elements.len(), usize::from(clocks));
        }
        let rows = |elements: &[&Element]| -> Vec<usize> {
            elements.iter().map(|element| row(element.attribute(key).unwrap())).collect()
        };
        let with_causality = |wanted: &[Causality]| -> Vec<usize> {
            let rows = description.variables.iter().enumerate();
            rows.filter(|(_, row)| wanted.contains(&row.causality)).map(|(index, _)| index).collect()
        };
        assert_eq!(rows(&outputs), with_causality(&[Causality::Output]));
        let mut expected = with_causality(&[Causality::Output, Causality::CalculatedParameter]);
        let derivatives: Vec<usize> =
            description.continuous_states().map(|(_, derivative)| derivative).collect();
        expected.extend(description.continuous_states().flat_map(|(state, derivative)| [state, derivative]));
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(rows(&unknowns), expected);

        let (listed, indicators): (Vec<&Element>, Vec<&Element>) = match form.version {
            FmiVersion::Two => (
                structure.children_named("Derivatives").flat_map(|element| &element.children).collect(),
                Vec::new(),
            ),
            FmiVersion::Three => (
                structure.children_named("ContinuousStateDerivative").collect(),
                structure.children_named("EventIndicator").collect(),
            ),
        };
        assert_eq!(rows(&listed), derivatives);
        if form.version == FmiVersion::Three {
            assert_eq!(rows(&indicators), description.event_indicators().collect::<Vec<_>>());
        }
        for unknown in outputs.into_iter().chain(listed).chain(indicators) {
            let variable = &description.variables[row(unknown.attribute(key).unwrap())];
            let names: Vec<&str> = unknown
                .attribute("dependencies")
                .unwrap()
                .split_whitespace()
                .map(|text| description.variables[row(text)].name)
                .collect();
            let kinds: Vec<&str> =
                unknown.attribute("dependenciesKind").unwrap_or("").split_whitespace().collect();
            let found: BTreeSet<(&str, &str)> = names.iter().copied().zip(kinds).collect();
            // Parameters are knowns of FMI 3.0 only.
            let is_known = |name: &str| {
                let (_, known) = description.find(name).unwrap();
                form.version == FmiVersion::Three || known.causality != Causality::Parameter
            };
            let row = row(unknown.attribute(key).unwrap());
            let found_in_equations = dependencies(description).swap_remove(row).at_an_instant;
            let declared: BTreeSet<(&str, &str)> = found_in_equations
                .iter()
                .map(|(known, kind)| {
                    let kind = match kind {
                        DependencyKind::Constant => "constant",
                        DependencyKind::Fixed => "fixed",
                        DependencyKind::Discrete => "discrete",
                        DependencyKind::Dependent => "dependent",
                    };
                    (description.variables[*known].name, kind)
                })
                .filter(|(name, _)| is_known(name))
                .collect();
            assert_eq!(found, declared, "{}", variable.name);
        }

        for unknown in unknowns {
            let variable = &description.variables[row(unknown.attribute(key).unwrap())];
            let known_rows: Vec<usize> =
                unknown.attribute("dependencies").unwrap().split_whitespace().map(row).collect();
            assert!(known_rows.is_sorted_by(|a, b| a < b), "{}", variable.name);
            let row = row(unknown.attribute(key).unwrap());
            assert_eq!(known_rows, dependencies(description)[row].initially, "{}", variable.name);
            for known in &known_rows {
                let causality = description.variables[*known].causality;
                assert!(
                    matches!(causality, Causality::Parameter | Causality::Input | Causality::Independent),
                    "{} follows from what is no known of the initialisation",
                    variable.name
                );
            }
            let kinds = unknown.attribute("dependenciesKind").unwrap_or("").split_whitespace();
            assert_eq!(kinds.collect::<Vec<_>>(), vec!["dependent"; known_rows.len()]);
        }
    });
}
