//! The C boundary from outside: the exported functions of both standards, called as an importer calls them.

// Adds models that the library does not have.
use maglev_fmu_test as _;

mod allocations;
mod allocator;
mod allowed_calls_fmi2;
mod allowed_calls_fmi3;
mod capabilities;
mod concurrency;
mod dependencies;
mod derivatives;
mod differences;
mod editions;
mod event_mode;
mod failing_memory;
mod fitting_parameters;
#[cfg(target_arch = "x86_64")]
mod floating_point;
mod harness;
mod imprecise_steps;
mod input_slopes;
mod instantiation;
mod intermediate_update;
mod life_cycle;
mod logging;
mod long_steps;
mod model_exchange;
mod panic;
mod random;
mod refused_references;
mod refused_states;
mod refused_values;
mod round_trips;
mod saved_state;
mod scheduled_execution;
mod sensor_readings;
mod standard;
mod steps;
mod stop_time;
mod symbols;
mod throwing;
mod tick_modes;
mod ticks;
mod values;
