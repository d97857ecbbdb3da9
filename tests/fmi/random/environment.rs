//! The host around a call: memory that runs out, floating-point exceptions that are trapped, another rounding.

use core::cell::Cell;

use crate::allocator::{blocks, has_failed, limit};

thread_local! {
    /// Blocks of memory that the library holds.
    static HELD: Cell<i64> = const { Cell::new(0) };
    /// The control word that the host has around the present call.
    static CONTROL: Cell<Option<u32>> = const { Cell::new(None) };
    /// What is unusual about the host in the next calls.
    static PLAN: Cell<Host> = const { Cell::new(Host { allocations: None, control: None }) };
}

/// What is unusual about the host during a call.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Host {
    /// Allocations that succeed before all others fail.
    pub allocations: Option<u64>,
    /// Control word of the floating-point unit (MXCSR on x86-64), where it is not the default.
    pub control: Option<u32>,
}

impl Host {
    /// Lets `act` make its calls in this environment; whether memory was short.
    pub fn around<T>(self, act: impl FnOnce() -> T) -> (T, bool) {
        let outer = PLAN.replace(self);
        has_failed();
        let result = act();
        PLAN.set(outer);
        (result, has_failed())
    }
}

/// A call into the library, with nothing around it that could allocate or calculate.
pub fn in_host<T>(call: impl FnOnce() -> T) -> T {
    let Host { allocations, control } = PLAN.get();
    let outer = CONTROL.replace(control);
    let usual = control_word();
    if let Some(control) = control {
        set_control_word(control);
    }
    let before = blocks();
    limit(allocations);
    let result = call();
    limit(None);
    HELD.set(HELD.get() + blocks() - before);
    let is_restored = is_same(control.unwrap_or(usual), control_word());
    set_control_word(usual);
    CONTROL.set(outer);
    assert!(is_restored, "the call has left another floating-point environment than it found");
    result
}

/// What an importer does in a callback: memory suffices, and nothing is trapped.
pub fn at_home<T>(act: impl FnOnce() -> T) -> T {
    let (allocations, control, word) = (limit(None), CONTROL.take(), control_word());
    set_control_word(DEFAULT_CONTROL);
    let before = blocks();
    let (result, _) = Host::default().around(act);
    // What the importer holds is not the library's; calls that it made have counted for themselves.
    HELD.set(HELD.get() - (blocks() - before));
    set_control_word(word);
    CONTROL.set(control);
    limit(allocations);
    result
}

/// Blocks of memory that the library holds on this thread.
pub fn held() -> i64 {
    HELD.get()
}

/// Whether a callback finds the floating-point environment of the call that it is made from.
pub fn is_that_of_the_host() -> bool {
    is_same(CONTROL.get().unwrap_or(DEFAULT_CONTROL), control_word())
}

/// Exception flags aside, which calculations set.
fn is_same(one: u32, other: u32) -> bool {
    one & !0x3f == other & !0x3f
}

/// Everything masked, to nearest.
pub const DEFAULT_CONTROL: u32 = 0x1f80;

/// Control words of unusual hosts: division by zero, overflow and invalid operations trapped as Delphi and gfortran
/// with -ffpe-trap do; rounding down, up, to zero; denormals flushed to zero.
pub const CONTROLS: [u32; 5] =
    [0x1f80 & !(0x80 | 0x200 | 0x400), 0x1f80 | 0x2000, 0x1f80 | 0x4000, 0x1f80 | 0x6000, 0x1f80 | 0x8040];

#[cfg(target_arch = "x86_64")]
fn control_word() -> u32 {
    let mut word = 0_u32;
    // SAFETY: stores the control word in a variable of four bytes.
    unsafe { core::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
    word
}

#[cfg(target_arch = "x86_64")]
fn set_control_word(word: u32) {
    // Without the flags, since a flag that is set would trap at once.
    let word = word & !0x3f;
    // SAFETY: no reserved bits are set; the code around computes nothing between this and the call it is made for.
    unsafe { core::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, preserves_flags)) };
}

#[cfg(not(target_arch = "x86_64"))]
fn control_word() -> u32 {
    DEFAULT_CONTROL
}

#[cfg(not(target_arch = "x86_64"))]
fn set_control_word(_: u32) {}
