//! Hosts with a control word of their own.

use core::arch::asm;
use std::hint::black_box;

/// MXCSR as a program finds it: to nearest, all exceptions masked.
pub const DEFAULT: u32 = 0x1F80;
/// As Delphi, FreePascal and `gfortran -ffpe-trap=invalid,zero,overflow` set it.
pub const TRAPPING: u32 = DEFAULT & !(1 << 7 | 1 << 9 | 1 << 10);
pub const ENVIRONMENTS: [u32; 8] = [
    TRAPPING,
    // Every exception traps, the inexact result among them.
    0,
    // Down, up, towards zero.
    DEFAULT | 1 << 13,
    DEFAULT | 2 << 13,
    DEFAULT | 3 << 13,
    // Small results and operands are zero.
    DEFAULT | 1 << 15 | 1 << 6,
    // With flags that the host has raised itself, and will ask for.
    TRAPPING | 1 << 5,
    (DEFAULT | 1 << 13 | 0x3F) & !(1 << 7),
];

pub fn control_word() -> u32 {
    let mut word = 0;
    // SAFETY: room for four bytes.
    unsafe { asm!("stmxcsr [{}]", in(reg) &mut word) };
    word
}

fn set_control_word(word: u32) {
    // SAFETY: no reserved bit; `hosted` sets the default again before anything is computed.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &word) };
}

/// Sticky flags, which may be raised in the default environment.
const FLAGS: u32 = 0x3F;

/// Result of `call` in a host whose control word is `word`, which it has to be afterwards, too; to the last flag, if it
/// is not the default.
#[track_caller]
pub fn hosted<R>(word: u32, call: impl FnOnce() -> R) -> R {
    set_control_word(word);
    let result = black_box(call)();
    let left = if word == DEFAULT { control_word() & !FLAGS } else { control_word() };
    set_control_word(DEFAULT);
    assert_eq!(left, word, "{left:#x}, expected {word:#x}");
    result
}
