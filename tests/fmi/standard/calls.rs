//! The tables of calls and states.

use std::collections::{BTreeMap, HashMap};
use std::sync::LazyLock;

use super::super::harness::Standard;
use super::{Condition, Interface, State};

/// A function and where it may be called.
pub struct Row {
    pub function: String,
    /// What the model description has to have for it; empty if nothing.
    pub needs: String,
    conditions: BTreeMap<(Interface, State), Condition>,
}

impl Row {
    pub fn condition(&self, interface: Interface, state: State) -> Condition {
        self.conditions.get(&(interface, state)).copied().unwrap_or(Condition::Never)
    }
}

/// All functions of a standard.
pub struct Table {
    rows: Vec<Row>,
    places: HashMap<String, usize>,
}

impl Table {
    pub fn of(standard: Standard) -> &'static Self {
        static FMI2: LazyLock<Table> = LazyLock::new(|| Table::read(include_str!("fmi2_calls.csv")));
        static FMI3: LazyLock<Table> = LazyLock::new(|| Table::read(include_str!("fmi3_calls.csv")));
        match standard {
            Standard::Fmi2 => &FMI2,
            Standard::Fmi3 => &FMI3,
        }
    }

    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    pub fn row(&self, function: &str) -> &Row {
        &self.rows[self.places[function]]
    }

    fn read(text: &str) -> Self {
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
        let columns: Vec<_> = reader.headers().unwrap().iter().skip(3).map(column).collect();
        let rows: Vec<Row> = reader
            .records()
            .map(|record| {
                let record = record.unwrap();
                let cells = record.iter().skip(3).map(Condition::from_mark);
                Row {
                    function: record[0].to_owned(),
                    needs: record[2].to_owned(),
                    conditions: columns.iter().copied().zip(cells).collect(),
                }
            })
            .collect();
        let places = rows.iter().enumerate().map(|(place, row)| (row.function.clone(), place)).collect();
        Self { rows, places }
    }
}

/// Interface type and state of a column.
fn column(title: &str) -> (Interface, State) {
    let (interface, state) = title.split_once(' ').unwrap();
    let interface = Interface::ALL.iter().find(|(name, _)| *name == interface).unwrap().1;
    let state = State::ALL.iter().find(|(name, _)| *name == state).unwrap().1;
    (interface, state)
}

#[test]
fn tables_have_every_function_but_creation_version_and_freeing() {
    assert_eq!(Table::of(Standard::Fmi2).rows().len(), 44 - 4);
    assert_eq!(Table::of(Standard::Fmi3).rows().len(), 75 - 5);
    for standard in [Standard::Fmi2, Standard::Fmi3] {
        let table = Table::of(standard);
        assert_eq!(table.places.len(), table.rows.len(), "a function twice");
    }
}
