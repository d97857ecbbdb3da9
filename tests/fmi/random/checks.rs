//! What has to hold after every call, whatever it was.

use super::super::standard::State;
use super::answer::Answer;
use super::call::Call;
use super::dice::Dice;
use super::session::Session;

impl Session {
    /// Results of a call that returned OK.
    pub fn check_results(&self, call: &Call, answer: &Answer) -> Result<(), String> {
        if !answer.values.iter().all(|value| value.is_finite()) {
            return Err(format!("{call:?} results in {:?}", answer.values));
        }
        let description = self.scenario.description;
        match call {
            Call::Step { point, size, .. } => self.check_step(call, *point + *size, answer)?,
            Call::Activate { time, .. } => self.check_time(call, *time)?,
            Call::Count(function) => {
                let is_of_states = function.ends_with("ContinuousStates");
                let expected =
                    if is_of_states { description.state_count } else { description.event_indicator_count };
                if answer.values != [expected as f64] {
                    return Err(format!("{call:?} results in {:?}", answer.values));
                }
            }
            Call::GetVector { function, .. }
                if function.contains("Nominals") && answer.values.iter().any(|nominal| *nominal <= 0.0) =>
            {
                return Err(format!("nominal values {:?}", answer.values));
            }
            Call::GetClocks { .. } if answer.active.iter().any(|active| *active > 1) => {
                return Err(format!("{call:?} results in {:?}", answer.active));
            }
            _ => {}
        }
        Ok(())
    }

    fn check_step(&self, call: &Call, end: f64, answer: &Answer) -> Result<(), String> {
        let Answer { reached, is_event, is_early, .. } = *answer;
        let before = self.model.borrow().clone();
        let is_expected = (is_early || reached == end)
            && (!is_early || (self.choices.may_return_early && reached < end))
            && (!is_event || self.choices.has_events)
            // Rounding of the importer may take time back by a few units in the last place.
            && (!before.is_known || reached >= before.time - 1e-9 * before.time.abs().max(end - before.time));
        if !is_expected {
            return Err(format!(
                "{call:?} ends at {reached}, event {is_event}, early {is_early}, after {}",
                before.time
            ));
        }
        self.check_time(call, reached)
    }

    /// The variable `time` says where the instance stands.
    fn check_time(&self, call: &Call, expected: f64) -> Result<(), String> {
        let (status, values) = self.read(&[0]);
        if status == 0 && values == [expected] {
            return Ok(());
        }
        // Something else that follows from the inputs may not be computable.
        Err(format!("time is {values:?} after {call:?}, status {status}"))
    }

    /// Real variables, read aside from the calls that are made.
    fn read(&self, references: &[u32]) -> (i32, Vec<f64>) {
        let function = if self.is_fmi2() { "fmi2GetReal" } else { "fmi3GetFloat64" };
        let (references, room) = (references.to_vec(), references.len());
        let answer = self.send(&Call::Get { function, references, room, is_null: false });
        self.log.clear();
        (answer.status, answer.values)
    }

    /// The state as bytes; every state can be saved.
    fn serialised(&self) -> Result<Vec<u8>, String> {
        let (mut state, mut size) = (self.scratch.get(), 0);
        let status = self.get_state(&mut state);
        self.scratch.set(state);
        if status != 0 {
            return Err(format!("a state that cannot be saved: {}", self.log.text()));
        }
        let mut statuses = [self.size(state, &mut size), 0];
        let mut bytes = vec![0; size];
        statuses[1] = self.serialise(state, &mut bytes);
        if statuses == [0; 2] {
            Ok(bytes)
        } else {
            Err(format!("{statuses:?} at serialising: {}", self.log.text()))
        }
    }

    /// What was refused has changed nothing; what is there can be saved and restored, and all values are finite.
    pub fn check_state(&self, call: &Call, answer: &Answer) -> Result<(), String> {
        let now = self.serialised()?;
        let before = self.present.replace(now.clone());
        // Memory of earlier results may be brought up to date by a call that is refused later.
        if answer.status != 0
            && now != before
            && self.brought_up_to_date(&now)? != self.brought_up_to_date(&before)?
        {
            return Err(format!("{call:?} is refused with {}, and yet the state has changed", answer.status));
        }
        let (saves, reads) = {
            let mut dice = self.dice.borrow_mut();
            (dice.percent(12), dice.percent(25))
        };
        if saves {
            let mut state = core::ptr::null_mut();
            if self.deserialise(&now, &mut state) != 0 {
                return Err(format!("the state after {call:?} cannot be restored: {}", self.log.text()));
            }
            assert_eq!(self.free_state(&mut state), 0);
        }
        if reads { self.check_values(call) } else { Ok(()) }
    }

    fn check_values(&self, call: &Call) -> Result<(), String> {
        let model = self.model.borrow().clone();
        if self.is_fmi2() && model.state == State::Instantiated {
            return Ok(());
        }
        let (status, values) = self.read(&self.reals());
        let is_initial = matches!(model.state, State::Instantiated | State::Initialization);
        match status {
            0 if values.iter().all(|value| value.is_finite()) => Ok(()),
            2 => Ok(()),
            3 if !model.is_known || (is_initial && model.may_be_refused()) => Ok(()),
            _ => Err(format!("values after {call:?}: status {status}, {values:?}")),
        }
    }

    /// References of all real variables.
    pub fn reals(&self) -> Vec<u32> {
        use super::super::standard::Kind;
        let variables = self.scenario.description.variables.iter();
        variables.filter(|variable| variable.kind == Kind::Real).map(|variable| variable.reference).collect()
    }

    /// A state in which everything has been computed that follows at its instant.
    fn brought_up_to_date(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let twin = Self::new(self.scenario, self.choices.clone(), Dice::new(0), &[], None)?;
        twin.log.clear();
        let mut state = core::ptr::null_mut();
        if bytes.is_empty() || twin.deserialise(bytes, &mut state) != 0 || twin.set_state(state) != 0 {
            // Not to be restored: nothing can be said about it.
            twin.free_state(&mut state);
            return Ok(Vec::new());
        }
        assert_eq!(twin.free_state(&mut state), 0);
        twin.read(&twin.reals());
        twin.serialised()
    }

    /// As found at the beginning.
    pub fn look(&self) -> Result<(), String> {
        self.present.replace(self.serialised()?);
        Ok(())
    }
}
