//! Tuning of the maglev rig's observers by particle swarm.

pub mod settings;
pub mod swarm;
