"""Bearing loops for the tests: plant and controller with their values passed on in one of two orders."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from cosimulation import Fmu, Value

SAMPLE_TIME = 1e-3  # s, the controller's start value
STATE = ["position", "velocity", "flux"]
ESTIMATE = ["estimate.position", "estimate.velocity", "estimate.flux"]
CONTROLLER_INPUTS = ["position", "state.velocity", "state.flux", "voltage_applied"]
PLANT_OUTPUTS = [*STATE, "voltage_measured"]
CONTROLLER_OUTPUTS = ["voltage", *ESTIMATE]


@dataclass
class Loop:
    """Two models that step together."""

    plant: Fmu
    controller: Fmu
    steps_done: int = 0

    def initialize(self, plant: dict[str, Value] | None, controller: dict[str, Value] | None) -> None:
        self.plant.initialize(plant)
        self.controller.initialize(controller)

    def step(self, order: str = "controller-first") -> list[float]:
        """Advance by one sample.

        Returns what holds at its start: the plant's state [m, m/s, Wb], then the controller's voltage [V] and
        estimate [m, m/s, Wb] as of the tick at that time.
        """
        time = self.steps_done * SAMPLE_TIME
        outputs = self.plant.get_reals(PLANT_OUTPUTS)
        self.controller.set_reals(CONTROLLER_INPUTS, outputs)
        self.controller.step(time, SAMPLE_TIME)
        commands = self.controller.get_reals(CONTROLLER_OUTPUTS)
        if order == "controller-first":
            self.plant.set_reals(["voltage"], commands[:1])
        self.plant.step(time, SAMPLE_TIME)
        if order == "parallel":
            self.plant.set_reals(["voltage"], commands[:1])
        self.steps_done += 1
        return outputs[:3] + commands

    def run(self, steps: int, order: str = "controller-first") -> list[list[float]]:
        """Rows of `steps` samples."""
        return [self.step(order) for _ in range(steps)]

    def state(self) -> list[float]:
        """Position [m], velocity [m/s] and flux [Wb] of the plant."""
        return self.plant.get_reals(STATE)


def bits(values: list[float]) -> tuple[int, ...]:
    """The numbers as 64-bit patterns, so that comparing them tells -0 from 0 and one NaN from another."""
    return struct.unpack(f"<{len(values)}Q", struct.pack(f"<{len(values)}d", *values))
