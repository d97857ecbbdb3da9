//! Beyond the maglev rig's paper: its observers in the loop, against those of the other papers, and how to start them.

mod candidates;
mod claims;
mod experiment;
mod force_step;
mod peaking;

pub use experiment::run;
