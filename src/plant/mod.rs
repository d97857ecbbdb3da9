//! Continuous-time physics, one file per rig. Knows nothing of sampling policies, units or FMI.

pub mod end_stops;
pub mod levitated_ball;
pub mod maglev_rig;
pub mod magnetic_bearing;
pub mod runge_kutta;
