//! Conditions that all observers are compared under.

/// Standard deviations of the position sensor \[m\].
pub(super) const NOISES: [f64; 5] = [0.0, 1e-9, 1e-8, 1e-7, 1e-6];
/// Sample times \[s\].
pub(super) const SAMPLE_TIMES: [f64; 3] = [1e-4, 1e-3, 1e-2];
/// Simulated time \[s\], of which the start is not scored.
pub(super) const DURATION: f64 = 10.0;
pub(super) const SCORED_FROM: f64 = 0.5;
/// Flux at the start \[Wb\]: what u(0) = -150 V for 1 ms leaves behind, so that all sample times see the same motion.
pub(super) const INITIAL_FLUX: f64 = -0.15;
/// A rotor that gets further than this from the centre counts as lost \[m\]; undisturbed it stays within 0.014 m.
pub(super) const LOST_BEYOND: f64 = 0.05;

/// Seeds per sample time: a run at 0.1 ms takes ten times as many steps as one at 1 ms.
pub(super) fn seeds(sample_time: f64) -> i32 {
    if sample_time < 1e-3 { 3 } else { 10 }
}
