"""FMUs in importers written in C++: ecos and libcosim. Neither reads enumerations."""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path

from importers import CO_SIMULATION, Limit, Task
from importers.reference import Reference

REALS = ("Real", "Float64")


def load_ecos() -> None:
    """ecos links to a library that its package lacks but another package brings."""
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), ctypes.RTLD_GLOBAL)


def real_outputs(fmu: Path, reference: Reference) -> dict[str, int]:
    """Names and value references."""
    from fmpy import read_model_description

    variables = {v.name: v for v in read_model_description(fmu).modelVariables if v.type in REALS}
    return {name: variables[name].valueReference for name in reference.outputs if name in variables}


def step_with_ecos(fmu: Path) -> str:
    load_ecos()
    from ecospy import EcosSimulation, EcosSimulationStructure

    reference = Reference.of(fmu)
    outputs = list(real_outputs(fmu, reference))
    rows = []
    with EcosSimulationStructure() as structure:
        structure.add_model("model", fmu)
        with EcosSimulation(structure=structure, step_size=reference.step_size) as simulation:
            assert simulation.init()
            for values in reference.input_rows:
                for name, value in zip(reference.inputs, values):
                    simulation.set_real(f"model::{name}", value)
                simulation.step()
                rows.append([simulation.get_real(f"model::{name}") for name in outputs])
    return reference.compare(rows, outputs)


def step_with_libcosim(fmu: Path) -> str:
    from fmpy import read_model_description
    from libcosimpy._internal import get_last_error_message
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    slave = CosimLocalSlave(str(fmu), "model")
    assert slave.ptr(), get_last_error_message()
    reference = Reference.of(fmu)
    variables = {variable.name: variable for variable in read_model_description(fmu).modelVariables}
    inputs = [variables[name].valueReference for name in reference.inputs]
    outputs = real_outputs(fmu, reference)
    execution = CosimExecution.from_step_size(round(reference.step_size * 1e9))
    model = execution.add_local_slave(slave)
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    assert execution.add_observer(observer) and execution.add_manipulator(manipulator)
    rows = []
    for values in reference.input_rows:
        assert manipulator.slave_real_values(model, inputs, values)
        assert execution.step()
        rows.append(list(observer.last_real_values(model, list(outputs.values()))))
    return reference.compare(rows, list(outputs))


def has_clocks(fmu: Path) -> bool:
    from fmpy import read_model_description

    return any(variable.type == "Clock" for variable in read_model_description(fmu).modelVariables)


CLOCKS = Limit("the process ended with -6", "FMUs with clocks: frees the text of `intervalVariability` twice", has_clocks)
FMI_3 = Limit("Unsupported feature: Unsupported FMI version", "FMI 3")

TASKS = [
    Task("ecospy", "step", step_with_ecos, 2, CO_SIMULATION),
    Task("ecospy", "step", step_with_ecos, 3, CO_SIMULATION, CLOCKS),
    Task("libcosimpy", "step", step_with_libcosim, 2, CO_SIMULATION),
    Task("libcosimpy", "step", step_with_libcosim, 3, CO_SIMULATION, FMI_3),
]
