//! The host: what it reads, what it refuses, and what it drives, small models that misbehave and the packaged ones.

mod archive;
mod bearing_loop;
mod description;
mod limits;
mod master;
mod memory;
mod observers;
mod parallel_loop;
mod rig_loop;
mod saved_state;
mod small_model;
mod stepping;
