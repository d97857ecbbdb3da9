//! Which call comes next.

use super::super::harness::Standard;
use super::super::standard::{Causality, Kind, ModelDescription, State, Table, Variable};
use super::call::{Call, Category, Experiment};
use super::dice::Dice;
use super::model::Model;
use super::oracle::{Oracle, Rule};
use super::values;

/// Places for saved states.
pub const SLOTS: usize = 3;

pub struct Generator<'a> {
    pub oracle: Oracle<'a>,
    pub dice: &'a mut Dice,
    /// Whether parameters stay near their start values.
    pub is_tame: bool,
    /// Bytes of states that can be deserialised.
    pub sources: usize,
    pub saved: &'a dyn Fn(usize) -> Option<Model>,
}

impl Generator<'_> {
    /// A call, mostly one that is allowed now.
    pub fn call(&mut self) -> Call {
        let is_wild = self.dice.percent(12);
        for _ in 0..12 {
            let call = self.any();
            if is_wild || !matches!(self.oracle.judge(&call, self.saved).rule, Rule::Forbidden(_)) {
                return call;
            }
        }
        self.any()
    }

    fn any(&mut self) -> Call {
        let is_fmi2 = self.standard() == Standard::Fmi2;
        match self.dice.below(100) {
            0..=3 if is_fmi2 && self.dice.percent(45) => Call::Setup(self.experiment()),
            0..=3 => Call::EnterInitialization(self.experiment()),
            4..=5 => self.plain("ExitInitializationMode"),
            6 => match self.dice.below(20) {
                0..=4 => self.plain("Terminate"),
                5..=8 => self.plain("Reset"),
                _ => self.logging(),
            },
            7..=20 => self.step(),
            21..=36 => self.set(),
            37..=45 => self.get(),
            46..=49 => Call::UpdateDiscreteStates { is_null: self.dice.percent(5) },
            50..=52 => self.plain("EnterEventMode"),
            53..=55 if is_fmi2 => self.plain("EnterContinuousTimeMode"),
            53..=55 => {
                let name = self.dice.pick(&["EnterContinuousTimeMode", "EnterStepMode"]);
                self.plain(name)
            }
            56..=59 => Call::SetTime(self.time()),
            60..=64 => self.set_states(),
            65..=69 => self.vector(),
            70..=73 => self.partial(),
            74..=77 => self.slopes(),
            78..=87 => self.saving(),
            _ if is_fmi2 => self.only_fmi2(),
            _ => self.only_fmi3(),
        }
    }

    pub fn standard(&self) -> Standard {
        self.oracle.standard()
    }

    pub fn description(&self) -> &'static ModelDescription {
        self.oracle.scenario.description
    }

    /// The function of the table that is called so in this standard.
    pub fn named(&self, name: &str) -> &'static str {
        let rows = Table::of(self.standard()).rows();
        &rows.iter().find(|row| &row.function[4..] == name).unwrap_or_else(|| panic!("{name}")).function
    }

    pub fn plain(&self, name: &str) -> Call {
        Call::Plain(self.named(name))
    }

    fn logging(&mut self) -> Call {
        let count = self.dice.below(3);
        let categories = (0..count).map(|_| {
            self.dice.pick(&[
                Category::Declared(c"logStatusError"),
                Category::Declared(c"logEvents"),
                Category::Declared(c"logObserver"),
                Category::Unknown,
                Category::Null,
            ])
        });
        let categories = categories.collect();
        Call::Logging { on: self.dice.percent(70), categories, is_null: self.dice.percent(3) }
    }

    fn experiment(&mut self) -> Experiment {
        let start = match self.dice.below(20) {
            0..=14 => 0.0,
            15 => 0.000_25,
            16 => self.dice.pick(&[1.0, -2.5, 1e9, 1e-300, -1e6]),
            17 => self.dice.odd(),
            18 => self.dice.wild(),
            _ => self.dice.between(-10.0, 10.0),
        };
        let stop = self.dice.percent(50).then(|| match self.dice.below(10) {
            0..=4 => start + self.dice.between(0.0, 0.05),
            5..=7 => start + 1e4,
            8 => start,
            _ => self.dice.odd(),
        });
        Experiment { start, stop, tolerance: self.dice.percent(50).then(|| self.dice.unit()) }
    }

    /// Where the instance stands, or near that, or nowhere.
    pub fn time(&mut self) -> f64 {
        let now = self.oracle.model.time;
        match self.dice.below(20) {
            0..=11 => now + self.dice.between(0.0, 1e-3),
            12..=13 => now,
            14 => now - self.dice.between(0.0, 1e-3),
            15 => self.oracle.model.stop.unwrap_or(now),
            16 => now.next_up(),
            17 => now + self.dice.wild(),
            18 => self.dice.odd(),
            _ => self.oracle.model.start,
        }
    }

    fn step(&mut self) -> Call {
        let model = self.oracle.model;
        // Few ticks, and no long step of a plant: the amount of work is for other tests.
        let unit = if model.is_known { model.sample_time.min(1e-3) } else { 1e-6 };
        let size = match self.dice.below(40) {
            0..=13 => unit,
            14..=27 => unit * self.dice.between(0.01, 3.5),
            28..=30 => unit * self.dice.pick(&[1e-6, 0.25, 5.0, 1.0 + 1e-12, 1.0 - 1e-13]),
            31..=32 => model.stop.map_or(unit, |stop| (stop - model.time).min(20.0 * unit)),
            33 => unit * 30.0,
            34 => self.dice.pick(&[0.0, -1e-3, 5e-324]),
            35 => self.dice.odd(),
            36 => self.dice.pick(&[1e12, 1e18, 1e300]),
            _ => unit,
        };
        let point = match self.dice.below(40) {
            0..=33 => model.time,
            34 => model.time.next_up(),
            35 => model.time + 1e-13 * size,
            36 => model.time + 0.01 * size,
            37 => model.time - size,
            _ => self.time(),
        };
        Call::Step { point, size, is_final: self.dice.percent(50) }
    }

    /// References, mostly of variables that suit.
    pub fn references(&mut self, most: usize, suits: impl Fn(&Variable) -> bool) -> Vec<u32> {
        let variables = &self.description().variables;
        let suitable: Vec<u32> =
            variables.iter().filter(|variable| suits(variable)).map(|variable| variable.reference).collect();
        let count = if self.dice.percent(4) { 0 } else { 1 + self.dice.below(most) };
        let mut one = || match self.dice.below(100) {
            0 => self.dice.below(1 << 32) as u32,
            1 => variables.len() as u32,
            2..=4 => self.dice.below(variables.len()) as u32,
            _ if suitable.is_empty() => self.dice.below(variables.len()) as u32,
            _ => self.dice.pick(&suitable),
        };
        (0..count).map(|_| one()).collect()
    }

    fn accessor(&mut self, verb: &str, kind: Kind) -> &'static str {
        let is_fmi2 = self.standard() == Standard::Fmi2;
        if self.dice.percent(4) {
            let rows = Table::of(self.standard()).rows();
            let is_accessor = |name: &str| {
                let types = ["Float", "Int", "UInt", "Boolean", "String", "Binary", "Real", "Integer"];
                name.strip_prefix(verb).is_some_and(|rest| {
                    types.iter().any(|kind| {
                        rest.strip_prefix(kind).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
                    })
                })
            };
            let all: Vec<_> = rows.iter().filter(|row| is_accessor(&row.function[4..])).collect();
            return &self.dice.pick(&all).function;
        }
        let name = match kind {
            Kind::Real if is_fmi2 => "Real",
            Kind::Real => "Float64",
            Kind::Integer | Kind::Enumeration if is_fmi2 => "Integer",
            Kind::Integer => "Int32",
            Kind::Enumeration => "Int64",
            Kind::Boolean | Kind::Clock => "Boolean",
        };
        self.named(&format!("{verb}{name}"))
    }

    /// The kind of a variable that suits, so that frequent kinds are frequent.
    fn kind(&mut self, suits: impl Fn(&Variable) -> bool) -> Kind {
        let of = self.references(1, suits);
        of.first()
            .and_then(|reference| self.description().find(*reference))
            .map_or(Kind::Real, |found| found.kind)
    }

    pub fn room(&mut self, count: usize) -> usize {
        // FMI 2.0 has one number for both.
        if self.standard() == Standard::Fmi3 && self.dice.percent(2) {
            count + 1 - 2 * self.dice.below(2).min(count)
        } else {
            count
        }
    }

    fn get(&mut self) -> Call {
        let kind = self.kind(|_| true);
        let function = self.accessor("Get", kind);
        let references = match self.dice.percent(30) {
            true => {
                let all = self.description().variables.iter().filter(|variable| variable.kind == kind);
                all.map(|variable| variable.reference).collect()
            }
            false => self.references(6, |variable| variable.kind == kind),
        };
        let room = self.room(references.len());
        Call::Get { function, references, room, is_null: self.dice.percent(2) }
    }

    fn set(&mut self) -> Call {
        let (state, is_tame) = (self.oracle.model.state, self.is_tame);
        let is_running = !matches!(state, State::Instantiated | State::Initialization);
        let suits = move |variable: &Variable| match variable.causality {
            Causality::Input => true,
            Causality::Parameter => !is_tame || !is_running,
            _ => variable.is_state,
        };
        let kind = self.kind(suits);
        let function = self.accessor("Set", kind);
        let at_limits = !is_tame && self.dice.percent(35);
        let most = if at_limits { 8 } else { 5 };
        let references = self.references(most, move |variable| suits(variable) && variable.kind == kind);
        let values = references.iter().map(|reference| match self.description().find(*reference) {
            Some(variable) if at_limits => values::limit(variable, self.dice),
            Some(variable) => values::of(variable, self.dice, is_tame),
            None => self.dice.wild(),
        });
        let values = values.collect();
        let room = self.room(references.len());
        Call::Set { function, references, values, room, is_null: self.dice.percent(2) }
    }
}
