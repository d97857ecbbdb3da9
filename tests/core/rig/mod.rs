//! The maglev rig.

mod closed_loop;
mod experiment;
mod model_based_observers;
mod observers;
mod plant;
mod reference;
