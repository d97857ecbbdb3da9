"""Whether a loop does what its paper says, whichever program has run it.

Programs that start a package hold its wires at zero, or at the start values, for a step, and let the voltage act a step
later than the loop of the paper does; the bounds leave room for that.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from cosimulation import Fmu
from importers.system_structure import SystemStructure

Columns = dict[tuple[str, str], list[float]]
"""Values after each step by element and variable."""

DURATIONS = {"bearing": 2.0, "ball": 0.5, "rig": 1.0}  # s
SHARE = 0.01
"""Largest error of an estimate as a share of what is estimated."""
START_UP = {"bearing": 0.02, "ball": 0.3, "rig": 0.02}
"""Time that the observers take, in s; the ball's waits for its filters."""
# Estimated outputs: of the plant and of the controller.
ESTIMATES = {
    "bearing": [("position", "estimate.position"), ("velocity", "estimate.velocity"), ("flux", "estimate.flux")],
    "ball": [("position", "estimate.position"), ("flux", "estimate.flux")],
    "rig": [("sensor_voltage", "estimate.position")],
}

def duration(package: Path) -> float:
    """Time to simulate, in s."""
    return DURATIONS[package.stem]


def estimates(package: Path) -> set[tuple[str, str]]:
    """Outputs that `check_physics` looks at."""
    structure, pairs = SystemStructure(package), ESTIMATES[package.stem]
    plant, controller = structure.element("Plant"), structure.element("Controller")
    return {(plant, "position")} | {(plant, true) for true, _ in pairs} | {(controller, name) for _, name in pairs}


def check_physics(package: Path, columns: Columns) -> None:
    """Raises if the loop is lost or does not know where it is."""
    system, structure = package.stem, SystemStructure(package)
    plant, controller = structure.element("Plant"), structure.element("Controller")
    of_plant = structure.parameters[plant]
    if system == "bearing":
        expected = tolerance = position_of_the_paper(package, DURATIONS[system])
        scales = {}
    elif system == "ball":
        # Positions rest at zero and are measured by the way to the magnet.
        expected, tolerance = 0.0, SHARE * of_plant["gap"]
        scales = {"position": of_plant["gap"]}
    else:
        expected = tolerance = -of_plant["sensor_offset"] / of_plant["sensor_gain"]
        scales = {"sensor_voltage": of_plant["sensor_gain"] * expected}
    end = columns[plant, "position"][-1]
    assert abs(end - expected) < 2 * SHARE * abs(tolerance), f"{system}: {end} m, expected {expected} m"
    first = round(START_UP[system] / structure.step_size)
    for true, name in ESTIMATES[system]:
        # An estimate after a step belongs to what was measured before it.
        truth, estimate = columns[plant, true][first:-1], columns[controller, name][first + 1 :]
        scale = scales.get(true) or max(map(abs, columns[plant, true]))
        worst = max(abs(here - there) for here, there in zip(truth, estimate))
        assert worst < SHARE * scale, f"{name} is off by {worst}, {worst / scale:.1%} of {scale}"


@cache
def position_of_the_paper(package: Path, end: float) -> float:
    """Where the bearing of a package is in the loop of the paper: the controller reads and ticks at once, then the plant
    moves on with the new voltage."""
    structure = SystemStructure(package)
    names = structure.element("Controller"), structure.element("Plant")
    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        paths = [Path(archive.extract(structure.sources[name], folder)) for name in names]
        with Fmu(paths[0]) as controller, Fmu(paths[1]) as plant:
            controller.initialize({"start_delay": 0.0, "observer.voltage_source": "command"})
            plant.initialize(structure.parameters[names[1]])
            step = structure.step_size
            for number in range(round(end / step)):
                controller.set({"position": plant.get("position")})
                controller.step(number * step, step)
                plant.set({"voltage": controller.get("voltage")})
                plant.step(number * step, step)
            return plant.get("position")
