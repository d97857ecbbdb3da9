//! The maglev rig.

mod closed_loop;
mod experiment;
mod observers;
mod plant;
mod reference;
