//! The sensorless levitated ball exactly as its equations read, in continuous time: plant, flux integrator, the
//! twelve prefilters of the regression, the twenty low-passes of the dynamic regressor extension, speed and
//! position observer, reference filter and feedback linearisation in one Runge-Kutta scheme. Written for clarity
//! and independent of the shipped observer: it is what tests and studies hold the sampled product against.
//!
//! The paper's text (Bobtsov, Pyrkin, Ortega, Vedyakov, "Sensorless Control of the Levitated Ball",
//! arXiv 1811.07732) came without its equations and numbers. Plant, flux integrator, mixing, feedback law and the
//! three error equations are fixed by what the text says; the regression is a reconstruction of the announced
//! kind, and every number is assumed or tuned.

pub mod ball;
pub mod closed_loop;
pub mod mechanics;
pub mod mixing;
pub mod reference;
pub mod regression;
pub mod settings;

pub use self::{
    ball::{Ball, Motion},
    closed_loop::{Collision, Row, rows, run},
    mixing::Mixing,
    reference::Reference,
    regression::{POLES, Regression},
    settings::{Feedback, FilterStart, Settings, Voltage},
};
