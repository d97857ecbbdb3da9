"""Importers other than fmpy agree with it, to the last bit."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from bearing import Loop, bits
from cosimulation import Value
from fmpy import read_model_description
from fmuloader.fmi2 import Fmi2Slave, Fmi2Type
from fmuloader.fmi3 import Fmi3Slave
from packages import CONTROLLER, PLANT, fmu_path

STEPS = 2000


class FmuloaderModel:
    """An instance in fmuloader with the methods that `Loop` needs."""

    def __init__(self, fmi_version: int, model: str) -> None:
        self.fmi_version = fmi_version
        path = fmu_path(fmi_version, model)
        description = read_model_description(path)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        if fmi_version == 2:
            self.slave = Fmi2Slave(path, model_identifier=model)
            self.slave.instantiate(model, Fmi2Type.CO_SIMULATION, guid=description.guid)
            self.get, self.put = self.slave.get_real, self.slave.set_real
        else:
            self.slave = Fmi3Slave(path, model_identifier=model)
            self.slave.instantiate_co_simulation(model, instantiation_token=description.guid)
            self.get, self.put = self.slave.get_float64, self.slave.set_float64

    def initialize(self, values: dict[str, Value] | None) -> None:
        for name, value in (values or {}).items():
            self.put([self.references[name]], [value])
        if self.fmi_version == 2:
            self.slave.setup_experiment(start_time=0.0)
            self.slave.enter_initialization_mode()
        else:
            self.slave.enter_initialization_mode(start_time=0.0)
        self.slave.exit_initialization_mode()

    def step(self, time: float, step_size: float) -> None:
        self.slave.do_step(time, step_size)

    def get_reals(self, names: list[str]) -> list[float]:
        return self.get([self.references[name] for name in names])

    def set_reals(self, names: list[str], values: list[float]) -> None:
        self.put([self.references[name] for name in names], values)

    def close(self) -> None:
        self.slave.terminate()
        self.slave.free_instance()


@pytest.mark.parametrize("order", ["controller-first", "parallel"])
def test_fmuloader_equals_fmpy(fmi_version: int, order: str, open_loop: Callable[..., Loop]) -> None:
    plant, controller = {"initial.position": 0.001}, {"controller.initial_voltage": -100.0}
    other = Loop(FmuloaderModel(fmi_version, PLANT), FmuloaderModel(fmi_version, CONTROLLER))
    other.initialize(plant, controller)
    rows = [bits(row) for row in other.run(STEPS, order)]
    other.plant.close()
    other.controller.close()
    assert rows == [bits(row) for row in open_loop(fmi_version, plant, controller).run(STEPS, order)]
