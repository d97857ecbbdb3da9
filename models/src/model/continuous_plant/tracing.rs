//! Dependencies of a plant's variables, found by running its equations on numbers that remember where they come from.

use std::collections::BTreeMap;

use super::evaluation::{follow, initialise};
use super::{ContinuousPlant, PlantEquations};
use crate::model::structure::{Dependencies, DependencyKind, Structured};
use crate::model::variable::{Causality, Kind, Variability, Variable};
use crate::model::{LARGEST_TABLE, Solver};
use crate::scalar::{MOST_VARIABLES, Traced, Variation};

const _: () = assert!(LARGEST_TABLE <= MOST_VARIABLES);

/// Who solves the plant, and whether its sensor is read: all that an instance may be.
const CONFIGURATIONS: [(Solver, bool); 3] =
    [(Solver::Model, true), (Solver::Importer, true), (Solver::Importer, false)];

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> Structured
    for ContinuousPlant<E, N, X, U>
{
    fn dependencies() -> Vec<Dependencies> {
        let rows = Self::at_an_instant().into_iter().zip(Self::initially());
        rows.map(|(at_an_instant, initially)| Dependencies { at_an_instant, initially }).collect()
    }
}

impl<E: PlantEquations<N, X, U>, const N: usize, const X: usize, const U: usize> ContinuousPlant<E, N, X, U> {
    fn at_an_instant() -> Vec<Vec<(usize, DependencyKind)>> {
        let mut runs = Vec::new();
        for (solver, is_read) in CONFIGURATIONS {
            for mode in E::MODES {
                let mut values = traced::<N>(E::DESCRIPTION.variables, |row, variable| {
                    let is_state = E::STATES.contains(&row);
                    if is_state { Some(Variation::Continuous) } else { variation(variable) }
                });
                E::calculate_parameters(&mut values);
                follow::<E, Traced, N, X, U>(
                    &mut values,
                    |values| E::evaluate(values, *mode),
                    solver,
                    is_read,
                );
                runs.push(values);
            }
        }
        (0..N).map(|row| join(runs.iter().map(|values| &values[row]))).collect()
    }

    fn initially() -> Vec<Vec<usize>> {
        let rows = E::SENSOR;
        let mut values = traced::<N>(E::DESCRIPTION.variables, |_, variable| variation(variable));
        E::calculate_parameters(&mut values);
        let cause = E::cause_of_initial_mode(&values, &E::initial_state(&values));
        let sample = values[rows.seed];
        let mut runs = Vec::new();
        for (solver, is_read) in CONFIGURATIONS {
            for mode in E::MODES {
                let mut run = values;
                initialise::<E, Traced, N, X, U>(&mut run, *mode, solver, is_read, sample);
                if solver == Solver::Importer {
                    // Whether there are readings at all.
                    run[E::READING] = run[E::READING].caused_by(values[rows.sample_time]);
                }
                for (row, value) in run.iter_mut().enumerate() {
                    if Self::differs_by_mode(&values, row, *mode, solver) {
                        *value = value.caused_by(cause);
                    }
                }
                runs.push(run);
            }
        }
        let mode_is_reported = |row: usize| Self::reports_mode(row).then_some(&cause);
        let dependencies = (0..N).map(|row| {
            let numbers = runs.iter().map(|run| &run[row]);
            join(numbers.chain(mode_is_reported(row))).into_iter().map(|(known, _)| known).collect()
        });
        dependencies.collect()
    }

    /// Whether the value of a row, the plant being as a mode forces it to be, is another one than in free motion.
    fn differs_by_mode(values: &[Traced; N], row: usize, mode: E::Mode, solver: Solver) -> bool {
        let mut forced = values.map(|value| value.value());
        let state = E::imposed(&forced, E::initial_state(&forced), mode);
        for (row, value) in E::STATES.into_iter().zip(state) {
            forced[row] = value;
        }
        let mut free = forced;
        follow::<E, f64, N, X, U>(&mut forced, |values| E::evaluate(values, mode), solver, true);
        follow::<E, f64, N, X, U>(&mut free, |values| E::evaluate(values, E::Mode::default()), solver, true);
        forced[row] != free[row]
    }

    /// Whether a row tells which mode there is.
    fn reports_mode(row: usize) -> bool {
        let reported = |mode: &E::Mode| {
            let mut values = [0.0; N];
            E::report_mode(&mut values, *mode);
            values[row]
        };
        E::MODES.iter().any(|mode| reported(mode) != reported(&E::MODES[0]))
    }
}

/// The table's variables, each with a value that is nothing special; given ones remember their row.
fn traced<const N: usize>(
    variables: &[Variable],
    variation: impl Fn(usize, &Variable) -> Option<Variation>,
) -> [Traced; N] {
    core::array::from_fn(|row| {
        let variable = &variables[row];
        let value = ordinary_value(row, variable);
        match variation(row, variable) {
            Some(variation) => Traced::variable(row, value, variation),
            None => Traced::from(value),
        }
    })
}

/// A value at which no term vanishes and no two terms cancel.
fn ordinary_value(row: usize, variable: &Variable) -> f64 {
    let irregular = 1.0 + 0.013 * row as f64;
    match variable.kind {
        Kind::Real(quantity) if variable.start == 0.0 => 0.1 * quantity.nominal * irregular,
        Kind::Real(_) => variable.start * irregular,
        Kind::Integer | Kind::Boolean | Kind::Enumeration(_) => variable.start,
    }
}

/// When a given variable can change; none of what is calculated.
fn variation(variable: &Variable) -> Option<Variation> {
    match (variable.causality, variable.variability) {
        (Causality::Input, _) => Some(Variation::Continuous),
        (Causality::Parameter, Variability::Tunable) => Some(Variation::Discrete),
        (Causality::Parameter, _) => Some(Variation::Fixed),
        _ => None,
    }
}

/// What a variable depends on that may be any of these numbers, one at a time. A known that enters in different ways does so
/// times a number that changes at events.
fn join<'a>(numbers: impl Iterator<Item = &'a Traced>) -> Vec<(usize, DependencyKind)> {
    let numbers: Vec<&Traced> = numbers.collect();
    let mut entries: BTreeMap<usize, Vec<(DependencyKind, f64)>> = BTreeMap::new();
    for number in &numbers {
        for (known, kind, slope) in number.dependencies() {
            entries.entry(known).or_default().push((kind, slope));
        }
    }
    let joined = entries.into_iter().map(|(known, ways)| {
        let is_always_the_same = ways.len() == numbers.len() && ways.iter().all(|way| *way == ways[0]);
        let largest = ways.iter().map(|(kind, _)| *kind).max().unwrap_or(DependencyKind::Dependent);
        (known, if is_always_the_same { largest } else { largest.max(DependencyKind::Discrete) })
    });
    joined.collect()
}
