"""The rig's loop gives the same bits without FMI, through FMI 2.0, through FMI 3.0 and in another importer."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from cosimulation import Fmu
from packages import REPOSITORY
from rig import RigLoop, Values, bits, native_trace, open_rig

STEPS = 10_000
OpenFmu = Callable[[Path], Fmu]

# A noisy sensor and a step of the reference at the start keep everything moving.
PLANT: Values = {"sensor.noise": 1e-3, "sensor.seed": 5}
REFERENCE: Values = {"reference": -1.45}
THROUGH_EXTENDED_STATE: Values = {
    "controller.kind": "disturbance_rejection",
    "observer.input_gain": -3705.0,
    "observer.bandwidth": 300.0,
}
EXTENDED_STATE_OBSERVERS: dict[str, Values] = {
    f"{kind}, {discretisation}, {form}": {
        "observer.kind": kind,
        "observer.discretisation": discretisation,
        "observer.form": form,
    }
    for kind in ("linear", "nonlinear")
    for discretisation in ("exact", "runge_kutta", "euler")
    for form in ("predictor", "current")
}
# Controllers that between them use every observer, start, unit and law.
CONTROLLERS: dict[str, Values] = {
    **EXTENDED_STATE_OBSERVERS,
    "start values": {},
    "metres from zero": {"observer.measurement": "metres", "observer.initial": "zero", "observer.substeps": 3},
    "gains": {"observer.kind": "nonlinear", "observer.tuning": "gains", "observer.exponent[2]": 0.7},
    "matched": {"observer.initial": "matched", "controller.derivative": "measurement"},
    "rejection, linear": {**THROUGH_EXTENDED_STATE, "controller.reference_filter": 30.0},
    "rejection, nonlinear": {
        **THROUGH_EXTENDED_STATE,
        "observer.kind": "nonlinear",
        "observer.bandwidth": 100.0,
        "controller.bandwidth": 40.0,
    },
    "kalman": {"observer.kind": "kalman", "observer.measurement": "metres", "observer.initial": "zero"},
    "windowed newton": {"observer.kind": "windowed_newton", "observer.estimate_disturbance": False},
    "rejection, kalman": {**THROUGH_EXTENDED_STATE, "observer.kind": "kalman", "mass": 0.018},
    "rejection, windowed newton": {**THROUGH_EXTENDED_STATE, "observer.kind": "windowed_newton", "observer.window": 64},
    "rejection, voltage applied": {**THROUGH_EXTENDED_STATE, "observer.voltage_source": "applied"},
    "ball lost": {**THROUGH_EXTENDED_STATE, "observer.input_gain": 1.0, "controller.input_gain": 1.0},
}


@pytest.mark.parametrize("controller", CONTROLLERS.values(), ids=CONTROLLERS.keys())
def test_fmi_equals_native(fmi_version: int, controller: Values, open_fmu: OpenFmu) -> None:
    values = REFERENCE | controller
    names, native = native_trace(STEPS, PLANT, values)
    loop = open_rig(open_fmu, fmi_version, PLANT, values)
    through_fmi = [bits(row) for row in loop.run(STEPS, names)]
    assert len(native) == STEPS
    first = next((k for k in range(STEPS) if through_fmi[k] != native[k]), None)
    assert first is None, f"row {first}: {through_fmi[first]} through FMI, {native[first]} without, of {names}"


@pytest.fixture
def reference_rows() -> np.ndarray:
    """Columns: time, reference, x, x', sensor and coil voltage, then three observers; every 5 ms over 4 s."""
    path = REPOSITORY / "tests" / "reference" / "rig_sine_step.csv"
    with path.open(newline="") as file:
        return np.array([[float(field) for field in row] for row in list(csv.reader(file))[1:]])


def run_with_reference(loop: RigLoop, steps: int, names: list[str]) -> np.ndarray:
    """A sine of 0.15 V at 0.5 Hz and a step of 0.1 V at 2 s, tick by tick."""
    rest, rows = -1.50868, []
    for step in range(steps):
        time = step * 1e-3
        wanted = rest + 0.15 * np.sin(np.pi * time) + (0.1 if step >= 2000 else 0.0)
        loop.controller.set_reals(["reference"], [wanted])
        loop.controller.set_reals(["sensor_voltage"], loop.plant.get_reals(["sensor_voltage_measured"]))
        before = loop.plant.get_reals(["position", "velocity"])
        loop.controller.step(time, 1e-3)
        rows.append(before + loop.controller.get_reals(names))
        loop.plant.set_reals(["voltage"], loop.controller.get_reals(["voltage"]))
        loop.plant.step(time, 1e-3)
    return np.array(rows)


ESTIMATE = ["estimate.position", "estimate.velocity", "estimate.extended"]


@pytest.mark.parametrize(
    ("controller", "columns"),
    [
        ({"observer.initial": "matched"}, [12, 13, 14]),
        (
            {
                "observer.kind": "nonlinear",
                "observer.measurement": "metres",
                "observer.initial": "zero",
                "observer.form": "current",
            },
            [9, 10, 11],
        ),
    ],
    ids=["LESO exact in volts", "NESO in metres from zero"],
)
def test_loop_matches_the_independent_prototype(
    fmi_version: int, controller: Values, columns: list[int], reference_rows: np.ndarray, open_fmu: OpenFmu
) -> None:
    loop = open_rig(open_fmu, fmi_version, {}, controller)
    rows = run_with_reference(loop, 4000, ["voltage", *ESTIMATE])[::5]
    expected = reference_rows[:, [2, 3, 5, *columns]]
    scale = np.abs(expected).max(axis=0)
    worst = (np.abs(rows - expected) / scale).max(axis=0)
    assert (worst < 1e-8).all(), worst
