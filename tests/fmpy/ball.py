"""Levitated ball loops for the tests: plant and controller, the controller first."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from cosimulation import Fmu, Value

CARRYING_FLUX = math.sqrt(2.0 * 6.4042e-5 * 0.0844 * 9.81)  # Wb, of the start values
PLANT_TO_CONTROLLER = {
    "current_measured": "current",
    "position": "state.position",
    "velocity": "state.velocity",
    "flux": "state.flux",
    "voltage_measured": "voltage_applied",
}
PLANT_OUTPUTS = ["position", "velocity", "flux", "current_measured"]
CONTROLLER_OUTPUTS = [
    "voltage",
    "reference.position",
    "estimate.position",
    "estimate.velocity",
    "estimate.flux",
    "observer.flux_offset",
    "observer.residual",
]
COLUMNS = PLANT_OUTPUTS + CONTROLLER_OUTPUTS

# Reference in m over time in s.
Reference = Callable[[float], float]


def sinusoids(time: float) -> float:
    return 0.6e-3 * sum(math.sin(15.0 * multiple * time) for multiple in (1.0, 2.2, 3.7))


def rest(time: float) -> float:
    return 0.0


@dataclass
class BallLoop:
    """Two models that step together."""

    plant: Fmu
    controller: Fmu
    reference: Reference = rest
    sample_time: float = 1e-4
    steps_done: int = field(default=0, init=False)

    def initialize(self, plant: dict[str, Value], controller: dict[str, Value]) -> None:
        self.plant.initialize(plant)
        self.controller.initialize({"sample_time": self.sample_time, **controller})

    def step(self) -> list[float]:
        """Advance by one sample and return what holds at its start, in the order of `COLUMNS`."""
        time = self.steps_done * self.sample_time
        self.controller.set_reals(list(PLANT_TO_CONTROLLER.values()), self.plant.get_reals(list(PLANT_TO_CONTROLLER)))
        self.controller.set_reals(["reference"], [self.reference(time)])
        row = self.plant.get_reals(PLANT_OUTPUTS)
        self.controller.step(time, self.sample_time)
        row += self.controller.get_reals(CONTROLLER_OUTPUTS)
        self.plant.set_reals(["voltage"], [row[len(PLANT_OUTPUTS)]])
        self.plant.step(time, self.sample_time)
        self.steps_done += 1
        return row

    def run(self, duration: float) -> list[list[float]]:
        """Rows of `duration` s."""
        return [self.step() for _ in range(round(duration / self.sample_time))]


def column(rows: list[list[float]], name: str) -> np.ndarray:
    return np.array([row[COLUMNS.index(name)] for row in rows])


def flux_error(rows: list[list[float]]) -> np.ndarray:
    """Error of the flux estimate as a share of the flux that carries the ball."""
    return (column(rows, "estimate.flux") - column(rows, "flux")) / CARRYING_FLUX


def deviation(rows: list[list[float]]) -> np.ndarray:
    """Position less the filtered reference in m."""
    return column(rows, "position") - column(rows, "reference.position")


def root_mean_square(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
