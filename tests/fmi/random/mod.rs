//! Random calls on every package and interface type, sensible or not, against the tables of the standards
//! ([`super::standard`]): what is allowed works, what is forbidden is refused and changes nothing, everything else is a
//! deviation that is listed; all results are finite, every state can be saved, nothing crashes.
//!
//! A failure names its sequence; `RANDOM_CALLS="<scenario> <seed> <calls>" cargo test --test fmi replay -- --nocapture`
//! repeats it.

mod answer;
mod arguments;
mod call;
mod calling_fmi2;
mod calling_fmi3;
mod checks;
mod dice;
mod environment;
mod generator;
mod log;
mod model;
mod oracle;
mod saved;
mod scenario;
mod session;
mod tally;
mod values;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::standard::{Causality, Deviations, Kind, ModelDescription};
use saved::Kept;
use scenario::Scenario;
use session::Session;
use tally::Tally;

/// Calls on one instance.
const LENGTH: usize = 100;

/// `sequences` sequences of each scenario, from `seed` on; panics at the first that fails.
fn run(seed: u64, sequences: u64) -> Tally {
    let scenarios = Scenario::all();
    let (next, total) = (AtomicUsize::new(0), Mutex::new(Tally::default()));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(scenario) = scenarios.get(place) else { return };
                    let mut own = Tally::default();
                    for seed in seed..seed + sequences {
                        own.add(sequence(&scenarios, place, seed, LENGTH));
                    }
                    println!("{}: {} calls", scenario.name(), own.calls());
                    total.lock().unwrap().add(own);
                }
            });
        }
    });
    total.into_inner().unwrap()
}

/// One sequence; deterministic, so that it knows bytes of states of other instances from sequences of its own. Some are
/// repeated under hosts that trap floating-point exceptions, round otherwise or flush small numbers: the same calls with
/// the same bits at their end.
fn sequence(scenarios: &[Scenario], place: usize, seed: u64, length: usize) -> Tally {
    let replay = format!("RANDOM_CALLS=\"{place} {seed} {length}\"");
    let foreign = if seed % 4 == 0 { foreign(scenarios, place, seed) } else { Vec::new() };
    let run = |mood| {
        let outcome = Session::run(scenarios[place], seed, length, &foreign, mood);
        outcome.unwrap_or_else(|what| panic!("{what}\n{replay}")).0
    };
    let mut tally = run(None);
    if seed % 8 == 1 {
        let moody = run(Some(seed));
        assert!(moody.last == tally.last, "other bits under another host\n{replay}");
        tally.add(moody);
    }
    tally
}

/// Bytes of states of instances of another scenario.
fn foreign(scenarios: &[Scenario], place: usize, seed: u64) -> Vec<Kept> {
    let other = (place + 1 + seed as usize / 4) % scenarios.len();
    let outcome = Session::run(scenarios[other], u64::MAX - seed, 30, &[], None);
    let (_, mut kept) =
        outcome.unwrap_or_else(|what| panic!("{what}\nin the foreign sequence of {place} {seed}"));
    kept.iter_mut().for_each(|kept| kept.model = None);
    kept
}

/// Every variable of every package was read; every one that may be set was set, to its declared limits, too.
fn assert_reaches_everything(tally: &Tally) {
    for description in ModelDescription::all() {
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
    let tally = run(0, 100);
    println!("{tally}");
    assert!(tally.calls() >= 200_000, "{}", tally.calls());
    assert_reaches_everything(&tally);
}

/// Ten million calls, in minutes: `cargo test --release --test fmi -- --ignored --nocapture ten_million`.
#[test]
#[ignore = "takes minutes"]
fn ten_million_random_calls_agree_with_the_standards() {
    let sequences = 10_000_000_u64.div_ceil((Scenario::all().len() * LENGTH) as u64);
    let tally = run(1 << 32, sequences);
    println!("{tally}");
    assert!(tally.calls() >= 10_000_000, "{}", tally.calls());
    assert_reaches_everything(&tally);
    let unused: Vec<_> = Deviations::listed().ids().filter(|id| !tally.deviations.contains_key(id)).collect();
    println!("not met: {unused:?}");
}

/// The sequence that the variable RANDOM_CALLS of the environment names.
#[test]
fn replay() {
    let Ok(named) = std::env::var("RANDOM_CALLS") else { return };
    let numbers: Vec<u64> = named.split_whitespace().map(|number| number.parse().unwrap()).collect();
    println!("{}", sequence(&Scenario::all(), numbers[0] as usize, numbers[1], numbers[2] as usize));
}
