//! Plants, observers, control laws and the models made of them, natively: no FMI.

mod allocations;
mod ball;
mod bearing;
mod limits;
mod packaged_loops;
mod rig;
mod tables;
