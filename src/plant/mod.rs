//! Continuous-time physics, one file per rig. Knows nothing of sampling policies, units or FMI.

pub mod maglev_rig;
pub mod magnetic_bearing;
