//! What several test programs and benches share; what one of them uses alone is a module of that program.

pub mod bearing;
mod cart;
pub mod closed_loop;
pub mod component;
pub mod packages;
pub mod printed_newton;
pub mod rig;
pub mod sampled_bearing;
pub mod values;
