//! Callbacks of the library: random calls within them.

use core::cell::Cell;
use core::ffi::c_void;

use super::super::standard::State;
use super::answer::Answer;
use super::call::Call;
use super::environment;
use super::session::Session;

thread_local! {
    /// The session whose callbacks are called on this thread.
    static CURRENT: Cell<*const Session> = const { Cell::new(core::ptr::null()) };
}

impl Session {
    /// Runs `act` with the callbacks of this thread led to this session.
    pub fn while_current<T>(&self, act: impl FnOnce() -> T) -> T {
        CURRENT.set(self);
        let result = act();
        CURRENT.set(core::ptr::null());
        result
    }

    /// A call whose callback has reset or restored the instance, which has no step to return to.
    pub fn come_back(&self, call: &Call, answer: &Answer) -> Result<(), String> {
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

pub unsafe extern "C-unwind" fn intermediate_update(
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

pub unsafe extern "C-unwind" fn clock_update(environment: *mut c_void) {
    let is_that_of_the_host = environment::is_that_of_the_host();
    environment::at_home(|| {
        if let Some(session) = current(environment, is_that_of_the_host) {
            session.call_back(State::Update);
        }
    });
}
