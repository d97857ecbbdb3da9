//! The magnetic bearing.

mod closed_loop;
mod flux_cascade;
mod kalman_observer;
mod line_search;
mod newton_observer;
mod reduced_newton_observer;
mod reference;
mod windowed_newton_observer;
