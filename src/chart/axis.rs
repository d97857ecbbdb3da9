//! Ticks and ends of axes.

use std::ops::Range;

/// Whole decades around a range, at least one.
pub(super) fn decades((low, high): (f64, f64)) -> Range<f64> {
    let low = 10f64.powf(low.log10().floor());
    let high = 10f64.powf(high.log10().ceil());
    low..if high > low { high } else { 10.0 * low }
}

/// Decimals that tell the ticks of an axis of this length apart.
pub(super) fn decimals(length: f64) -> usize {
    (1.0 - length.log10().floor()).clamp(0.0, 12.0) as usize
}

/// Tick label; very small and very large numbers in powers of ten.
pub(super) fn tick(value: f64, decimals: usize) -> String {
    if decimals > 4 && value != 0.0 {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.decimals$}");
    // No "-0.00".
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.replace('-', "")
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_enclose_the_range() {
        assert_eq!(decades((0.03, 40.0)), 0.01..100.0);
        assert_eq!(decades((1.0, 1.0)), 1.0..10.0);
    }

    #[test]
    fn ticks_are_readable() {
        assert_eq!(tick(-0.0001, 2), "0.00");
        assert_eq!(tick(2.5, decimals(10.0)), "2");
        assert_eq!(tick(0.25, decimals(1.0)), "0.2");
        assert_eq!(tick(3e-9, decimals(1e-8)), "3.0e-9");
    }
}
