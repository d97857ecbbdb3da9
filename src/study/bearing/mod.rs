//! Figures 2 to 6 and the claims of the magnetic bearing paper (Mystkowski, Kotta, Kaparin 2018).

mod claims;
mod experiment;
mod figures;
mod runs;
mod scenario;

pub use experiment::run;
