//! FMI 3.0: clocks.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output};
use crate::fmi::fraction::fraction;
use crate::fmi::{CallError, Instance};

/// # Safety
/// A live handle, used by one thread at a time; both arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetClock(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    values: *mut fmi3Clock,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::GET_CLOCK, |instance| {
            let references = input(references, count, "valueReferences")?;
            instance.get_clocks(references, output(values, count, "values")?)
        })
    }
}

/// # Safety
/// A live handle, used by one thread at a time; both arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetClock(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    values: *const fmi3Clock,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::SET_CLOCK, |instance| {
            let references = input(references, count, "valueReferences")?;
            instance.set_clocks(references, input(values, count, "values")?)
        })
    }
}

/// Intervals \[s\] of input clocks: the sample time, fixed once initialisation is over.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetIntervalDecimal(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    intervals: *mut fmi3Float64,
    qualifiers: *mut fmi3IntervalQualifier,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::GET_INTERVAL_DECIMAL, |instance| {
            let references = input(references, count, "valueReferences")?;
            let intervals = output(intervals, count, "intervals")?;
            let qualifiers = output(qualifiers, count, "qualifiers")?;
            require_clocks(instance, references)?;
            for (index, reference) in references.iter().enumerate() {
                intervals[index] = instance.timing(*reference)?.interval;
                qualifiers[index] = interval_qualifier(instance, intervals[index]);
            }
            Ok(())
        })
    }
}

/// Intervals as fractions of a second, exactly the sample time.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetIntervalFraction(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    counters: *mut u64,
    resolutions: *mut u64,
    qualifiers: *mut fmi3IntervalQualifier,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::GET_INTERVAL_FRACTION, |instance| {
            let references = input(references, count, "valueReferences")?;
            let counters = output(counters, count, "counters")?;
            let resolutions = output(resolutions, count, "resolutions")?;
            let qualifiers = output(qualifiers, count, "qualifiers")?;
            require_clocks(instance, references)?;
            for (index, reference) in references.iter().enumerate() {
                let interval = instance.timing(*reference)?.interval;
                (counters[index], resolutions[index]) =
                    fraction(interval).ok_or(CallError::NoFraction { name: "interval", value: interval })?;
                qualifiers[index] = interval_qualifier(instance, interval);
            }
            Ok(())
        })
    }
}

/// Times \[s\] from the start to the first tick of input clocks: ticks are at multiples of the sample time, whenever
/// the experiment starts.
///
/// # Safety
/// A live handle, used by one thread at a time; both arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetShiftDecimal(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    shifts: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::GET_SHIFT_DECIMAL, |instance| {
            let references = input(references, count, "valueReferences")?;
            let shifts = output(shifts, count, "shifts")?;
            require_clocks(instance, references)?;
            for (shift, reference) in shifts.iter_mut().zip(references) {
                *shift = instance.timing(*reference)?.shift;
            }
            Ok(())
        })
    }
}

/// As [`fmi3GetShiftDecimal`], as fractions of a second.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetShiftFraction(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    counters: *mut u64,
    resolutions: *mut u64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::GET_SHIFT_FRACTION, |instance| {
            let references = input(references, count, "valueReferences")?;
            let counters = output(counters, count, "counters")?;
            let resolutions = output(resolutions, count, "resolutions")?;
            require_clocks(instance, references)?;
            for (index, reference) in references.iter().enumerate() {
                (counters[index], resolutions[index]) = instance.timing(*reference)?.shift_fraction;
            }
            Ok(())
        })
    }
}

/// Sets the intervals \[s\] of input clocks, which is to set the parameter sample_time.
///
/// # Safety
/// A live handle, used by one thread at a time; both arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetIntervalDecimal(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    intervals: *const fmi3Float64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; both arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::SET_INTERVAL_DECIMAL, |instance| {
            let references = input(references, count, "valueReferences")?;
            let intervals = input(intervals, count, "intervals")?;
            instance.set_intervals(references, intervals.iter().copied())
        })
    }
}

/// As [`fmi3SetIntervalDecimal`], as fractions of a second.
///
/// # Safety
/// A live handle, used by one thread at a time; all arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3SetIntervalFraction(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    counters: *const u64,
    resolutions: *const u64,
) -> fmi3Status {
    // SAFETY: the handle is live and used by one thread at a time; all arrays hold `count` elements, as the standard
    // demands of importers.
    unsafe {
        enter(instance, &may::SET_INTERVAL_FRACTION, |instance| {
            let references = input(references, count, "valueReferences")?;
            let counters = input(counters, count, "counters")?;
            let resolutions = input(resolutions, count, "resolutions")?;
            // A resolution of 0 makes an infinite interval or none, which the range of sample_time refuses.
            let seconds = |(counter, resolution): (&u64, &u64)| *counter as f64 / *resolution as f64;
            instance.set_intervals(references, counters.iter().zip(resolutions).map(seconds))
        })
    }
}

/// All or, when one is refused, none.
fn require_clocks(instance: &mut Instance, references: &[u32]) -> Result<(), CallError> {
    references.iter().try_for_each(|reference| instance.timing(*reference).map(drop))
}

/// Whether the interval \[s\] of `tick` has changed since it was last reported (FMI 3.0.2, section 2.2.8.4).
fn interval_qualifier(instance: &mut Instance, interval: f64) -> fmi3IntervalQualifier {
    let told = core::mem::replace(&mut instance.state.clocks.told_interval, interval);
    if told == interval { FMI3_INTERVAL_UNCHANGED } else { FMI3_INTERVAL_CHANGED }
}
