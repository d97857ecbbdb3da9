//! FMI 3.0: clocks.
#![allow(non_snake_case, reason = "the names are the standard's")]

use super::legality as may;
use super::types::*;
use crate::fmi::boundary::{enter, input, output};
use crate::fmi::fraction::fraction;
use crate::fmi::{CallError, Instance, Phase};

/// # Safety
/// A live handle, used by one thread at a time; both arrays hold `count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn fmi3GetClock(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    values: *mut fmi3Clock,
) -> fmi3Status {
    // SAFETY: the caller's promise.
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
    // SAFETY: the caller's promise.
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
    // SAFETY: the caller's promise.
    unsafe {
        enter(instance, &may::GET_INTERVAL_DECIMAL, |instance| {
            let references = input(references, count, "valueReferences")?;
            let intervals = output(intervals, count, "intervals")?;
            let qualifiers = output(qualifiers, count, "qualifiers")?;
            let qualifier = qualifier(instance);
            for_each(instance, references, |index, (interval, _)| {
                intervals[index] = interval;
                qualifiers[index] = qualifier;
                Ok(())
            })
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
    // SAFETY: the caller's promise.
    unsafe {
        enter(instance, &may::GET_INTERVAL_FRACTION, |instance| {
            let references = input(references, count, "valueReferences")?;
            let counters = output(counters, count, "counters")?;
            let resolutions = output(resolutions, count, "resolutions")?;
            let qualifiers = output(qualifiers, count, "qualifiers")?;
            let qualifier = qualifier(instance);
            for_each(instance, references, |index, (interval, _)| {
                (counters[index], resolutions[index]) = exact("interval", interval)?;
                qualifiers[index] = qualifier;
                Ok(())
            })
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
    // SAFETY: the caller's promise.
    unsafe {
        enter(instance, &may::GET_SHIFT_DECIMAL, |instance| {
            let references = input(references, count, "valueReferences")?;
            let shifts = output(shifts, count, "shifts")?;
            for_each(instance, references, |index, (_, shift)| {
                shifts[index] = shift;
                Ok(())
            })
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
    // SAFETY: the caller's promise.
    unsafe {
        enter(instance, &may::GET_SHIFT_FRACTION, |instance| {
            let references = input(references, count, "valueReferences")?;
            let counters = output(counters, count, "counters")?;
            let resolutions = output(resolutions, count, "resolutions")?;
            for_each(instance, references, |index, (_, shift)| {
                (counters[index], resolutions[index]) = exact("shift", shift)?;
                Ok(())
            })
        })
    }
}

/// Hands interval and shift of each clock to `take`, with the place of the clock in the list.
fn for_each(
    instance: &mut Instance,
    references: &[u32],
    mut take: impl FnMut(usize, (f64, f64)) -> Result<(), CallError>,
) -> Result<(), CallError> {
    // All or, when one is refused, none.
    for reference in references {
        instance.interval_and_shift(*reference)?;
    }
    for (index, reference) in references.iter().enumerate() {
        take(index, instance.interval_and_shift(*reference)?)?;
    }
    Ok(())
}

/// The interval may change until the end of initialisation.
fn qualifier(instance: &Instance) -> fmi3IntervalQualifier {
    if instance.phase == Phase::InitializationMode { FMI3_INTERVAL_CHANGED } else { FMI3_INTERVAL_UNCHANGED }
}

fn exact(name: &'static str, value: f64) -> Result<(u64, u64), CallError> {
    fraction(value).ok_or(CallError::NoFraction { name, value })
}
