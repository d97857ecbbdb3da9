"""FMUs in fmuloader, a thin layer over the C functions of both standards."""

from __future__ import annotations

from pathlib import Path

from importers import CO_SIMULATION, SCHEDULED_EXECUTION, Task
from importers.reference import Reference

GETTERS = {"Real": "get_real", "Integer": "get_integer", "Enumeration": "get_integer", "Boolean": "get_boolean"}
GETTERS_3 = {"Float64": "get_float64", "Int32": "get_int32", "Enumeration": "get_int64", "Boolean": "get_boolean"}


def step_fmi2(fmu: Path) -> str:
    from fmpy import read_model_description
    from fmuloader.fmi2 import Fmi2Slave, Fmi2Type

    description = read_model_description(fmu)
    model = Fmi2Slave(fmu, model_identifier=description.coSimulation.modelIdentifier)
    model.instantiate("model", Fmi2Type.CO_SIMULATION, guid=description.guid)
    model.setup_experiment(start_time=0.0)
    model.enter_initialization_mode()
    model.exit_initialization_mode()
    return drive(model, fmu, description, model.set_real, model.do_step, GETTERS)


def step_fmi3(fmu: Path) -> str:
    from fmpy import read_model_description
    from fmuloader.fmi3 import Fmi3Slave

    description = read_model_description(fmu)
    model = Fmi3Slave(fmu, model_identifier=description.coSimulation.modelIdentifier)
    model.instantiate_co_simulation("model", instantiation_token=description.guid)
    model.enter_initialization_mode(start_time=0.0)
    model.exit_initialization_mode()
    return drive(model, fmu, description, model.set_float64, model.do_step, GETTERS_3)


def schedule(fmu: Path) -> str:
    from fmpy import read_model_description
    from fmuloader.fmi3 import Fmi3Slave
    from importers.with_fmpy import periodic_clock

    description = read_model_description(fmu)
    clock = periodic_clock(description)
    model = Fmi3Slave(fmu, model_identifier=description.scheduledExecution.modelIdentifier)
    model.instantiate_scheduled_execution("model", instantiation_token=description.guid)
    model.enter_initialization_mode(start_time=0.0)
    model.exit_initialization_mode()

    def tick(time: float, _: float) -> None:
        model.activate_model_partition(clock, time)

    return drive(model, fmu, description, model.set_float64, tick, GETTERS_3)


def drive(model, fmu: Path, description, set_reals, advance, getters: dict[str, str]) -> str:  # noqa: ANN001
    """Set the reference input, advance, get all outputs."""
    reference = Reference.of(fmu)
    variables = {variable.name: variable for variable in description.modelVariables}
    inputs = [variables[name].valueReference for name in reference.inputs]
    outputs = [(getattr(model, getters[variables[name].type]), variables[name]) for name in reference.outputs]
    rows = []
    for time, values in zip(reference.input_times, reference.input_rows):
        set_reals(inputs, values)
        advance(time, reference.step_size)
        rows.append([float(get([variable.valueReference])[0]) for get, variable in outputs])
    model.terminate()
    model.free_instance()
    return reference.compare(rows)


TASKS = [
    Task("fmuloader", "step", step_fmi2, 2, CO_SIMULATION),
    Task("fmuloader", "step", step_fmi3, 3, CO_SIMULATION),
    Task("fmuloader", "schedule", schedule, 3, SCHEDULED_EXECUTION),
]
