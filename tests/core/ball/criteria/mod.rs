//! What the paper shows and states of the levitated ball, by its equations taken literally.

mod observers;
mod reference;
mod regression;
mod start;
mod tracking;
