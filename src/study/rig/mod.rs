//! The maglev rig: its paper's observers, figures and claims.

pub mod recording;
