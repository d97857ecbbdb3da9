"""The levitated ball's loop through the FMUs: observers, stops and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from ball import CARRYING_FLUX, BallLoop, column, deviation, flux_error, rest, root_mean_square, sinusoids
from cosimulation import Fmu
from fmpy.fmi1 import FMICallException
from packages import BALL_MODELS, fmu_path

PLANT, CONTROLLER = BALL_MODELS
OpenBall = Callable[..., BallLoop]


@pytest.fixture
def open_ball(open_fmu: Callable[[Path], Fmu]) -> OpenBall:
    """Load and initialize both models; the observer's flux starts 10 % too small."""

    def open_both(
        fmi_version: int,
        plant: dict | None = None,
        controller: dict | None = None,
        reference: Callable[[float], float] = sinusoids,
        sample_time: float = 1e-4,
    ) -> BallLoop:
        models = (open_fmu(fmu_path(fmi_version, model)) for model in BALL_MODELS)
        loop = BallLoop(*models, reference, sample_time)
        loop.initialize(plant or {}, {"observer.initial.flux": 0.9 * CARRYING_FLUX, **(controller or {})})
        return loop

    return open_both


def test_drem_at_a_tenth_of_a_millisecond(fmi_version: int, open_ball: OpenBall) -> None:
    loop = open_ball(fmi_version)
    rows = loop.run(3.0)
    tail = rows[-10_000:]
    assert root_mean_square(flux_error(rows[:1000])) > 0.05, "the flux is wrong at the start"
    assert np.abs(flux_error(tail)).max() <= 0.01
    assert root_mean_square(deviation(tail)) <= 1e-4
    assert loop.plant.get("contact") is False
    assert loop.controller.get("observer.active") is True
    assert abs(loop.controller.get("observer.excitation")) > 0.0


@pytest.mark.parametrize("kind", ["polynomial_newton", "polynomial_newton_adaptive"])
@pytest.mark.parametrize(("reference", "bound"), [(sinusoids, 1e-3), (rest, 1e-9)], ids=["sinusoids", "constant"])
def test_newton_at_a_millisecond(
    fmi_version: int, kind: str, reference: Callable[[float], float], bound: float, open_ball: OpenBall
) -> None:
    controller = {"observer.kind": kind, "observer.startup_hold": 0.02}
    rows = open_ball(fmi_version, None, controller, reference, 1e-3).run(4.0)
    tail = rows[-1000:]
    assert np.abs(flux_error(tail)).max() <= bound
    assert root_mean_square(deviation(tail)) <= 1e-4


def test_drem_needs_excitation(open_ball: OpenBall) -> None:
    rows = open_ball(3, reference=rest).run(2.0)
    assert abs(flux_error(rows)[-1]) > 0.09


def test_state_feedback_ignores_the_estimate(fmi_version: int, open_ball: OpenBall) -> None:
    controller = {"controller.feedback": "state", "observer.gain": 0.0}
    rows = open_ball(fmi_version, None, controller).run(1.0)
    assert np.abs(deviation(rows[5000:])).max() <= 2e-5
    assert np.abs(flux_error(rows)).min() > 0.09


def test_a_wrong_resistance_is_learnt(fmi_version: int, open_ball: OpenBall) -> None:
    controller = {"observer.kind": "polynomial_newton_adaptive", "observer.startup_hold": 0.02}
    loop = open_ball(fmi_version, {"resistance": 2.52 * 1.01}, controller)
    rows = loop.run(3.0)
    assert loop.controller.get("observer.estimated_resistance") == pytest.approx(2.52 * 1.01, rel=1e-3)
    assert np.abs(flux_error(rows[-10_000:])).max() <= 1e-3


def test_without_voltage_the_ball_falls_onto_the_lower_stop(
    fmi_version: int, open_fmu: Callable[[Path], Fmu]
) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    plant.initialize({"initial.flux": 0.0, "lower_stop": -0.01})
    fall = math.sqrt(2.0 * 0.01 / 9.81)  # s, of a free fall from 0 to the stop
    before, after = math.floor(fall / 1e-3), math.ceil(fall / 1e-3)
    for k in range(after + 5):
        plant.step(k * 1e-3, 1e-3)
        assert plant.get("contact") is (k + 1 >= after)
        if k + 1 == before:
            assert plant.get("position") == pytest.approx(-0.5 * 9.81 * (before * 1e-3) ** 2, rel=1e-9)
    assert plant.get("position") == -0.01
    assert plant.get("velocity") == 0.0


def test_too_much_voltage_pulls_the_ball_to_the_magnet(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    plant.initialize({"voltage": 5.0})
    for k in range(200):
        plant.step(k * 1e-3, 1e-3)
    assert plant.get("contact") is True
    assert plant.get("position") == 0.005
    # Against the magnet there is no gap left that the flux would need a current for.
    assert plant.get("current") == 0.0


def test_noise_has_the_given_spread_and_repeats(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    def errors(seed: int) -> np.ndarray:
        plant = open_fmu(fmu_path(fmi_version, PLANT))
        plant.initialize({"sensor.noise": 1e-3, "sensor.seed": seed})
        readings = []
        for k in range(2000):
            plant.step(k * 1e-4, 1e-4)
            current, reading = plant.get_reals(["current", "current_measured"])
            readings.append(reading - current)
        return np.array(readings)

    first = errors(7)
    assert root_mean_square(first) == pytest.approx(1e-3, rel=0.08)  # 5 standard deviations of the estimate
    assert (errors(7) == first).all()
    assert (errors(8) != first).any()


@pytest.mark.parametrize(
    ("model", "values", "message"),
    [
        (PLANT, {"voltage": math.nan}, ["voltage", "NaN V", "finite"]),
        (PLANT, {"force": math.inf}, ["force", "inf N", "finite"]),
        (PLANT, {"mass": 0.0}, ["mass", "0 kg", "expected 1e-6 to 1000 kg"]),
        (PLANT, {"resistance": -1.0}, ["resistance", "-1 "]),
        (CONTROLLER, {"current": math.nan}, ["current", "NaN A", "finite"]),
        (CONTROLLER, {"reference": math.inf}, ["reference", "inf m"]),
        (CONTROLLER, {"observer.kind": 4}, ["observer.kind", "= 4", "item of BallObserver, 1 to 3"]),
        (CONTROLLER, {"observer.prefilter[1]": 0.0}, ["observer.prefilter[1]", "0 1/s"]),
        (CONTROLLER, {"observer.gain": -1.0}, ["observer.gain", "-1 1/s"]),
    ],
    ids=lambda value: str(value) if isinstance(value, dict) else "",
)
def test_bad_values_are_refused_with_reason(
    fmi_version: int,
    model: str,
    values: dict,
    message: list[str],
    open_fmu: Callable[[Path], Fmu],
    messages: list[str],
) -> None:
    fmu = open_fmu(fmu_path(fmi_version, model))
    with pytest.raises(FMICallException):
        fmu.set(values)
    assert [part for part in message if part not in messages[-1]] == [], messages
    fmu.initialize()
    for name in values:
        start = fmu.variables[name].start
        assert fmu.get(name) == ("drem" if name == "observer.kind" else float(start)), name
    fmu.step(0.0, 1e-4)


def test_no_start_with_equal_prefilters(fmi_version: int, open_fmu: Callable[[Path], Fmu], messages: list[str]) -> None:
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    with pytest.raises(FMICallException):
        controller.initialize({"observer.prefilter[1]": 300.0})
    assert "observer.prefilter[1]" in messages[-1] and "300 1/s" in messages[-1], messages
    # Still in initialisation.
    controller.set({"observer.prefilter[1]": 100.0})
    controller.slave.exitInitializationMode()
    controller.step(0.0, 1e-4)
