"""The plant FMU alone: its steps are the exact solution of x1' = x2, x2' = epsilon x3 + x3 |x3|, x3' = u."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
from bearing import STATE
from cosimulation import Fmu
from packages import PLANT, fmu_path

# Flux in Wb and voltage in V: without and with a change of the flux's sign within a second, and standing still.
STARTS = [(0.02, 0.05), (0.02, -0.05), (-0.02, 0.05), (1e-9, -150.0), (0.0, 0.3), (0.05, 0.0), (0.02, -0.02)]
BIASES = [0.0, 1e-4, 1e-3]  # Wb
State = tuple[Fraction, Fraction, Fraction]


def polynomial_step(state: State, voltage: Fraction, time: Fraction, epsilon: Fraction, sign: int) -> State:
    """Map (4a) of the paper, exact while the flux has the given sign."""
    x1, x2, x3 = state
    force = epsilon * x3 + sign * x3**2
    slope = voltage * (epsilon + 2 * sign * x3)
    return (
        x1 + time * x2 + time**2 / 2 * force + time**3 / 6 * slope + time**4 / 12 * voltage**2 * sign,
        x2 + time * force + time**2 / 2 * slope + time**3 / 3 * voltage**2 * sign,
        x3 + voltage * time,
    )


def exact_step(state: State, voltage: Fraction, time: Fraction, epsilon: Fraction) -> State:
    """Solution after `time` s in rational numbers, split where the flux crosses zero."""
    flux = state[2]
    sign = 1 if flux > 0 or (flux == 0 and voltage > 0) else -1
    if flux * (flux + voltage * time) >= 0:
        return polynomial_step(state, voltage, time, epsilon, sign)
    crossing = -flux / voltage
    x1, x2, _ = polynomial_step(state, voltage, crossing, epsilon, sign)
    return polynomial_step((x1, x2, Fraction(0)), voltage, time - crossing, epsilon, -sign)


def initial(position: float, velocity: float, flux: float, bias_flux: float) -> dict[str, float]:
    return {
        "initial.position": position,
        "initial.velocity": velocity,
        "initial.flux": flux,
        "bias_flux": bias_flux,
    }


@pytest.mark.parametrize("bias_flux", BIASES)
def test_a_step_is_the_exact_solution(fmi_version: int, bias_flux: float, open_fmu: Callable[[Path], Fmu]) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    numbers = random.Random(1)
    for _ in range(200):
        start = [numbers.uniform(-0.01, 0.01), numbers.uniform(-0.1, 0.1), numbers.uniform(-0.2, 0.2)]
        voltage, duration = numbers.choice([-1.0, 1.0]) * 10.0 ** numbers.uniform(-3, 2), 10.0 ** numbers.uniform(-4, 0)
        plant.initialize(initial(*start, bias_flux))
        plant.set({"voltage": voltage})
        plant.step(0.0, duration)
        epsilon = Fraction(plant.get("epsilon"))
        expected = exact_step(tuple(map(Fraction, start)), Fraction(voltage), Fraction(duration), epsilon)
        scale = [1.0 + abs(float(value)) for value in expected]
        for got, want, size in zip(plant.get_reals(STATE), expected, scale):
            assert abs(got - float(want)) < 1e-15 * size * 8
        plant.slave.reset()


@pytest.mark.parametrize("bias_flux", BIASES)
@pytest.mark.parametrize(("flux", "voltage"), STARTS)
def test_one_step_of_1_s_equals_1000_of_1_ms(
    fmi_version: int, flux: float, voltage: float, bias_flux: float, open_fmu: Callable[[Path], Fmu]
) -> None:
    ends = []
    for steps in (1, 1000):
        plant = open_fmu(fmu_path(fmi_version, PLANT))
        plant.initialize(initial(0.01, -0.02, flux, bias_flux))
        plant.set({"voltage": voltage})
        for k in range(steps):
            plant.step(k / steps, 1.0 / steps)
        ends.append(plant.get_reals(STATE))
    # The scale is the start's where a component happens to end near 0.
    for one, many, size in zip(*ends, (0.01, 0.02, max(abs(flux), abs(voltage)))):
        assert abs(one - many) <= 1e-12 * max(abs(many), size)


def test_the_voltage_that_acted_is_echoed(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    plant.initialize({"voltage": 3.0})
    assert plant.get("voltage_measured") == 0.0
    plant.step(0.0, 1e-3)
    plant.set({"voltage": -4.0})
    assert plant.get("voltage_measured") == 3.0
    plant.step(1e-3, 1e-3)
    assert plant.get("voltage_measured") == -4.0


def test_sensor_noise_has_the_given_spread_and_repeats(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    def errors(seed: int) -> list[float]:
        plant = open_fmu(fmu_path(fmi_version, PLANT))
        plant.initialize({"sensor.noise": 1e-6, "sensor.seed": seed})
        readings = []
        for k in range(2000):
            plant.step(k * 1e-3, 1e-3)
            position, reading = plant.get_reals(["position", "position_measured"])
            readings.append(reading - position)
        return readings

    first = errors(7)
    spread = (sum(error**2 for error in first) / len(first)) ** 0.5
    assert spread == pytest.approx(1e-6, rel=0.08)  # 5 standard deviations of the estimate
    assert errors(7) == first
    assert errors(8) != first


def test_resolution_rounds_the_reading(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    plant.initialize({"sensor.resolution": 1e-3, "initial.position": 0.00237})
    assert plant.get("position_measured") == pytest.approx(0.002, rel=1e-15)
