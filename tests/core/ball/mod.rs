//! The levitated ball.

mod adaptive_observer;
mod closed_loop;
mod criteria;
mod forward_euler;
mod literal;
pub mod native_loop;
mod plant;
mod regression;
mod sampled_against_literal;
