"""The same loop gives the same bits without FMI, through FMI 2.0, through FMI 3.0 and in another importer."""

from __future__ import annotations

import csv
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from bearing import CONTROLLER_OUTPUTS, STATE, Loop, bits
from cosimulation import Value
from packages import FMI_VERSIONS, REPOSITORY

STEPS = 10_000
Trajectory = list[tuple[int, ...]]


def executable() -> Path:
    """The program that was built with the FMUs: $MAGLEV_FMU, or else the release build."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return Path(os.environ.get("MAGLEV_FMU", target / "release" / "maglev-fmu"))


# Controllers that between them use every observer and law.
CONTROLLERS: dict[str, dict[str, Value]] = {
    "start values": {},
    "exact map": {"observer.map": "exact", "controller.law": "b"},
    "line search": {"observer.line_search": True, "observer.step_size": 0.7, "controller.law": "c"},
    "window": {"observer.window": 30, "observer.map": "exact"},
    "reduced": {"observer.kind": "reduced_newton"},
    "compensated": {"observer.kind": "reduced_newton_compensated", "observer.map": "exact"},
    "kalman": {"observer.kind": "kalman", "observer.position_noise": 1e-7, "controller.law": "flux_cascade"},
}


def native_trajectory(controller: dict[str, Value], steps: int) -> Trajectory:
    """Rows of the loop without FMI, each number as its 64-bit pattern.

    One row per sample, as `Loop.step` returns them: at the tick's time position, velocity, flux, and as of the tick
    voltage, estimate.position, estimate.velocity, estimate.flux.
    """
    command: list[str | Path] = [executable(), "trace", "bearing", "--steps", str(steps)]
    for name, value in controller.items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        command += ["--controller", f"{name}={text}"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    columns = [f"plant.{name}" for name in STATE] + [f"controller.{name}" for name in CONTROLLER_OUTPUTS]
    return [tuple(int(row[column], 16) for column in columns) for row in csv.DictReader(output.splitlines())]


@pytest.mark.parametrize("controller", CONTROLLERS.values(), ids=CONTROLLERS.keys())
def test_fmi_equals_native(
    fmi_version: int, controller: dict[str, Value], open_loop: Callable[..., Loop]
) -> None:
    native = native_trajectory(controller, STEPS)
    loop = open_loop(fmi_version, None, controller)
    through_fmi = [bits(row) for row in loop.run(STEPS)]
    assert len(native) == STEPS
    first = next((k for k in range(STEPS) if through_fmi[k] != native[k]), None)
    assert first is None, f"row {first}: {through_fmi[first]} through FMI, {native[first]} without"


@pytest.mark.parametrize("law", ["a", "b", "c"])
@pytest.mark.parametrize("order", ["controller-first", "parallel"])
def test_both_versions_are_equal(law: str, order: str, open_loop: Callable[..., Loop]) -> None:
    controller = {"controller.law": law, "observer.voltage_source": "applied"}
    loops = [open_loop(version, {"bias_flux": 1e-4}, controller) for version in FMI_VERSIONS]
    two, three = ([bits(row) for row in loop.run(STEPS, order)] for loop in loops)
    assert two == three
