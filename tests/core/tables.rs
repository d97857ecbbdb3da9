//! What holds for the tables of all models.

use maglev_fmu::model::variable::{Causality, Kind};
use maglev_fmu::model::{LARGEST_TABLE, TIME, editions, models};

#[test]
fn tables_are_consistent() {
    for model in models() {
        let variables = model.description.variables;
        assert!(variables.len() <= LARGEST_TABLE, "{}", model.description.name);
        assert_eq!(variables[TIME].causality, Causality::Independent, "{}", model.description.name);
        for (reference, variable) in variables.iter().enumerate() {
            let name = variable.name;
            assert_eq!(model.description.find(name).map(|(found, _)| found), Some(reference), "{name} twice");
            assert!(!variable.description.is_empty(), "{name} has no description");
            assert!(variable.is_calculated() || variable.check(variable.start).is_ok(), "{name} start");
            for source in variable.initially_from {
                assert!(model.description.find(source).is_some(), "{name}: unknown {source}");
            }
            if matches!(variable.kind, Kind::Integer) && !variable.is_calculated() {
                assert!(variable.range.0 >= i32::MIN.into() && variable.range.1 <= i32::MAX.into(), "{name}");
            }
        }
        let mut made = (model.create)();
        assert_eq!(made.values().len(), variables.len());
        assert_eq!(made.sampled().is_some(), model.description.is_sampled(), "{}", model.description.name);
    }
}

#[test]
fn tokens_differ() {
    let tokens: Vec<_> = editions().map(|(model, edition)| edition.token(model.description)).collect();
    for (index, token) in tokens.iter().enumerate() {
        assert!(!tokens[..index].contains(token), "{token:?}");
    }
}
