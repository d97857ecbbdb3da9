//! The studies, from packages to figures, claims and report.

mod ball;
mod ball_monte_carlo;
mod bearing;
mod bearing_observers;
mod rig;
mod tuning;
