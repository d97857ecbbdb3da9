"""The controller ticks at multiples of its sample time, however the importer cuts time into steps."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from ctypes import byref, c_bool, c_double, c_uint32
from fractions import Fraction
from itertools import repeat
from pathlib import Path

import pytest
from bearing import ESTIMATE, SAMPLE_TIME, bits
from cosimulation import Fmu
from fmpy.fmi1 import FMICallException
from packages import CONTROLLER, fmu_path

DURATION = 100  # s
SAMPLE = Fraction(1, 1000)  # s
STEP_SIZES = [Fraction(1, 1000), Fraction(1, 4000), Fraction(37, 10_000), Fraction(1, 60)]  # s
OBSERVED = ["tick_time", "voltage", *ESTIMATE, "observer.residual"]
Row = tuple[int, ...]


class Stepper:
    """Steps a controller and reads some outputs through the C functions, without allocating anything."""

    def __init__(self, controller: Fmu) -> None:
        references = [controller.variables[name].valueReference for name in OBSERVED]
        self.count = len(references)
        self.references = (c_uint32 * self.count)(*references)
        self.values = (c_double * self.count)()
        self.component = controller.slave.component
        self.read_arguments: list = [self.component, self.references, self.count, self.values]
        library = controller.slave.dll
        if controller.fmi_version == 2:
            self.do_step, self.read = library.fmi2DoStep, library.fmi2GetReal
            self.step_arguments: list = [1]
        else:
            self.do_step, self.read = library.fmi3DoStep, library.fmi3GetFloat64
            self.read_arguments.append(self.count)
            flags = [c_bool() for _ in range(3)]
            self.step_arguments = [True, *map(byref, flags), byref(c_double())]

    def step(self, time: float, step_size: float) -> list[float]:
        assert self.do_step(self.component, time, step_size, *self.step_arguments) == 0
        assert self.read(*self.read_arguments) == 0
        return self.values[:]


def whole_steps(step_size: Fraction) -> int:
    return math.floor(DURATION / step_size)


def times_by_multiplication(step_size: Fraction) -> Iterator[tuple[float, float]]:
    """Communication points and step sizes as a careful importer gives them: t = n h."""
    return ((float(n * step_size), float(step_size)) for n in range(whole_steps(step_size)))


def times_by_addition(step_size: Fraction) -> Iterator[tuple[float, float]]:
    """An importer that accumulates t += h, rounding included."""
    time = 0.0
    for size in repeat(float(step_size), whole_steps(step_size)):
        yield time, size
        time += size


def times_by_subtraction(step_size: Fraction) -> Iterator[tuple[float, float]]:
    """An importer that computes h as the difference of two communication points."""
    points = [float(n * step_size) for n in range(whole_steps(step_size) + 1)]
    return ((time, after - time) for time, after in zip(points, points[1:]))


def times_with_noise(step_size: Fraction) -> Iterator[tuple[float, float]]:
    """Step sizes off by up to 3 units in the last place, communication points by up to 2."""
    numbers = random.Random(5)
    for n in range(whole_steps(step_size)):
        time, size = float(n * step_size), float(step_size)
        yield (
            time + numbers.randint(-2, 2) * math.ulp(time) * (n > 0),
            size + numbers.randint(-3, 3) * math.ulp(size),
        )


IMPORTERS = [times_by_multiplication, times_by_addition, times_by_subtraction, times_with_noise]


def run(controller: Fmu, points: Iterator[tuple[float, float]]) -> list[list[float]]:
    """What is observed after each step under a constant input."""
    controller.initialize({"position": 0.003})
    stepper = Stepper(controller)
    return [stepper.step(time, size) for time, size in points]


@pytest.fixture(scope="module")
def outputs_of_tick() -> list[Row]:
    """Bits of the outputs at each tick, stepped by the sample time."""
    with Fmu(fmu_path(2, CONTROLLER)) as controller:
        return [bits(row) for row in run(controller, times_by_multiplication(SAMPLE))]


@pytest.mark.parametrize("importer", IMPORTERS, ids=lambda importer: importer.__name__)
@pytest.mark.parametrize("step_size", STEP_SIZES, ids=lambda size: f"{float(size):.3g}s")
def test_ticks_and_bits_do_not_depend_on_the_steps(
    fmi_version: int,
    step_size: Fraction,
    importer: Callable[[Fraction], Iterator[tuple[float, float]]],
    outputs_of_tick: list[Row],
    open_fmu: Callable[[Path], Fmu],
) -> None:
    rows = run(open_fmu(fmu_path(fmi_version, CONTROLLER)), importer(step_size))
    assert len(rows) == whole_steps(step_size)
    # The last tick before (n + 1) h, in whole numbers.
    periods = step_size / SAMPLE
    ticks = [-(-(n + 1) * periods.numerator // periods.denominator) - 1 for n in range(len(rows))]
    assert [row[0] for row in rows] == [tick * SAMPLE_TIME for tick in ticks]
    assert [bits(row) for row in rows] == [outputs_of_tick[tick] for tick in ticks]


@pytest.mark.parametrize("size", [0.09999999999999998, 0.1, 0.10000000000000003])
def test_steps_as_importers_are_known_to_round_them(
    fmi_version: int, size: float, open_fmu: Callable[[Path], Fmu]
) -> None:
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    controller.initialize({"sample_time": 0.1})
    for k, time in enumerate([0.0, 0.1, 0.2, 0.30000000000000004, 0.4, 0.5, 0.6, 0.7, 0.7999999999999999]):
        controller.step(time, size)
        assert controller.get("tick_time") == k * 0.1


def test_a_step_holds_all_ticks_from_its_start_up_to_but_not_including_its_end(
    fmi_version: int, open_fmu: Callable[[Path], Fmu]
) -> None:
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    controller.initialize({"sample_time": 0.25})
    seen = []
    for n in range(8):
        controller.step(n * 0.125, 0.125)
        seen.append(controller.get("tick_time"))
    assert seen == [0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75]


def test_ticks_are_multiples_of_the_sample_time_for_any_start(
    fmi_version: int, open_fmu: Callable[[Path], Fmu]
) -> None:
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    controller.initialize({"sample_time": 0.25}, start_time=1.1)
    assert controller.get("tick_time") == 1.1
    controller.step(1.1, 0.15)
    assert controller.get("voltage") == 0.0
    controller.step(1.25, 0.05)
    assert (controller.get("tick_time"), controller.get("voltage")) == (1.25, -150.0)


def test_steps_end_at_the_stop_time(fmi_version: int, open_fmu: Callable[[Path], Fmu]) -> None:
    """ "If the environment tries to compute past stopTime, the FMU has to return Error"; rounding is none."""
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    controller.initialize(stop_time=0.01)
    for k in range(9):
        controller.step(k * 1e-3, 1e-3)
    with pytest.raises(FMICallException):
        controller.step(9e-3, 2e-3)
    controller.step(9e-3, 1e-3 + 1e-12)
    assert controller.get("tick_time") == 9 * 1e-3
