//! What holds for the tables of all units.

use maglev_fmu::unit::variable::{Causality, Kind};
use maglev_fmu::unit::{LARGEST_TABLE, TIME, editions, units};

#[test]
fn tables_are_consistent() {
    for unit in units() {
        let variables = unit.description.variables;
        assert!(variables.len() <= LARGEST_TABLE, "{}", unit.description.name);
        assert_eq!(variables[TIME].causality, Causality::Independent, "{}", unit.description.name);
        for (reference, variable) in variables.iter().enumerate() {
            let name = variable.name;
            assert_eq!(unit.description.find(name).map(|(found, _)| found), Some(reference), "{name} twice");
            assert!(!variable.description.is_empty(), "{name} has no description");
            assert!(variable.is_calculated() || variable.check(variable.start).is_ok(), "{name} start");
            for source in variable.initially_from {
                assert!(unit.description.find(source).is_some(), "{name}: unknown {source}");
            }
            if matches!(variable.kind, Kind::Integer) && !variable.is_calculated() {
                assert!(variable.range.0 >= i32::MIN.into() && variable.range.1 <= i32::MAX.into(), "{name}");
            }
        }
        let mut made = (unit.create)();
        assert_eq!(made.values().len(), variables.len());
        assert_eq!(made.sampled().is_some(), unit.description.is_sampled(), "{}", unit.description.name);
    }
}

#[test]
fn tokens_differ() {
    let tokens: Vec<_> = editions().map(|(unit, edition)| edition.token(unit.description)).collect();
    for (index, token) in tokens.iter().enumerate() {
        assert!(!tokens[..index].contains(token), "{token:?}");
    }
}
