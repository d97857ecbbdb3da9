"""Every FMU there is: at home in fmpy's `simulate_fmu`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from cosimulation import Fmu, Value, enumeration_items
from fmpy import read_model_description, simulate_fmu
from fmpy.model_description import ModelVariable
from packages import FMI_VERSIONS, MODELS, dist

REALS = ("Real", "Float64")


def real_inputs(fmu: Path) -> list[ModelVariable]:
    variables = read_model_description(fmu).modelVariables
    return [variable for variable in variables if variable.causality == "input" and variable.type in REALS]


def input_signals(fmu: Path) -> np.ndarray:
    """A small oscillation around each real input's start value, given at times that are no communication points."""
    inputs = real_inputs(fmu)
    signals = np.zeros(41, dtype=[("time", np.float64), *((variable.name, np.float64) for variable in inputs)])
    signals["time"] = np.linspace(0.0, 1.0, len(signals)) ** 1.5
    for variable in inputs:
        nominal = float(variable.nominal or variable.declaredType.nominal)
        signals[variable.name] = float(variable.start) + 1e-3 * nominal * np.sin(20.0 * signals["time"])
    return signals


def assert_sound(result: np.ndarray, fmu: Path, stop_time: float) -> None:
    """All outputs recorded up to the end, all finite."""
    variables = read_model_description(fmu).modelVariables
    outputs = {v.name for v in variables if v.causality == "output" and v.type != "Clock"}
    assert set(result.dtype.names) == {"time", *outputs}
    assert result["time"][-1] == pytest.approx(stop_time, rel=1e-12)
    assert all(np.isfinite(result[name].astype(float)).all() for name in result.dtype.names)


def test_both_versions_hold_the_same_models() -> None:
    names = [{path.stem for path in dist().glob(f"fmi{version}/*.fmu")} for version in FMI_VERSIONS]
    assert names[0] == names[1]
    assert set(MODELS) <= names[0]


def test_runs_with_defaults(any_fmu: Path) -> None:
    experiment = read_model_description(any_fmu).defaultExperiment
    assert_sound(simulate_fmu(any_fmu), any_fmu, float(experiment.stopTime))


def test_runs_with_input_signals(any_fmu: Path) -> None:
    signals = input_signals(any_fmu)
    assert_sound(simulate_fmu(any_fmu, stop_time=1.0, input=signals), any_fmu, 1.0)


@pytest.mark.parametrize("output_interval", [1 / 60, 0.01, 0.00037])
def test_runs_with_any_output_interval(any_fmu: Path, output_interval: float) -> None:
    result = simulate_fmu(any_fmu, stop_time=0.5, output_interval=output_interval)
    assert_sound(result, any_fmu, 0.5)
    np.testing.assert_allclose(np.diff(result["time"])[:-1], output_interval, rtol=1e-9)


def start_value(variable: ModelVariable) -> Value:
    """Start value as `Fmu.get` returns it."""
    if variable.type == "Boolean":
        return variable.start == "true"
    number = variable._python_type(variable.start)
    if variable.type == "Enumeration":
        return next(item for item, value in enumeration_items(variable).items() if value == number)
    return number


def test_start_values_are_what_the_description_says(any_fmu: Path, open_fmu: Callable[[Path], Fmu]) -> None:
    fmu = open_fmu(any_fmu)
    fmu.initialize()
    for variable in fmu.variables.values():
        if variable.start is not None:
            assert fmu.get(variable.name) == start_value(variable), variable.name
