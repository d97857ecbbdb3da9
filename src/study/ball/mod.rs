//! Figures 2 to 7 and the claims of the levitated ball paper (Bobtsov, Pyrkin, Ortega, Vedyakov 2018).

mod claims;
mod continuous;
mod cost;
mod experiment;
mod figures;
mod reference;
mod runs;
mod scenario;
mod tables;

pub use experiment::run;
pub use reference::BallReference;
