"""The same loop gives the same bits without FMI, through FMI 2.0, through FMI 3.0 and in another importer."""

from __future__ import annotations

import csv
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import ball
import pytest
from bearing import CONTROLLER_OUTPUTS, STATE, Loop, bits
from cosimulation import Fmu, Value
from packages import BALL_MODELS, FMI_VERSIONS, REPOSITORY, fmu_path

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
    columns = [f"plant.{name}" for name in STATE] + [f"controller.{name}" for name in CONTROLLER_OUTPUTS]
    return trace("bearing", {}, controller, steps, columns)


def trace(
    system: str, plant: dict[str, Value], controller: dict[str, Value], steps: int, columns: list[str]
) -> Trajectory:
    """What the command `trace` prints of a system, each number as its 64-bit pattern."""
    command: list[str | Path] = [executable(), "trace", system, "--steps", str(steps)]
    for model, values in [("plant", plant), ("controller", controller)]:
        for name, value in values.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            command += [f"--{model}", f"{name}={text}"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
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


# Every observer of the ball, and what else changes the arithmetic.
BALL_CONTROLLERS: dict[str, dict[str, Value]] = {
    "drem": {"observer.startup_hold": 0.01},
    "drem normalised": {"observer.normalisation": 0.5, "observer.excitation_scale": 1e10},
    "drem from zero": {"observer.filters_from_zero": True},
    "newton": {"observer.kind": "polynomial_newton"},
    "adaptive resistance": {"observer.kind": "polynomial_newton_adaptive", "observer.startup_hold": 0.02},
    "adaptive offset": {"observer.kind": "polynomial_newton_adaptive", "observer.adaptation": "voltage_offset"},
    "state feedback": {"controller.feedback": "state", "observer.voltage_source": "applied"},
}


@pytest.mark.parametrize("controller", BALL_CONTROLLERS.values(), ids=BALL_CONTROLLERS.keys())
def test_ball_through_fmi_equals_native(
    fmi_version: int, controller: dict[str, Value], open_fmu: Callable[[Path], Fmu]
) -> None:
    target = 5e-4
    plant = {"sensor.noise": 1e-5, "sensor.seed": 3}
    controller = {"observer.initial.flux": 0.95 * ball.CARRYING_FLUX, **controller}
    columns = [f"plant.{name}" for name in ball.PLANT_OUTPUTS]
    columns += [f"controller.{name}" for name in ball.CONTROLLER_OUTPUTS]
    native = trace("ball", plant, {**controller, "reference": target}, STEPS, columns)
    loop = ball.BallLoop(*(open_fmu(fmu_path(fmi_version, model)) for model in BALL_MODELS), lambda _: target)
    loop.initialize(plant, {"reference": target, **controller})
    through_fmi = [bits(loop.step()) for _ in range(STEPS)]
    assert len(native) == STEPS
    first = next((k for k in range(STEPS) if through_fmi[k] != native[k]), None)
    assert first is None, f"row {first}: {through_fmi[first]} through FMI, {native[first]} without"
    assert len({row[0] for row in native}) > STEPS // 2, "the ball moves"
