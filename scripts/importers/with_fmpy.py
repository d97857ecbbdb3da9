"""FMUs in fmpy: co-simulation through its own loop, model exchange with CVode, scheduled execution by hand."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from importers import CO_SIMULATION, MODEL_EXCHANGE, SCHEDULED_EXECUTION, Task
from importers.reference import Reference

# For the solution of an integrator: of a state's nominal value, or of the largest magnitude that it reaches.
INTEGRATION_TOLERANCE = 1e-6


def signals(reference: Reference, held: bool) -> np.ndarray | None:
    """The reference input for `simulate_fmu`, at the communication points or, if `held`, with a jump at each.

    fmpy joins points by straight lines; a co-simulation sees the points only.
    """
    if not reference.inputs:
        return None
    times, rows = reference.input_times, reference.input_rows
    if held:
        ends = [*times[1:], times[-1] + reference.step_size]
        times = [time for pair in zip(times, ends) for time in pair]
        rows = [row for row in rows for _ in range(2)]
    table = np.zeros(len(times), dtype=[("time", float), *((name, float) for name in reference.inputs)])
    table["time"] = times
    for column, name in enumerate(reference.inputs):
        table[name] = [row[column] for row in rows]
    return table


def simulate(fmu: Path, reference: Reference, names: list[str], **options: object) -> list[list[float]]:
    """Values of `names` after each step of the reference run."""
    from fmpy import simulate_fmu

    result = simulate_fmu(
        fmu,
        stop_time=reference.output_times[-1],
        output_interval=reference.step_size,
        output=names,
        **options,
    )
    at = [int(np.argmin(np.abs(result["time"] - time))) for time in reference.output_times[1:]]
    return [[float(result[name][row]) for name in names] for row in at]


def simulate_co_simulation(fmu: Path) -> str:
    reference = Reference.of(fmu)
    rows = simulate(fmu, reference, reference.outputs, fmi_type="CoSimulation", input=signals(reference, held=False))
    return reference.compare(rows)


def simulate_model_exchange(fmu: Path) -> str:
    """The states, solved by CVode, against the model's own solution."""
    from fmpy import read_model_description

    reference = Reference.of(fmu)
    variables = read_model_description(fmu).modelVariables
    states = {variable.derivative.name for variable in variables if variable.derivative is not None}
    names = [name for name in reference.outputs if name in states] or reference.outputs
    rows = simulate(
        fmu,
        reference,
        names,
        fmi_type="ModelExchange",
        relative_tolerance=1e-12,
        input=signals(reference, held=True),
    )
    wanted = [[row[reference.outputs.index(name)] for name in names] for row in reference.output_rows[1:]]
    got, wanted = np.array(rows), np.array(wanted)
    scales = np.maximum(np.abs(wanted).max(axis=0), [nominal(variables, name) for name in names])
    errors = np.abs(got - wanted).max(axis=0) / scales
    assert (errors <= INTEGRATION_TOLERANCE).all(), dict(zip(names, errors))
    return f"to {INTEGRATION_TOLERANCE:g}"


def nominal(variables: list, name: str) -> float:
    """Nominal value of a variable, which may stand in its type."""
    variable = next(variable for variable in variables if variable.name == name)
    of_type = variable.declaredType.nominal if variable.declaredType else None
    return float(variable.nominal or of_type or 1.0)


def schedule(fmu: Path) -> str:
    """Each tick of the periodic input clock activated at its time, with the inputs of the step that begins there."""
    from fmpy import extract, read_model_description
    from fmpy.fmi3 import FMU3ScheduledExecution

    reference = Reference.of(fmu)
    description = read_model_description(fmu)
    variables = {variable.name: variable for variable in description.modelVariables}
    clock = periodic_clock(description)
    with TemporaryDirectory() as folder:
        model = FMU3ScheduledExecution(
            instanceName="model",
            guid=description.guid,
            modelIdentifier=description.scheduledExecution.modelIdentifier,
            unzipDirectory=extract(fmu, folder),
        )
        model.instantiate()
        model.enterInitializationMode()
        model.exitInitializationMode()
        inputs = [variables[name].valueReference for name in reference.inputs]
        rows = []
        for time, values in zip(reference.input_times, reference.input_rows):
            model.setFloat64(inputs, values)
            model.activateModelPartition(clock, time)
            rows.append([get(model, variables[name]) for name in reference.outputs])
        model.terminate()
        model.freeInstance()
    return reference.compare(rows)


def periodic_clock(description: object) -> int:
    """Value reference of the only input clock with a fixed interval."""
    clocks = [v for v in description.modelVariables if v.type == "Clock" and v.causality == "input"]
    assert len(clocks) == 1, [clock.name for clock in clocks]
    return clocks[0].valueReference


def get(model: object, variable: object) -> float:
    """Value of a variable of any type of FMI 3.0, as a number."""
    kind = "Int64" if variable.type == "Enumeration" else variable.type
    return float(getattr(model, f"get{kind}")([variable.valueReference])[0])


TASKS = [
    Task("FMPy", "simulate", run, version, interface)
    for version, interface, run in [
        (2, CO_SIMULATION, simulate_co_simulation),
        (2, MODEL_EXCHANGE, simulate_model_exchange),
        (3, CO_SIMULATION, simulate_co_simulation),
        (3, MODEL_EXCHANGE, simulate_model_exchange),
        (3, SCHEDULED_EXECUTION, schedule),
    ]
]
