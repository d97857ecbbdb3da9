//! The C boundary from outside: the exported functions of both standards, called as an importer calls them.

mod harness;

mod allowed_calls_fmi2;
mod allowed_calls_fmi3;
mod concurrency;
mod dependencies;
mod derivatives;
mod instantiation;
mod life_cycle;
mod logging;
mod model_exchange;
mod panic;
mod random_calls;
mod refused_references;
mod refused_values;
mod saved_state;
mod steps;
#[cfg(feature = "tools")]
mod symbols;
mod ticks;
mod values;
