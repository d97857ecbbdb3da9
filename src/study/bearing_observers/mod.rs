//! All observers of the magnetic bearing on the same noisy data, next to the Cramer-Rao bound, and in the loop.

mod bound;
mod candidates;
mod claims;
mod comparison;
mod conditions;
mod experiment;
mod presentation;
mod settling;

pub use experiment::run;
