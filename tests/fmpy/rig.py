"""The maglev rig's loop for the tests: plant and controller, the controller first, compared with the program's trace."""

from __future__ import annotations

import csv
import os
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

from cosimulation import Fmu, Value
from packages import REPOSITORY, fmu_path

SAMPLE_TIME = 1e-3  # s, the controller's start value
RIG_PLANT, RIG_CONTROLLER = "MaglevRigPlant", "MaglevRigController"
SENSING = {"sensor_voltage_measured": "sensor_voltage", "voltage_measured": "voltage_applied"}

Values = dict[str, Value]
Row = tuple[int, ...]


def executable() -> Path:
    """The program that was built with the FMUs: $MAGLEV_FMU, or else the release build."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return Path(os.environ.get("MAGLEV_FMU", target / "release" / "maglev-fmu"))


def run_program(*arguments: object, check: bool = True) -> subprocess.CompletedProcess[str]:
    command = [str(part) for part in (executable(), *arguments)]
    return subprocess.run(command, check=check, capture_output=True, text=True)


def native_trace(steps: int, plant: Values, controller: Values) -> tuple[list[str], list[Row]]:
    """The loop without FMI: names as `plant.position`, and per sample the bit patterns of all real outputs."""
    options: list[str] = []
    for model, values in [("--plant", plant), ("--controller", controller)]:
        for name, value in values.items():
            options += [model, f"{name}={str(value).lower() if isinstance(value, bool) else value}"]
    output = run_program("trace", "rig", "--steps", steps, *options).stdout
    reader = csv.reader(output.splitlines())
    names = next(reader)
    return names, [tuple(int(field, 16) for field in row) for row in reader]


class RigLoop:
    """Two FMUs of one version, initialized."""

    def __init__(self, plant: Fmu, controller: Fmu, plant_values: Values, controller_values: Values) -> None:
        self.plant, self.controller = plant, controller
        plant.initialize(plant_values)
        controller.initialize(controller_values)

    def run(self, steps: int, names: list[str]) -> list[list[float]]:
        """Per sample the plant's values before it moves on and the controller's after its tick."""
        columns = {model: [name.split(".", 1)[1] for name in names if name.startswith(model)] for model in ("plant", "controller")}
        rows = []
        for step in range(steps):
            time = step * SAMPLE_TIME
            row = self.plant.get_reals(columns["plant"])
            self.controller.set_reals(list(SENSING.values()), self.plant.get_reals(list(SENSING)))
            self.controller.step(time, SAMPLE_TIME)
            rows.append(row + self.controller.get_reals(columns["controller"]))
            self.plant.set_reals(["voltage"], self.controller.get_reals(["voltage"]))
            self.plant.step(time, SAMPLE_TIME)
        return rows


def open_rig(
    open_fmu: Callable[[Path], Fmu], fmi_version: int, plant: Values | None = None, controller: Values | None = None
) -> RigLoop:
    models = [open_fmu(fmu_path(fmi_version, model)) for model in (RIG_PLANT, RIG_CONTROLLER)]
    return RigLoop(*models, plant or {}, controller or {})


def bits(values: list[float]) -> Row:
    """The numbers as 64-bit patterns."""
    return struct.unpack(f"<{len(values)}Q", struct.pack(f"<{len(values)}d", *values))
