//! The floating-point environment: the host's outside, that of IEEE 754 inside.
//!
//! Some hosts let division by zero, overflow or invalid operations trap, or round otherwise than to nearest, or flush
//! small numbers to zero. The models compute as everybody does: an infinity that is dropped later is no error, and the
//! same bits come out in every host. Both standards allow to change the control word of the thread as long as it is
//! restored before a function returns and before it calls back (FMI 2.0.5, section 2.1; FMI 3.0.2, section 2.2.1).
//!
//! The sticky flags are restored along with it: a host with an environment of its own, asking later which exceptions its
//! computations raised, finds no others ("clear the floating point status word before return", FMI 2.0.5). In the
//! default environment flags stay raised, as they do after any function of a mathematical library.
//!
//! Reading the word costs some nanoseconds, as long as getting or setting a variable. Calls that only copy numbers therefore compute
//! nothing, not even a comparison of them, and leave the word alone.

use core::hint::black_box;

/// The host's word, in force again when this is dropped.
struct Host(word::Word);

impl Drop for Host {
    #[inline]
    fn drop(&mut self) {
        if !word::is_default(self.0) {
            word::write(self.0);
        }
    }
}

/// Runs `body` in the default environment, and gives the host its own one back.
#[inline]
pub(super) fn in_default_environment<R>(body: impl FnOnce() -> R) -> R {
    let host = Host(word::read());
    let body = if word::is_default(host.0) {
        body
    } else {
        word::write(word::DEFAULT);
        // The compiler knows nothing of the word and might compute with the arguments, or with constants, before it is
        // set; what it has to read from memory that somebody may have changed is not known earlier.
        black_box(body)
    };
    body()
}

/// MXCSR. The older x87 unit with its own word is used by nobody on this architecture.
#[cfg(target_arch = "x86_64")]
mod word {
    use core::arch::asm;

    pub(super) type Word = u32;

    /// Round to nearest, all exceptions masked, no number flushed to zero, no flag raised.
    pub(super) const DEFAULT: Word = 0x1F80;
    /// Sticky flags.
    const FLAGS: Word = 0x3F;

    #[inline]
    pub(super) fn is_default(word: Word) -> bool {
        word & !FLAGS == DEFAULT
    }

    #[inline]
    pub(super) fn read() -> Word {
        let mut word = 0;
        // SAFETY: writes four bytes to where there is room for them.
        unsafe { asm!("stmxcsr [{}]", in(reg) &mut word, options(nostack, preserves_flags)) };
        word
    }

    #[inline]
    pub(super) fn write(word: Word) {
        // SAFETY: reads four bytes; the word is the default, which is what Rust code relies on, or the host's, which
        // was read above, has no reserved bit set and is in force again when the host goes on.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &word, options(nostack)) };
    }
}

/// FPCR with the control bits and, in the upper half, FPSR with the sticky flags.
#[cfg(target_arch = "aarch64")]
mod word {
    use core::arch::asm;

    pub(super) type Word = (u64, u64);

    /// Round to nearest, no traps, no number flushed to zero, no flag raised.
    pub(super) const DEFAULT: Word = (0, 0);

    #[inline]
    pub(super) fn is_default((control, _): Word) -> bool {
        control == DEFAULT.0
    }

    #[inline]
    pub(super) fn read() -> Word {
        let (control, status);
        // SAFETY: reads two registers that every program may read.
        unsafe {
            asm!("mrs {}, fpcr", out(reg) control, options(nostack, preserves_flags));
            asm!("mrs {}, fpsr", out(reg) status, options(nostack, preserves_flags));
        }
        (control, status)
    }

    #[inline]
    pub(super) fn write((control, status): Word) {
        // SAFETY: the words are the defaults, which are what Rust code relies on, or the host's, which were read above
        // and are in force again when the host goes on.
        unsafe {
            asm!("msr fpcr, {}", in(reg) control, options(nostack));
            asm!("msr fpsr, {}", in(reg) status, options(nostack));
        }
    }
}

/// WebAssembly has but one environment; other architectures are not shipped.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod word {
    pub(super) type Word = u8;

    pub(super) const DEFAULT: Word = 0;

    pub(super) fn is_default(word: Word) -> bool {
        word == DEFAULT
    }

    pub(super) fn read() -> Word {
        DEFAULT
    }

    pub(super) fn write(_: Word) {}
}
