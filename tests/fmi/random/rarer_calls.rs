//! Calls about what moves in continuous time, saved states, status and clocks.

use super::super::harness::Standard;
use super::super::standard::{Causality, Kind, Variable};
use super::call::{Call, Damage};
use super::generator::{Generator, SLOTS};
use super::values;

impl Generator<'_> {
    pub fn set_states(&mut self) -> Call {
        let states = self.description().variables.iter().filter(|variable| variable.is_state);
        let mut states: Vec<f64> = states
            .map(|_| match self.dice.below(20) {
                0 => self.dice.odd(),
                1 => self.dice.wild(),
                2..=9 => self.dice.between(-1e-2, 1e-2),
                _ => self.dice.between(-1.0, 1.0),
            })
            .collect();
        if self.dice.percent(4) {
            states.push(0.0);
        }
        Call::SetStates { states, is_null: self.dice.percent(2) }
    }

    pub fn vector(&mut self) -> Call {
        let is_fmi2 = self.standard() == Standard::Fmi2;
        let names = [
            if is_fmi2 { "GetDerivatives" } else { "GetContinuousStateDerivatives" },
            "GetEventIndicators",
            "GetContinuousStates",
            "GetNominalsOfContinuousStates",
        ];
        let name = self.dice.pick(&names);
        let description = self.description();
        let is_of_indicators = name == "GetEventIndicators";
        let length =
            if is_of_indicators { description.event_indicator_count } else { description.state_count };
        let length = if self.dice.percent(4) { length + 1 } else { length };
        Call::GetVector { function: self.named(name), length, is_null: self.dice.percent(2) }
    }

    pub fn partial(&mut self) -> Call {
        let is_adjoint = self.standard() == Standard::Fmi3 && self.dice.percent(50);
        let name = if is_adjoint { "GetAdjointDerivative" } else { "GetDirectionalDerivative" };
        let unknowns = self.references(3, |v| v.is_initial_unknown && v.kind == Kind::Real);
        let knowns = self.references(3, |v| {
            v.kind == Kind::Real
                && (v.is_state
                    || matches!(
                        v.causality,
                        Causality::Input | Causality::Parameter | Causality::Independent
                    ))
        });
        let count = if is_adjoint { unknowns.len() } else { knowns.len() };
        let count = if self.standard() == Standard::Fmi3 { self.room(count) } else { count };
        let seed = (0..count)
            .map(|_| if self.dice.percent(3) { self.dice.odd() } else { self.dice.between(-1.0, 1.0) });
        let seed = seed.collect();
        Call::Partial { function: self.named(name), unknowns, knowns, seed }
    }

    pub fn slopes(&mut self) -> Call {
        if self.standard() == Standard::Fmi2 && self.dice.percent(60) {
            let references = self.references(2, |variable| variable.causality == Causality::Input);
            let values = references.iter().map(|_| values::slope(self.dice)).collect();
            let orders =
                references.iter().map(|_| if self.dice.percent(5) { self.dice.below(4) as i32 } else { 1 });
            let orders = orders.collect();
            return Call::SetSlopes { references, orders, values };
        }
        let references = self
            .references(3, |variable| variable.causality == Causality::Output && variable.kind == Kind::Real);
        let orders =
            references.iter().map(|_| if self.dice.percent(5) { self.dice.below(4) as i32 - 1 } else { 1 });
        let orders = orders.collect();
        Call::GetSlopes { references, orders }
    }

    pub fn saving(&mut self) -> Call {
        let slot = self.dice.below(SLOTS);
        match self.dice.below(20) {
            0..=5 => Call::Save { slot },
            6..=10 => Call::Restore { slot },
            11 => Call::Free { slot },
            12 => Call::Size { slot },
            13..=15 => Call::Serialise {
                slot,
                shortage: if self.dice.percent(20) { 1 + self.dice.below(60) } else { 0 },
            },
            _ if self.sources == 0 => Call::Save { slot },
            _ => {
                let damage = match self.dice.below(10) {
                    0..=4 => Damage::None,
                    5..=6 => Damage::Flip { bit: self.dice.below(4096 * 8) },
                    7 => Damage::Cut { length: self.dice.below(4096) },
                    _ => Damage::Forge { place: self.dice.below(4096), value: self.dice.below(256) as u8 },
                };
                Call::Deserialise { slot, source: self.dice.below(self.sources), damage }
            }
        }
    }

    pub fn only_fmi2(&mut self) -> Call {
        if self.dice.percent(10) {
            return self.plain("CancelStep");
        }
        if self.dice.percent(30) {
            return Call::CompletedStep { is_null: self.dice.percent(5) };
        }
        let functions = [
            "fmi2GetStatus",
            "fmi2GetRealStatus",
            "fmi2GetIntegerStatus",
            "fmi2GetBooleanStatus",
            "fmi2GetStringStatus",
        ];
        let function = self.dice.pick(&functions);
        Call::Status { function, kind: self.dice.below(6) as i32 - 1 }
    }

    pub fn only_fmi3(&mut self) -> Call {
        let is_input_clock = |v: &Variable| v.kind == Kind::Clock && v.causality == Causality::Input;
        match self.dice.below(24) {
            0..=8 => {
                let clock = self.references(1, is_input_clock).first().copied().unwrap_or(0);
                let model = self.oracle.model;
                let time = match self.dice.below(10) {
                    0..=6 => model.time + model.sample_time.min(1.0),
                    _ => self.time(),
                };
                Call::Activate { clock, time }
            }
            9..=10 => Call::GetClocks { references: self.references(2, |v| v.kind == Kind::Clock) },
            11..=13 => {
                let references = self.references(2, is_input_clock);
                let values = references.iter().map(|_| u8::from(self.dice.percent(75))).collect();
                Call::SetClocks { references, values }
            }
            14..=16 => {
                let names = ["GetInterval", "GetShift", "GetInterval", "GetShift", "SetInterval", "SetShift"];
                let name = format!("{}{}", self.dice.pick(&names), self.dice.pick(&["Decimal", "Fraction"]));
                Call::Timing { function: self.named(&name), references: self.references(2, is_input_clock) }
            }
            17 => {
                let name = self.dice.pick(&["GetNumberOfEventIndicators", "GetNumberOfContinuousStates"]);
                Call::Count(self.named(name))
            }
            18 => {
                let name = self.dice.pick(&["GetNumberOfVariableDependencies", "GetVariableDependencies"]);
                Call::Dependencies(self.named(name))
            }
            19 => {
                let name = self.dice.pick(&["EnterConfigurationMode", "ExitConfigurationMode"]);
                self.plain(name)
            }
            20 => self.plain("EvaluateDiscreteStates"),
            _ => Call::CompletedStep { is_null: self.dice.percent(5) },
        }
    }
}
