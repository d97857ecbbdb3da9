//! The allocator of this test program, which can be told to fail, and counts.

use core::cell::Cell;
use core::ptr::null_mut;
use std::alloc::{GlobalAlloc, Layout, System};

thread_local! {
    /// Allocations that still succeed on this thread; `None` if all do.
    static LEFT: Cell<Option<u64>> = const { Cell::new(None) };
    /// Whether one has failed since [`has_failed`] was asked.
    static HAS_FAILED: Cell<bool> = const { Cell::new(false) };
    /// Allocations, reallocations and releases of this thread.
    static USES: Cell<u64> = const { Cell::new(0) };
    /// Blocks that this thread holds.
    static BLOCKS: Cell<i64> = const { Cell::new(0) };
}

/// The system's allocator, unless it is told to fail.
struct Failing;

impl Failing {
    fn is_exhausted() -> bool {
        USES.set(USES.get() + 1);
        match LEFT.get() {
            None => false,
            Some(left) => {
                LEFT.set(Some(left.saturating_sub(1)));
                if left == 0 {
                    HAS_FAILED.set(true);
                }
                left == 0
            }
        }
    }
}

fn count(block: *mut u8) -> *mut u8 {
    BLOCKS.set(BLOCKS.get() + i64::from(!block.is_null()));
    block
}

// SAFETY: hands every call on to the system's allocator or answers that there is no memory.
unsafe impl GlobalAlloc for Failing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        if Self::is_exhausted() { null_mut() } else { count(unsafe { System.alloc(layout) }) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        if Self::is_exhausted() { null_mut() } else { count(unsafe { System.alloc_zeroed(layout) }) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise.
        if Self::is_exhausted() { null_mut() } else { unsafe { System.realloc(block, layout, size) } }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        USES.set(USES.get() + 1);
        BLOCKS.set(BLOCKS.get() - 1);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Failing = Failing;

/// Blocks that this thread holds.
pub fn blocks() -> i64 {
    BLOCKS.get()
}

/// Uses of the heap on this thread while `action` runs.
pub fn uses_of_the_heap(action: impl FnOnce()) -> u64 {
    let before = USES.get();
    action();
    USES.get() - before
}

/// Lets so many allocations succeed from now on, or all; what was set before.
pub fn limit(allocations: Option<u64>) -> Option<u64> {
    LEFT.replace(allocations)
}

/// Whether an allocation has failed since this was asked last.
pub fn has_failed() -> bool {
    HAS_FAILED.take()
}

/// Result of `call` while only so many allocations succeed.
pub fn with_memory_for<R>(allocations: u64, call: impl FnOnce() -> R) -> R {
    LEFT.set(Some(allocations));
    let result = call();
    LEFT.set(None);
    result
}
