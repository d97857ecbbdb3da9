//! One instance and the random calls that are made on it.

use core::cell::{Cell, RefCell};
use core::ffi::c_void;
use core::ptr::null_mut;
use std::collections::VecDeque;
use std::time::Instant;

use super::super::harness::Standard;
use super::super::standard::Interface;
use super::answer::Answer;
use super::call::Call;
use super::callbacks::{clock_update, intermediate_update};
use super::dice::Dice;
use super::environment::{self, Host};
use super::generator::{Generator, SLOTS};
use super::log::Log;
use super::model::Model;
use super::oracle::{Oracle, Rule, Verdict};
use super::saved::{Handle, Kept};
use super::scenario::{Choices, Scenario, free, instantiate};
use super::tally::Tally;
use super::{calling_fmi2, calling_fmi3};

/// Lines of calls and results that a failure tells.
const TRACE: usize = 16;

pub struct Session {
    pub scenario: Scenario,
    pub choices: Choices,
    pub handle: *mut c_void,
    pub log: Box<Log>,
    pub model: RefCell<Model>,
    pub slots: RefCell<[Option<(Handle, Model)>; SLOTS]>,
    /// Bytes of saved states, of this instance and of others.
    pub kept: RefCell<Vec<Kept>>,
    pub tally: RefCell<Tally>,
    pub dice: RefCell<Dice>,
    /// Random numbers for what is unusual about the host, if anything is.
    moods: RefCell<Dice>,
    has_moods: bool,
    is_tame: bool,
    /// Whether a callback has reset or restored the instance.
    pub has_left: Cell<bool>,
    /// Serialised state as of the last call.
    pub present: RefCell<Vec<u8>>,
    /// What was called, and what came of it.
    trace: RefCell<VecDeque<String>>,
    /// What went wrong within a callback, to be told once the library has returned.
    pub failure: RefCell<Option<String>>,
    /// Time of the last callback, or begin, of the step in progress, and its end.
    pub step: Cell<(f64, f64)>,
    /// Memory for the present state.
    pub scratch: Cell<Handle>,
}

impl Session {
    /// An instance, and `count` calls on it; what was found.
    pub fn run(
        scenario: Scenario,
        seed: u64,
        count: usize,
        foreign: &[Kept],
        mood: Option<u64>,
    ) -> Result<(Tally, Vec<Kept>), String> {
        let mut dice = Dice::new(seed);
        let choices = Choices::new(&scenario, &mut dice);
        let held = environment::held();
        let session = Self::new(scenario, choices, dice, foreign, mood)?;
        if scenario.interface == Interface::CoSimulation
            && scenario.can("hasEventMode")
            && !session.choices.has_events
        {
            session.tally.borrow_mut().meet("clocks-without-events");
        }
        let outcome = session.while_current(|| session.calls(count));
        outcome.map_err(|what| session.report(&what))?;
        session.tally.borrow_mut().last = session.present.take();
        let own = session.kept.borrow().iter().skip(foreign.len()).take(1).cloned().collect();
        let tally = Tally { instances: 1, ..session.tally.take() };
        drop(session);
        match environment::held() - held {
            0 => Ok((tally, own)),
            leaked => Err(format!("{leaked} blocks of memory leak")),
        }
    }

    /// An instance on which nothing has been called; `mood` seeds what is unusual about the host.
    pub fn new(
        scenario: Scenario,
        choices: Choices,
        mut dice: Dice,
        foreign: &[Kept],
        mood: Option<u64>,
    ) -> Result<Self, String> {
        let log = Box::new(Log::new());
        let environment = core::ptr::from_ref(&*log).cast_mut().cast();
        let make = || instantiate(&scenario, &choices, environment, intermediate_update, clock_update);
        // Memory may be short: then there is none, and a message.
        let allocations = dice.percent(10).then(|| dice.below(3) as u64);
        let (mut handle, is_memory_short) = Host { allocations, control: None }.around(make);
        if is_memory_short {
            let is_told = !choices.has_logger || log.complaints() == 1;
            if !handle.is_null() || !is_told {
                return Err(format!("memory for {allocations:?} blocks makes {handle:?}: {}", log.text()));
            }
            handle = make();
        }
        if handle.is_null() {
            return Err(format!("not instantiated: {choices:?}: {}", log.text()));
        }
        let is_tame = dice.percent(50);
        Ok(Self {
            scenario,
            handle,
            log,
            model: RefCell::new(Model::new(scenario.sample_time())),
            slots: RefCell::default(),
            kept: RefCell::new(foreign.to_vec()),
            tally: RefCell::new(Tally::default()),
            dice: RefCell::new(dice),
            is_tame,
            moods: RefCell::new(Dice::new(mood.unwrap_or_default())),
            has_moods: mood.is_some(),
            has_left: Cell::new(false),
            present: RefCell::default(),
            trace: RefCell::default(),
            failure: RefCell::default(),
            step: Cell::default(),
            scratch: Cell::new(null_mut()),
            choices,
        })
    }

    fn calls(&self, count: usize) -> Result<(), String> {
        self.look()?;
        for _ in 0..count {
            self.act()?;
        }
        Ok(())
    }

    fn report(&self, what: &str) -> String {
        let trace: Vec<_> = self.trace.borrow().iter().cloned().collect();
        format!(
            "{what}\n{} {:?}\n{:?}\n{}",
            self.scenario.name(),
            self.choices,
            self.model.borrow(),
            trace.join("\n")
        )
    }

    /// A random call, and all checks after it.
    pub fn act(&self) -> Result<(), String> {
        let (call, verdict) = {
            let (model, mut dice) = (self.model.borrow(), self.dice.borrow_mut());
            let saved = |slot: usize| self.slots.borrow()[slot].as_ref().map(|(_, model)| model.clone());
            let oracle = Oracle { scenario: &self.scenario, choices: &self.choices, model: &model };
            let sources = self.kept.borrow().len();
            let mut generator =
                Generator { oracle, dice: &mut dice, is_tame: self.is_tame, sources, saved: &saved };
            let call = generator.call();
            let oracle = Oracle { scenario: &self.scenario, choices: &self.choices, model: &model };
            let verdict = oracle.judge(&call, &saved);
            let verdict = self.refine(&call, verdict);
            (call, verdict)
        };
        self.remember(format!("{:?}: {call:?}", self.model.borrow().state));
        self.log.clear();
        let host = self.host(&call);
        if host != Host::default() {
            self.remember(format!("    {host:?}"));
        }
        let begin = Instant::now();
        let (answer, is_memory_short) = host.around(|| self.send(&call));
        let duration = begin.elapsed();
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        self.remember(format!("    {} {:?} {}", answer.status, answer.values, self.log.text()));
        if self.has_left.take() {
            return self.come_back(&call, &answer);
        }
        if is_memory_short && answer.status == 3 {
            return self.check_state(&call, &answer);
        }
        self.check_status(&call, &verdict, &answer)?;
        if self.scenario.description.standard == Standard::Fmi3
            && !self.choices.logging_on
            && self.log.complaints() > 0
        {
            self.tally.borrow_mut().meet("errors-always-logged");
        }
        let is_beyond_the_list = match &call {
            Call::Get { .. } => self.scenario.interface == Interface::CoSimulation,
            Call::Partial { .. } | Call::GetSlopes { .. } => true,
            _ => false,
        };
        if answer.status == 2 && is_beyond_the_list && self.scenario.description.standard == Standard::Fmi2 {
            self.tally.borrow_mut().meet("discard-beyond-the-list");
        }
        self.tally.borrow_mut().count(self, &call, &verdict, &answer, duration);
        if answer.status == 0 {
            self.check_results(&call, &answer)?;
            self.follow(&call, &answer);
        } else if answer.status == 3 {
            self.model.borrow_mut().has_erred = true;
        }
        if !self.model.borrow().state.is_in_callback() {
            self.check_state(&call, &answer)?;
        }
        Ok(())
    }

    /// Makes a call.
    pub fn send(&self, call: &Call) -> Answer {
        if let Call::Step { point, size, .. } = call
            && !self.model.borrow().state.is_in_callback()
        {
            self.step.set((*point, point + size));
        }
        if call.is_about_states() {
            return self.send_about_states(call);
        }
        // SAFETY: the handle lives as long as the session, and so do log and session, which callbacks use.
        unsafe {
            match self.scenario.description.standard {
                Standard::Fmi2 => calling_fmi2::send(self.handle, call),
                Standard::Fmi3 => calling_fmi3::send(self.handle, call),
            }
        }
    }

    fn follow(&self, call: &Call, answer: &Answer) {
        let mut model = self.model.borrow_mut();
        if call.is_about_states() {
            self.follow_states(call, answer, &mut model);
        } else {
            model.follow(call, answer, &self.scenario, &self.choices);
        }
    }

    fn check_status(&self, call: &Call, verdict: &Verdict, answer: &Answer) -> Result<(), String> {
        let status = answer.status;
        let is_known = self.model.borrow().is_known;
        if is_known && !verdict.allows(status) {
            return Err(format!("{call:?} returns {status}, expected {verdict:?}: {}", self.log.text()));
        }
        if !(0..=3).contains(&status) {
            return Err(format!("{call:?} returns {status}: {}", self.log.text()));
        }
        if let Some(objection) = self.log.objection() {
            return Err(format!("the logger was called with {objection}"));
        }
        if self.choices.has_logger && !matches!(call, Call::Step { .. } | Call::Activate { .. }) {
            let complaints = self.log.complaints();
            let is_told = if status == 0 { complaints == 0 } else { self.log.last_status() == status };
            if !is_told || complaints > 1 {
                return Err(format!(
                    "{call:?} returns {status} and logs {complaints} messages: {}",
                    self.log.text()
                ));
            }
        }
        Ok(())
    }

    fn remember(&self, line: String) {
        let mut trace = self.trace.borrow_mut();
        if trace.len() == TRACE {
            trace.pop_front();
        }
        trace.push_back(line);
    }

    /// What is unusual about the host of the next call. Decided apart from the calls, which stay the same without it.
    fn host(&self, call: &Call) -> Host {
        let (mut dice, mut moods) = (self.dice.borrow_mut(), self.moods.borrow_mut());
        let asks_for_memory = matches!(call, Call::Save { .. } | Call::Deserialise { .. });
        let allocations = dice.percent(if asks_for_memory { 20 } else { 1 }).then_some(0);
        let is_moody = self.has_moods && !self.model.borrow().state.is_in_callback() && moods.percent(20);
        Host { allocations, control: is_moody.then(|| moods.pick(&environment::CONTROLS)) }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.free_states();
        // SAFETY: a live handle, freed once.
        unsafe { free(self.scenario.description.standard, self.handle) };
    }
}

/// What the standard says, for the tally.
pub fn deviations(verdict: &Verdict) -> &[&'static str] {
    match &verdict.rule {
        Rule::Tolerated(ids) => ids,
        Rule::Declined(id) => core::slice::from_ref(id),
        _ => &[],
    }
}
