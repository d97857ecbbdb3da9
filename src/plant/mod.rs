//! Continuous-time physics, one file per rig. Knows nothing of sampling policies, units or FMI.

pub mod magnetic_bearing;
mod magnetic_bearing_ramp;
