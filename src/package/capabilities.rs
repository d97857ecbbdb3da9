//! What the models declare to be able to do: the capability flags of both standards.

use crate::model::{Description, Edition};

/// Capability flags of a model, named as in FMI 3.0 where the standards differ in spelling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Communication steps may differ in size.
    pub can_handle_variable_communication_step_size: bool,
    /// FMI 2.0: `fmi2SetRealInputDerivatives` has an effect.
    pub can_interpolate_inputs: bool,
    /// Highest order of output derivatives that can be asked for.
    pub max_output_derivative_order: u32,
    /// FMI 2.0: `fmi2DoStep` may return before the step is over and go on in the background.
    pub can_run_asynchronously: bool,
    pub can_be_instantiated_only_once_per_process: bool,
    /// FMI 2.0: the model does not use the importer's functions for memory.
    pub can_not_use_memory_management_functions: bool,
    pub can_get_and_set_fmu_state: bool,
    pub can_serialize_fmu_state: bool,
    pub provides_directional_derivatives: bool,
    /// The model is only a link to a program that has to be installed.
    pub needs_execution_tool: bool,
    /// Model exchange: the importer has to tell when a step of its integrator is accepted.
    pub needs_completed_integrator_step: bool,
    /// FMI 3.0.
    pub provides_adjoint_derivatives: bool,
    /// FMI 3.0: dependencies can be asked for at run time.
    pub provides_per_element_dependencies: bool,
    /// FMI 3.0: calls the importer back within a step.
    pub provides_intermediate_update: bool,
    /// FMI 3.0: a step may end before the importer's next communication point.
    pub might_return_early_from_do_step: bool,
    /// FMI 3.0: a step ends early when the importer asks for it within the step.
    pub can_return_early_after_intermediate_update: bool,
    /// FMI 3.0: events are handled by the importer.
    pub has_event_mode: bool,
    /// FMI 3.0: `fmi3EvaluateDiscreteStates` works.
    pub provides_evaluate_discrete_states: bool,
    /// FMI 3.0: the importer may make the model tick by activating its model partition.
    pub offers_scheduled_execution: bool,
}

impl Capabilities {
    /// Capabilities of an edition of a model.
    pub fn of(description: &Description, edition: Edition) -> Self {
        match edition {
            _ if !description.is_sampled() => PLANT,
            Edition::Plain => CONTROLLER,
            Edition::Clocked => CLOCKED_CONTROLLER,
        }
    }
}

/// What all models have in common.
const EVERY_MODEL: Capabilities = Capabilities {
    can_handle_variable_communication_step_size: true,
    can_interpolate_inputs: false,
    max_output_derivative_order: 0,
    can_run_asynchronously: false,
    can_be_instantiated_only_once_per_process: false,
    can_not_use_memory_management_functions: true,
    can_get_and_set_fmu_state: true,
    can_serialize_fmu_state: true,
    provides_directional_derivatives: false,
    needs_execution_tool: false,
    needs_completed_integrator_step: false,
    provides_adjoint_derivatives: false,
    provides_per_element_dependencies: false,
    provides_intermediate_update: false,
    might_return_early_from_do_step: false,
    can_return_early_after_intermediate_update: false,
    has_event_mode: false,
    provides_evaluate_discrete_states: false,
    offers_scheduled_execution: false,
};

/// Plants move in continuous time.
const PLANT: Capabilities = Capabilities {
    can_interpolate_inputs: true,
    max_output_derivative_order: 1,
    provides_directional_derivatives: true,
    provides_adjoint_derivatives: true,
    ..EVERY_MODEL
};

/// Controllers act at their ticks: an importer may end a step at one when it is called back before. In between all
/// outputs are held: at a communication point they depend on no input, as their empty dependencies say, and derivatives
/// would all be zero.
const CONTROLLER: Capabilities = Capabilities {
    provides_intermediate_update: true,
    might_return_early_from_do_step: true,
    can_return_early_after_intermediate_update: true,
    ..EVERY_MODEL
};

/// An importer that sees the clocks may also handle ticks as events or schedule them.
const CLOCKED_CONTROLLER: Capabilities =
    Capabilities { has_event_mode: true, offers_scheduled_execution: true, ..CONTROLLER };

// Flags that the standards allow only together with another.
const fn is_consistent(can: &Capabilities) -> bool {
    (can.can_get_and_set_fmu_state || !can.can_serialize_fmu_state)
        && (can.provides_intermediate_update || !can.can_return_early_after_intermediate_update)
}
const _: () =
    assert!(is_consistent(&PLANT) && is_consistent(&CONTROLLER) && is_consistent(&CLOCKED_CONTROLLER));
