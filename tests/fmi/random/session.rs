//! One instance and the random calls that are made on it.

use core::cell::{Cell, RefCell};
use core::ffi::c_void;
use core::ptr::null_mut;
use std::collections::VecDeque;
use std::time::Instant;

use super::super::harness::Standard;
use super::super::standard::{Interface, State};
use super::answer::Answer;
use super::call::Call;
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

thread_local! {
    /// The session whose callbacks are called on this thread.
    static CURRENT: Cell<*const Session> = const { Cell::new(core::ptr::null()) };
}

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
    has_left: Cell<bool>,
    /// Serialised state as of the last call.
    pub present: RefCell<Vec<u8>>,
    /// What was called, and what came of it.
    trace: RefCell<VecDeque<String>>,
    /// What went wrong within a callback, to be told once the library has returned.
    failure: RefCell<Option<String>>,
    /// Time of the last callback, or begin, of the step in progress, and its end.
    step: Cell<(f64, f64)>,
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
        CURRENT.set(&session);
        let outcome = session.calls(count);
        CURRENT.set(core::ptr::null());
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
    fn act(&self) -> Result<(), String> {
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

    /// A call whose callback has reset or restored the instance, which has no step to return to.
    fn come_back(&self, call: &Call, answer: &Answer) -> Result<(), String> {
        if answer.status != 3 {
            return Err(format!("{call:?} returns {} although the instance was taken away", answer.status));
        }
        self.model.borrow_mut().has_erred = true;
        self.look()
    }

    /// Random calls within a callback.
    fn call_back(&self, state: State) -> Option<f64> {
        let before = self.model.borrow().state;
        self.model.borrow_mut().state = state;
        self.model.borrow_mut().has_set = false;
        let count = self.dice.borrow_mut().below(4);
        for _ in 0..count {
            if let Err(failure) = self.act() {
                self.failure.borrow_mut().get_or_insert(failure);
                break;
            }
            if self.model.borrow().state != state {
                self.has_left.set(true);
                return None;
            }
        }
        self.model.borrow_mut().state = before;
        let mut dice = self.dice.borrow_mut();
        let (begin, end) = self.step.get();
        dice.percent(10).then(|| match dice.below(10) {
            0 => dice.odd(),
            1 => dice.wild(),
            _ => dice.between(begin, end),
        })
    }

    fn object(&self, what: String) {
        self.failure.borrow_mut().get_or_insert(what);
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.free_states();
        // SAFETY: a live handle, freed once.
        unsafe { free(self.scenario.description.standard, self.handle) };
    }
}

/// The session of this thread, if the environment is its own.
fn current(environment: *mut c_void, is_that_of_the_host: bool) -> Option<&'static Session> {
    // SAFETY: set while a session makes calls, and callbacks are made within calls only.
    let session = unsafe { CURRENT.get().as_ref() }?;
    if environment != core::ptr::from_ref(&*session.log).cast_mut().cast() {
        session.object("a callback with another environment".into());
    }
    if !is_that_of_the_host {
        session.object("a callback in another floating-point environment than that of the host".into());
    }
    Some(session)
}

unsafe extern "C-unwind" fn intermediate_update(
    environment: *mut c_void,
    time: f64,
    _: u8,
    _: u8,
    _: u8,
    may_return_early: u8,
    early_return_requested: *mut u8,
    early_return_time: *mut f64,
) {
    let is_that_of_the_host = environment::is_that_of_the_host();
    environment::at_home(|| {
        let Some(session) = current(environment, is_that_of_the_host) else { return };
        let (last, end) = session.step.get();
        if !(time >= last && time <= end) {
            session.object(format!("a callback at {time}, after {last} and before {end}"));
        }
        if (may_return_early != 0) != session.choices.may_return_early {
            session.object("a callback that promises another early return than was agreed upon".into());
        }
        session.step.set((time, end));
        session.model.borrow_mut().time = time;
        if let Some(asked) = session.call_back(State::Intermediate) {
            // SAFETY: both results are writable.
            unsafe {
                early_return_requested.write(1);
                early_return_time.write(asked);
            }
        }
    });
}

unsafe extern "C-unwind" fn clock_update(environment: *mut c_void) {
    let is_that_of_the_host = environment::is_that_of_the_host();
    environment::at_home(|| {
        if let Some(session) = current(environment, is_that_of_the_host) {
            session.call_back(State::Update);
        }
    });
}

/// What the standard says, for the tally.
pub fn deviations(verdict: &Verdict) -> &[&'static str] {
    match &verdict.rule {
        Rule::Tolerated(ids) => ids,
        Rule::Declined(id) => core::slice::from_ref(id),
        _ => &[],
    }
}
