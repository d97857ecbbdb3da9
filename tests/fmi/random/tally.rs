//! What was called, and what came of it.

use core::fmt;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use super::super::standard::{Kind, State};
use super::answer::Answer;
use super::call::Call;
use super::oracle::Verdict;
use super::session::{Session, deviations};

/// A variable: package, model, value reference.
pub type Place = (&'static str, &'static str, u32);

#[derive(Default)]
pub struct Tally {
    /// Calls that returned OK, Warning, Discard, Error.
    pub statuses: [u64; 4],
    pub instances: u64,
    /// Calls within callbacks.
    pub nested: u64,
    pub functions: BTreeMap<&'static str, [u64; 2]>,
    pub deviations: BTreeMap<&'static str, u64>,
    pub read: BTreeSet<Place>,
    pub set: BTreeSet<Place>,
    /// Set to the smallest, to the largest value.
    pub limits: [BTreeSet<Place>; 2],
    /// Serialised state at the end of a sequence.
    pub last: Vec<u8>,
    pub longest: Duration,
    pub longest_call: String,
}

impl Tally {
    pub fn calls(&self) -> u64 {
        self.statuses.iter().sum()
    }

    pub fn count(
        &mut self,
        session: &Session,
        call: &Call,
        verdict: &Verdict,
        answer: &Answer,
        duration: Duration,
    ) {
        let model = session.model.borrow();
        self.statuses[answer.status as usize] += 1;
        self.nested += u64::from(matches!(model.state, State::Intermediate | State::Update));
        let description = session.scenario.description;
        let outcomes = self.functions.entry(call.function(description.standard)).or_default();
        outcomes[usize::from(answer.status != 0)] += 1;
        if duration > self.longest {
            self.longest = duration;
            self.longest_call = format!("{}: {call:?}", session.scenario.name());
        }
        if !model.is_known {
            return;
        }
        let is_declined = matches!(verdict.rule, super::oracle::Rule::Declined(_));
        if answer.status == 0 || is_declined {
            for id in deviations(verdict) {
                *self.deviations.entry(id).or_default() += 1;
            }
        }
        if answer.status != 0 {
            return;
        }
        let place = |reference: &u32| (description.package.as_str(), description.name.as_str(), *reference);
        match call {
            Call::Get { references, .. } | Call::GetClocks { references } => {
                self.read.extend(references.iter().map(place));
            }
            Call::Set { references, values, .. } => {
                self.set.extend(references.iter().map(place));
                for (reference, value) in references.iter().zip(values) {
                    let Some(variable) = description.find(*reference) else { continue };
                    let (smallest, largest) = variable.range;
                    let (is_smallest, is_largest) = match variable.kind {
                        Kind::Boolean => (*value == 0.0, *value == 1.0),
                        _ => (*value == smallest, *value == largest),
                    };
                    for (is_limit, limit) in [is_smallest, is_largest].into_iter().zip(&mut self.limits) {
                        if is_limit {
                            limit.insert(place(reference));
                        }
                    }
                }
            }
            _ => {}
        }
    }

    /// A deviation that no single call shows.
    pub fn meet(&mut self, deviation: &'static str) {
        *self.deviations.entry(deviation).or_default() += 1;
    }

    pub fn add(&mut self, other: Self) {
        for (sum, more) in self.statuses.iter_mut().zip(other.statuses) {
            *sum += more;
        }
        self.instances += other.instances;
        self.nested += other.nested;
        for (function, more) in other.functions {
            let sum = self.functions.entry(function).or_default();
            *sum = [sum[0] + more[0], sum[1] + more[1]];
        }
        for (id, more) in other.deviations {
            *self.deviations.entry(id).or_default() += more;
        }
        self.read.extend(other.read);
        self.set.extend(other.set);
        for (sum, more) in self.limits.iter_mut().zip(other.limits) {
            sum.extend(more);
        }
        if other.longest > self.longest {
            self.longest = other.longest;
            self.longest_call = other.longest_call;
        }
    }
}

impl Tally {
    /// For docs/conformance.md, in TOML.
    pub fn figures(&self, scenarios: usize) -> String {
        let [ok, warning, discard, error] = self.statuses;
        let head = format!(
            "# Written by `cargo test --test fmi ten_million -- --ignored`.\ncalls = {}\nnested = {}\n\
             instances = {}\nscenarios = {scenarios}\nok = {}\ndiscard = {discard}\nerror = {error}\n\
             longest = {:.3}\n\n[deviations]\n",
            self.calls(),
            self.nested,
            self.instances,
            ok + warning,
            self.longest.as_secs_f64(),
        );
        let met = self.deviations.iter().map(|(id, number)| format!("{id} = {number}\n"));
        met.fold(head, |text, line| text + &line)
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [ok, warning, discard, error] = self.statuses;
        writeln!(formatter, "{} calls, {} of them within callbacks", self.calls(), self.nested)?;
        writeln!(formatter, "OK {ok}, Warning {warning}, Discard {discard}, Error {error}")?;
        writeln!(formatter, "longest call {:?}: {}", self.longest, self.longest_call)?;
        for (function, [done, refused]) in &self.functions {
            writeln!(formatter, "{function}: {done} done, {refused} refused")?;
        }
        for (id, number) in &self.deviations {
            writeln!(formatter, "{id}: {number}")?;
        }
        Ok(())
    }
}
