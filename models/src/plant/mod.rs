//! Continuous-time physics, one file per rig. Knows nothing of sampling policies, models or FMI.

pub mod contact;
pub mod end_stops;
pub mod levitated_ball;
pub mod maglev_rig;
pub mod maglev_rig_ramp;
pub mod magnetic_bearing;
mod magnetic_bearing_ramp;
pub mod runge_kutta;
