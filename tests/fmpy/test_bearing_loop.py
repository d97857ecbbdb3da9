"""The closed loop of plant and controller against independent results."""

from __future__ import annotations

import csv
from collections.abc import Callable

import numpy as np
import pytest
from bearing import Loop
from packages import REPOSITORY

# x1(0) in m, u(0) in V, state after 10 s in m, m/s, Wb: true state fed back, law (a), no bias.
STATE_FEEDBACK_AFTER_10_S = [
    (0.0, -50.0, [-6.763386609e-03, -2.079770895e-04, 8.926722091e-03]),
    (0.0, -150.0, [-1.480108176e-02, 1.282704664e-03, 2.375955856e-03]),
    (0.001, -100.0, [-1.247533372e-02, 4.123170860e-04, 8.923954241e-03]),
    (0.01, -50.0, [-1.029641720e-03, -8.448353232e-04, 9.344178368e-03]),
    (0.01, -150.0, [-1.154221711e-02, 6.709150688e-04, 5.153147720e-03]),
]
ERROR_BOUNDS = [1e-9, 1e-7, 1e-5]  # m, m/s, Wb
STEPS = 10_000
OpenLoop = Callable[..., Loop]


def estimation_errors(rows: list[list[float]]) -> np.ndarray:
    """Magnitudes of estimate minus state, one row per sample: m, m/s, Wb."""
    columns = np.array(rows)
    return np.abs(columns[:, 4:7] - columns[:, 0:3])


@pytest.mark.parametrize(("position", "voltage", "expected"), STATE_FEEDBACK_AFTER_10_S)
def test_state_feedback_after_10_s(
    fmi_version: int, position: float, voltage: float, expected: list[float], open_loop: OpenLoop
) -> None:
    controller = {"controller.feedback": "state", "controller.law": "a", "controller.initial_voltage": voltage}
    loop = open_loop(fmi_version, {"initial.position": position}, controller)
    loop.run(STEPS)
    assert loop.state() == pytest.approx(expected, rel=1e-8, abs=0.0)


@pytest.mark.parametrize("max_iterations", [10, 100])
@pytest.mark.parametrize("position", [0.001, 0.01])
@pytest.mark.parametrize("voltage", [-50.0, -100.0, -150.0])
def test_observer_converges(
    fmi_version: int, position: float, voltage: float, max_iterations: int, open_loop: OpenLoop
) -> None:
    controller = {"observer.max_iterations": max_iterations, "controller.initial_voltage": voltage}
    rows = open_loop(fmi_version, {"initial.position": position}, controller).run(STEPS)
    worst = estimation_errors(rows)[3:].max(axis=0)
    assert (worst < ERROR_BOUNDS).all(), worst
    assert np.abs(np.array(rows)[:, 3]).max() <= 150.0


def parallel_rows(fmi_version: int, position: float, model: str, open_loop: OpenLoop) -> list[list[float]]:
    """All models step before values are exchanged; the observer gets the voltage that acted."""
    controller = {"observer.voltage_source": "applied", "observer.map": model}
    return open_loop(fmi_version, {"initial.position": position}, controller).run(STEPS, "parallel")


@pytest.mark.parametrize("position", [0.001, 0.01])
def test_observer_converges_in_the_parallel_order(fmi_version: int, position: float, open_loop: OpenLoop) -> None:
    worst = estimation_errors(parallel_rows(fmi_version, position, "exact", open_loop))[10:].max(axis=0)
    assert (worst < ERROR_BOUNDS).all(), worst


@pytest.mark.parametrize("position", [0.001, 0.01])
def test_printed_map_in_the_parallel_order(fmi_version: int, position: float, open_loop: OpenLoop) -> None:
    """Map (4a) is wrong in the step where the flux changes sign, so the two estimates that use this step may be."""
    rows = parallel_rows(fmi_version, position, "printed", open_loop)
    errors = estimation_errors(rows)[10:]
    flux = np.array(rows)[8:, 2]
    crosses = flux[1:] * flux[:-1] < 0.0
    is_affected = crosses[1:] | crosses[:-1]
    assert is_affected.sum() <= 4
    assert (errors[~is_affected].max(axis=0) < ERROR_BOUNDS).all(), errors[~is_affected].max(axis=0)
    assert errors[:, 2].max() <= 2e-5


@pytest.mark.parametrize("feedback", ["state", "estimate"])
def test_trajectory_of_the_reference_file(fmi_version: int, feedback: str, open_loop: OpenLoop) -> None:
    """Columns: time, then state and voltage with state feedback, then state, estimate and voltage with the observer."""
    path = REPOSITORY / "tests" / "reference" / "bearing_law_a.csv"
    with path.open(newline="") as file:
        reference = np.array([[float(field) for field in row] for row in list(csv.reader(file))[1:]])
    rows = np.array(open_loop(fmi_version, None, {"controller.feedback": feedback}).run(STEPS))
    samples = np.rint(reference[:, 0] * 1000).astype(int)
    inside = samples < STEPS
    got = rows[samples[inside], :4]
    columns, tolerance = ([1, 2, 3, 4], 1e-9) if feedback == "state" else ([5, 6, 7, 11], 1e-6)
    want = reference[inside][:, columns]
    scale = np.abs(want[1:]).max(axis=0)
    worst = (np.abs(got - want) / scale).max(axis=0)
    assert (worst < tolerance).all(), worst
