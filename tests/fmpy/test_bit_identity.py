"""The same loop gives the same bits without FMI, through FMI 2.0, through FMI 3.0 and in another importer."""

from __future__ import annotations

import csv
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from bearing import Loop, bits
from packages import FMI_VERSIONS, REPOSITORY

STEPS = 10_000
Trajectory = list[tuple[int, ...]]


def executable() -> Path:
    """The program that was built with the FMUs: $MAGLEV_FMU, or else the release build."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return Path(os.environ.get("MAGLEV_FMU", target / "release" / "maglev-fmu"))


@pytest.fixture(scope="module")
def native_trajectory() -> Trajectory:
    """Rows of the loop without FMI, each number as its 64-bit pattern.

    One row per sample, as `Loop.step` returns them: at the tick's time position, velocity, flux, and as of the tick
    voltage, estimate.position, estimate.velocity, estimate.flux.
    """
    command = [executable(), "trace", "--steps", str(STEPS)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [tuple(int(field, 16) for field in row) for row in csv.reader(text.splitlines())]


@pytest.fixture(scope="module")
def trajectory() -> Callable[[Loop, int], Trajectory]:
    """Bit patterns of a loop's rows."""
    return lambda loop, steps: [bits(row) for row in loop.run(steps)]


def test_fmi_equals_native(
    fmi_version: int,
    native_trajectory: Trajectory,
    trajectory: Callable[[Loop, int], Trajectory],
    open_loop: Callable[..., Loop],
) -> None:
    through_fmi = trajectory(open_loop(fmi_version), STEPS)
    assert len(native_trajectory) == STEPS
    first = next((k for k in range(STEPS) if through_fmi[k] != native_trajectory[k]), None)
    assert first is None, f"row {first}: {through_fmi[first]} through FMI, {native_trajectory[first]} without"


@pytest.mark.parametrize("law", ["a", "b", "c"])
@pytest.mark.parametrize("order", ["controller-first", "parallel"])
def test_both_versions_are_equal(law: str, order: str, open_loop: Callable[..., Loop]) -> None:
    controller = {"controller.law": law, "observer.voltage_source": "applied"}
    loops = [open_loop(version, {"bias_flux": 1e-4}, controller) for version in FMI_VERSIONS]
    two, three = ([bits(row) for row in loop.run(STEPS, order)] for loop in loops)
    assert two == three
