"""Importers written in C++, which exist as Python packages for some platforms only (see conftest.py).

Both step all models, then exchange values, and neither can set enumerations, so the controller keeps its start values.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from bearing import CONTROLLER_OUTPUTS, SAMPLE_TIME, STATE, Loop
from fmpy import read_model_description
from importers.in_cpp import load_ecos
from packages import CONTROLLER, PLANT, fmu_path

STEPS = 1000
WIRES = [
    ((CONTROLLER, "voltage"), (PLANT, "voltage")),
    ((PLANT, "position"), (CONTROLLER, "position")),
    ((PLANT, "velocity"), (CONTROLLER, "state.velocity")),
    ((PLANT, "flux"), (CONTROLLER, "state.flux")),
    ((PLANT, "voltage_measured"), (CONTROLLER, "voltage_applied")),
]
Trajectory = list[list[float]]


@pytest.fixture
def through_fmpy(open_loop: Callable[..., Loop]) -> Callable[[int], Trajectory]:
    """Plant state and controller outputs after each step in the parallel order."""

    def trajectory(fmi_version: int) -> Trajectory:
        loop = open_loop(fmi_version)
        rows = []
        for _ in range(STEPS):
            loop.step("parallel")
            rows.append(loop.state() + loop.controller.get_reals(CONTROLLER_OUTPUTS))
        return rows

    return trajectory


def through_ecos(fmi_version: int) -> Trajectory:
    load_ecos()
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        for model in (PLANT, CONTROLLER):
            structure.add_model(model, fmu_path(fmi_version, model))
        for source, target in WIRES:
            structure.make_real_connection("::".join(source), "::".join(target))
        with EcosSimulation(structure=structure, step_size=SAMPLE_TIME) as simulation:
            assert simulation.init()
            rows = []
            for _ in range(STEPS):
                simulation.step()
                state = [simulation.get_real(f"{PLANT}::{name}") for name in STATE]
                rows.append(state + [simulation.get_real(f"{CONTROLLER}::{name}") for name in CONTROLLER_OUTPUTS])
    return rows


def through_libcosim() -> Trajectory:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    nanoseconds = round(SAMPLE_TIME * 1e9)
    execution = CosimExecution.from_step_size(nanoseconds)
    models = [PLANT, CONTROLLER]
    slaves = [CosimLocalSlave(str(fmu_path(2, model)), model) for model in models]
    index = {model: execution.add_local_slave(slave) for model, slave in zip(models, slaves)}
    reference = {
        (model, variable.name): variable.valueReference
        for model in models
        for variable in read_model_description(fmu_path(2, model)).modelVariables
    }
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    for source, target in WIRES:
        ends = (index[source[0]], reference[source], index[target[0]], reference[target])
        assert execution.connect_real_variables(*ends) == 0
    rows = []
    for _ in range(STEPS):
        assert execution.step()
        state = observer.last_real_values(index[PLANT], [reference[PLANT, name] for name in STATE])
        names = [reference[CONTROLLER, name] for name in CONTROLLER_OUTPUTS]
        rows.append(state + observer.last_real_values(index[CONTROLLER], names))
    return rows


def test_ecos_equals_fmpy(fmi_version: int, through_fmpy: Callable[[int], Trajectory]) -> None:
    assert through_ecos(fmi_version) == through_fmpy(fmi_version)


def test_libcosim_agrees_with_fmpy(through_fmpy: Callable[[int], Trajectory]) -> None:
    """libcosim rounds h, which the plant sees in the last digits."""
    got, want = np.array(through_libcosim()), np.array(through_fmpy(2))
    assert (np.abs(got - want).max(axis=0) < 1e-9 * np.abs(want).max(axis=0)).all()
