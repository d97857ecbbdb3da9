//! Random calls on every package and interface type, sensible or not, against the tables of the standards
//! ([`super::standard`]): what is allowed works, what is forbidden is refused and changes nothing, everything else is a
//! deviation that is listed; all results are finite, every state can be saved, nothing crashes.
//!
//! A failure names its sequence; `RANDOM_CALLS="<scenario> <seed> <calls>" cargo test --test fmi replay -- --nocapture`
//! repeats it.

mod answer;
mod arguments;
mod call;
mod callbacks;
mod calling_fmi2;
mod calling_fmi3;
mod checks;
mod dice;
mod environment;
mod generator;
mod log;
mod model;
mod oracle;
mod rarer_calls;
mod saved;
mod scenario;
mod session;
mod tally;
mod values;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use super::standard::{Causality, Deviations, Kind, ModelDescription, Table};
use saved::Kept;
use scenario::Scenario;
use session::Session;
use tally::Tally;

/// Calls on one instance.
const LENGTH: usize = 100;

/// Longest time that a call may take, ten times what the models allow themselves: machines are slow at times.
const TIME_LIMIT: Duration = Duration::from_secs(10);

/// Failures that are told apart, and how many of them are told.
const TOLD: usize = 12;

/// `sequences` sequences of each scenario, from `seed` on; panics with what failed, one sequence of each kind.
fn run(scenarios: &[Scenario], seed: u64, sequences: u64) -> Tally {
    let (next, total) = (AtomicUsize::new(0), Mutex::new((Tally::default(), BTreeMap::new())));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(scenario) = scenarios.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let place = scenarios.iter().position(|known| core::ptr::eq(known, scenario)).unwrap();
                    let (mut own, mut failures) = (Tally::default(), BTreeMap::new());
                    for seed in seed..seed + sequences {
                        match sequence(scenarios, place, seed, LENGTH) {
                            Ok(tally) => own.add(tally),
                            Err(failure) => {
                                failures.entry(kind(&failure)).or_insert(failure);
                            }
                        }
                    }
                    println!("{}: {} calls", scenario.name(), own.calls());
                    let mut total = total.lock().unwrap();
                    total.0.add(own);
                    total.1.append(&mut failures);
                }
            });
        }
    });
    let (tally, failures) = total.into_inner().unwrap();
    let told: Vec<_> = failures.values().take(TOLD).map(String::as_str).collect();
    assert!(tally.longest < TIME_LIMIT, "a call computes for {:?}: {}", tally.longest, tally.longest_call);
    assert!(failures.is_empty(), "{} kinds of failures:\n\n{}", failures.len(), told.join("\n\n"));
    tally
}

/// A failure without its numbers.
fn kind(failure: &str) -> String {
    failure.chars().take(160).filter(|character| !character.is_ascii_digit()).collect()
}

/// One sequence; deterministic, so that it knows bytes of states of other instances from sequences of its own. Some are
/// repeated under hosts that trap floating-point exceptions, round otherwise or flush small numbers: the same calls with
/// the same bits at their end.
fn sequence(scenarios: &[Scenario], place: usize, seed: u64, length: usize) -> Result<Tally, String> {
    let told = |what| format!("{what}\nRANDOM_CALLS=\"{place} {seed} {length}\"");
    let foreign = if seed.is_multiple_of(4) { foreign(scenarios, place, seed)? } else { Vec::new() };
    let run = |mood| Session::run(scenarios[place], seed, length, &foreign, mood);
    let (mut tally, _) = run(None).map_err(told)?;
    if seed % 8 == 1 {
        let (moody, _) = run(Some(seed)).map_err(told)?;
        if moody.last != tally.last {
            return Err(told("other bits under another host".to_owned()));
        }
        tally.add(moody);
    }
    Ok(tally)
}

/// Bytes of states of instances of another scenario, of a package whatever else there is.
fn foreign(scenarios: &[Scenario], place: usize, seed: u64) -> Result<Vec<Kept>, String> {
    let packaged = scenarios.iter().filter(|scenario| scenario.is_packaged()).count();
    let other = (place + 1 + seed as usize / 4) % packaged;
    let (_, mut kept) = Session::run(scenarios[other], u64::MAX - seed, 30, &[], None)
        .map_err(|what| format!("{what}\nin the foreign sequence of {place} {seed}"))?;
    kept.iter_mut().for_each(|kept| kept.model = None);
    Ok(kept)
}

/// Every variable of every package was read; every one that may be set was set, to its declared limits, too.
fn assert_reaches_everything(tally: &Tally, scenarios: &[Scenario]) {
    let is_meant = |description: &&ModelDescription| {
        scenarios.iter().any(|scenario| core::ptr::eq(scenario.description, *description))
    };
    for description in ModelDescription::all().iter().filter(is_meant) {
        for variable in &description.variables {
            let has = |places: &std::collections::BTreeSet<tally::Place>| {
                places.contains(&(
                    description.package.as_str(),
                    description.name.as_str(),
                    variable.reference,
                ))
            };
            let name = format!("{} {} {}", description.package, description.name, variable.name);
            assert!(
                has(&tally.read) || variable.causality == Causality::Input && variable.kind == Kind::Clock,
                "{name} was not read"
            );
            let is_settable = matches!(variable.causality, Causality::Input | Causality::Parameter)
                && variable.kind != Kind::Clock;
            if is_settable {
                assert!(has(&tally.set), "{name} was not set");
                let (smallest, largest) = variable.range;
                assert!(!smallest.is_finite() || has(&tally.limits[0]), "{name} was not set to {smallest}");
                assert!(!largest.is_finite() || has(&tally.limits[1]), "{name} was not set to {largest}");
            }
        }
    }
}

#[test]
fn random_calls_agree_with_the_standards() {
    let scenarios = Scenario::all();
    let tally = run(&scenarios, 0, 100);
    println!("{tally}");
    assert!(tally.calls() >= 200_000, "{}", tally.calls());
    assert_reaches_everything(&tally, &scenarios);
    for scenario in scenarios {
        let rows = Table::of(scenario.description.standard).rows();
        let missing = rows.iter().find(|row| !tally.functions.contains_key(row.function.as_str()));
        assert!(missing.is_none(), "{} was not called", missing.unwrap().function);
    }
}

/// Ten million calls, in minutes: `cargo test --test fmi ten_million -- --ignored`, with `--release` or without. Writes
/// the figures that
/// docs/conformance.md tells.
#[test]
#[ignore = "takes minutes"]
fn ten_million_random_calls_agree_with_the_standards() {
    let scenarios = Scenario::packaged();
    let sequences = 10_000_000_u64.div_ceil((scenarios.len() * LENGTH) as u64);
    let tally = run(&scenarios, 1 << 32, sequences);
    println!("{tally}");
    assert!(tally.calls() >= 10_000_000, "{}", tally.calls());
    assert_reaches_everything(&tally, &scenarios);
    let unmet: Vec<_> = Deviations::listed().ids().filter(|id| !tally.deviations.contains_key(id)).collect();
    assert!(unmet.is_empty(), "listed, but never met: {unmet:?}");
    let figures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmi/random/figures.toml");
    std::fs::write(figures, tally.figures(scenarios.len())).unwrap();
}

/// For scripts/check_memory.py: one thread, and nothing unusual about the host, which a memory checker only imitates.
#[test]
#[ignore = "for a memory checker"]
fn a_hundred_thousand_random_calls_for_a_memory_checker() {
    let scenarios = Scenario::packaged();
    let sequences = 100_000_u64.div_ceil((scenarios.len() * LENGTH) as u64);
    let mut tally = Tally::default();
    for scenario in &scenarios {
        for seed in 0..sequences {
            let outcome = Session::run(*scenario, (1 << 33) + seed, LENGTH, &[], None);
            tally.add(outcome.unwrap_or_else(|what| panic!("{what}")).0);
        }
    }
    println!("{} calls", tally.calls());
}

/// The sequence that the variable RANDOM_CALLS of the environment names.
#[test]
fn replay() {
    let Ok(named) = std::env::var("RANDOM_CALLS") else { return };
    let numbers: Vec<u64> = named.split_whitespace().map(|number| number.parse().unwrap()).collect();
    let outcome = sequence(&Scenario::all(), numbers[0] as usize, numbers[1], numbers[2] as usize);
    println!("{}", outcome.unwrap_or_else(|what| panic!("{what}")));
}
