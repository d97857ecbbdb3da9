//! The declared dependencies against what moves when something is changed.

use std::collections::BTreeSet;

use maglev_fmu::model::models;
use maglev_fmu::model::variable::{Causality, Kind, Variability, Variable};
use maglev_fmu::package::dependencies;
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg32;

use super::harness::{Component, OK, Standard, plants};

/// A random number in (0, 1).
fn uniform(random: &mut Pcg32) -> f64 {
    (f64::from(random.next_u32()) + 0.5) / f64::from(u32::MAX)
}

/// A value that the variable may have: around its start, of either sign where it may be, for inputs and voltages also
/// far beyond what a driver gives and for a position around and beyond the stops.
fn value(variable: &Variable, random: &mut Pcg32) -> f64 {
    let (minimum, maximum) = variable.range;
    let share = uniform(random);
    let choice = uniform(random);
    match variable.kind {
        Kind::Real(_) if variable.name == "initial.position" => match choice {
            0.0..0.15 => minimum,
            0.15..0.3 => maximum,
            0.3..0.5 => (0.003 * share).clamp(minimum, maximum),
            0.5..0.75 => (0.012 * share).clamp(minimum, maximum),
            _ => (0.06 * share - 0.03).clamp(minimum, maximum),
        },
        Kind::Real(quantity) => {
            let is_driven = variable.causality == Causality::Input || variable.name.contains("voltage");
            let size = match variable.start {
                0.0 => 0.1 * quantity.nominal,
                _ if is_driven && choice < 0.3 => 10.0 * quantity.nominal,
                start => start,
            };
            let amount = size * (0.5 + share);
            let may_be_negative = -amount >= minimum && -amount <= maximum;
            let value = if may_be_negative && uniform(random) < 0.3 { -amount } else { amount };
            value.clamp(minimum, maximum)
        }
        Kind::Integer => (minimum + share * 20.0).floor().min(maximum),
        Kind::Boolean => f64::from(u8::from(share > 0.5)),
        Kind::Enumeration(enumeration) => 1.0 + (share * enumeration.items.len() as f64).floor(),
    }
}

fn rows(component: &Component, keep: impl Fn(&Variable) -> bool) -> Vec<u32> {
    (0..component.description.variables.len() as u32).filter(|row| keep(component.variable(*row))).collect()
}

/// Pairs (unknown, known) by name of which the unknown moved when the known was changed.
type Moved = BTreeSet<(&'static str, &'static str)>;

/// Whether a value moved by more than rounding, of which normalised equations leave some.
fn has_moved(variable: &Variable, before: f64, after: f64) -> bool {
    let size = match variable.kind {
        Kind::Real(quantity) => quantity.nominal.max(before.abs()),
        _ => 0.0,
    };
    (before - after).abs() > 1e-9 * size
}

/// Records which of `unknowns` move when `known` is changed by `change`, which may leave it as it was.
fn record(component: &Component, unknowns: &[u32], known: u32, moved: &mut Moved, change: impl FnOnce()) {
    // Nothing where the model refuses to be initialised with what it has been given.
    let read = || -> Vec<Option<f64>> {
        let values = unknowns.iter().map(|row| component.get_reference(*row));
        values.map(|(status, value)| (status == OK).then_some(value)).collect()
    };
    let before = read();
    change();
    for ((unknown, before), after) in unknowns.iter().zip(before).zip(read()) {
        let variable = component.variable(*unknown);
        if let (Some(before), Some(after)) = (before, after)
            && has_moved(variable, before, after)
        {
            moved.insert((variable.name, component.variable(known).name));
        }
    }
}

/// One instance per interface that the model offers: one description is for all of them, so that what it declares has to
/// be seen in one of them at least.
fn instances(model: &str) -> Vec<Component> {
    let stepped = Component::with_logging(Standard::Fmi3, model, false);
    if !stepped.description.offers_model_exchange() {
        return vec![stepped];
    }
    vec![stepped, Component::exchanged(Standard::Fmi3, model)]
}

fn initial_unknowns(component: &Component) -> Vec<u32> {
    rows(component, |row| {
        let is_listed = matches!(row.causality, Causality::Output | Causality::CalculatedParameter);
        is_listed || row.derivative_of.is_some()
    })
}

#[test]
fn initial_values_follow_from_what_is_declared() {
    for model in models() {
        let name = model.description.name;
        let mut random = Pcg32::seed_from_u64(1);
        let mut moved = Moved::new();
        for component in instances(name) {
            assert_eq!(component.enter_initialization(0.0, None), OK);
            let knowns = rows(&component, |row| !row.is_calculated());
            let unknowns = initial_unknowns(&component);
            for _ in 0..1500 {
                for known in &knowns {
                    let variable = component.variable(*known);
                    let base = if uniform(&mut random) < 0.4 {
                        variable.start
                    } else {
                        value(variable, &mut random)
                    };
                    assert_eq!(component.set_reference(*known, base), OK, "{}", variable.name);
                }
                for known in &knowns {
                    let new = value(component.variable(*known), &mut random);
                    record(&component, &unknowns, *known, &mut moved, || {
                        assert_eq!(component.set_reference(*known, new), OK);
                    });
                }
            }
        }
        let component = Component::with_logging(Standard::Fmi3, name, false);
        let unknowns = initial_unknowns(&component);
        let declared: Moved = unknowns
            .iter()
            .flat_map(|row| {
                let name_of = |row: usize| component.variable(row as u32).name;
                let dependencies = dependencies(component.description).swap_remove(*row as usize);
                dependencies
                    .initially
                    .into_iter()
                    .map(move |source| (name_of(*row as usize), name_of(source)))
            })
            .collect();
        compare(name, &moved, &declared);
    }
}

/// Asserts that what moved is what was declared, and names the differences.
#[track_caller]
fn compare(model: &str, moved: &Moved, declared: &Moved) {
    let undeclared: Vec<_> = moved.difference(declared).collect();
    let unmoved: Vec<_> = declared.difference(moved).collect();
    assert!(
        undeclared.is_empty() && unmoved.is_empty(),
        "{model}: undeclared {undeclared:?}, never seen {unmoved:?}"
    );
}

/// Lets a plant start away from its stops, beyond the one at the smallest position or beyond the other.
fn place(component: &Component, place: usize) {
    let Some((_, row)) = component.description.find("initial.position") else { return };
    let value = [row.start, row.range.0, row.range.1][place];
    assert_eq!(component.set(row.name, value), OK);
    // Too little to lift a ball, enough to hold what hangs from a magnet.
    if let Some((_, row)) = component.description.find("initial.flux") {
        assert_eq!(component.set(row.name, [1.0, 0.5, 1.5][place] * row.start), OK);
    }
}

/// Continuous and held outputs and state derivatives; event indicators, too.
fn unknowns(component: &Component) -> Vec<u32> {
    rows(component, |row| {
        row.causality == Causality::Output || row.derivative_of.is_some() || row.is_event_indicator
    })
}

fn declared(component: &Component, of: impl Fn(&Variable) -> bool) -> Moved {
    let unknowns = unknowns(component);
    let pairs = unknowns.iter().flat_map(|row| {
        let name_of = |row: usize| component.variable(row as u32).name;
        let dependencies = dependencies(component.description).swap_remove(*row as usize);
        dependencies.at_an_instant.into_iter().map(move |(known, _)| (name_of(*row as usize), name_of(known)))
    });
    pairs.filter(|(_, known)| of(component.description.find(known).unwrap().1)).collect()
}

#[test]
fn at_a_communication_point_outputs_follow_from_what_is_declared() {
    for model in models() {
        let name = model.description.name;
        let (mut random, mut moved) = (Pcg32::seed_from_u64(2), Moved::new());
        let is_known = |row: &Variable| {
            row.causality == Causality::Input
                || row.causality == Causality::Parameter && row.variability == Variability::Tunable
        };
        for (start, component) in
            (0..3).flat_map(|start| instances(name).into_iter().map(move |c| (start, c)))
        {
            place(&component, start);
            component.initialise(0.0);
            let unknowns = unknowns(&component);
            for k in 0..40 {
                for known in rows(&component, is_known) {
                    let new = value(component.variable(known), &mut random);
                    record(&component, &unknowns, known, &mut moved, || {
                        assert_eq!(component.set_reference(known, new), OK);
                    });
                }
                // At an event of model exchange nobody steps.
                let may_step = component.step(f64::from(k) * 1e-4, 1e-4) == OK;
                assert!(may_step || component.try_update_discrete_states().0 == OK);
            }
        }
        let component = Component::with_logging(Standard::Fmi3, name, false);
        compare(name, &moved, &declared(&component, is_known));
    }
}

#[test]
fn in_continuous_time_outputs_follow_from_what_is_declared() {
    for (standard, model) in plants() {
        let (mut random, mut moved) = (Pcg32::seed_from_u64(3), Moved::new());
        for start in 0..3 {
            let component = Component::exchanged(standard, model);
            place(&component, start);
            component.initialise(0.0);
            component.update_discrete_states();
            assert_eq!(component.enter_continuous_time(), OK);
            let unknowns = unknowns(&component);
            let begin = component.states();
            for _ in 0..40 {
                for (index, (state, _)) in component.description.continuous_states().enumerate() {
                    let mut new = component.states();
                    new[index] =
                        begin[index] + component.nominals()[index] * (uniform(&mut random) - 0.5) * 1e-2;
                    record(&component, &unknowns, state as u32, &mut moved, || {
                        assert_eq!(component.set_states(&new), OK);
                    });
                }
                for input in rows(&component, |row| row.causality == Causality::Input) {
                    let new = value(component.variable(input), &mut random);
                    record(&component, &unknowns, input, &mut moved, || {
                        assert_eq!(component.set_reference(input, new), OK);
                    });
                }
            }
        }
        let component = Component::exchanged(standard, model);
        let states: Vec<usize> = component.description.continuous_states().map(|(state, _)| state).collect();
        let is_state = |row: &Variable| {
            states.iter().any(|state| component.description.variables[*state].name == row.name)
        };
        let declared = declared(&component, |row| row.causality == Causality::Input || is_state(row));
        compare(model, &moved, &declared);
    }
}
