"""Plants solved by an importer's CVODE: the result is that of co-simulation, which solves them itself."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from packages import all_fmus, fmu_path


class Run(NamedTuple):
    """A plant with parameters and input signals, as rows of (time, value, ...)."""

    model: str
    start_values: dict[str, float | str]
    inputs: list[str]
    signal: list[tuple[float, ...]]
    stop_time: float
    output_interval: float


RUNS = {
    # The flux starts with one sign and crosses zero.
    "bearing": Run(
        "MagneticBearingPlant",
        {"initial.flux": 0.05, "initial.velocity": -0.02, "bias_flux": 1e-4},
        ["voltage"],
        [(0.0, -2.0), (0.04, -2.0), (0.04, 3.0), (0.1, 3.0)],
        0.1,
        1e-3,
    ),
    # The ball hangs, is let go, falls onto the lower stop and is drawn up to the magnet.
    "ball": Run(
        "LevitatedBallPlant",
        {},
        ["voltage", "force"],
        [(0.0, 0.0, 0.0), (0.15, 0.0, 0.0), (0.15, 30.0, 0.0), (0.4, 30.0, 0.0)],
        0.4,
        1e-3,
    ),
    # The ball falls onto the lower stop and is drawn up to the coil.
    "rig": Run(
        "MaglevRigPlant",
        {"initial.velocity": 0.01},
        ["voltage", "force"],
        [(0.0, 0.5, 0.0), (0.2, 0.5, 0.0), (0.2, 4.0, 0.0), (0.4, 4.0, 0.0)],
        0.4,
        1e-3,
    ),
}


def plants() -> list[Path]:
    """All FMUs for model exchange."""
    paths = all_fmus()
    return [path for path in paths if read_model_description(path).modelExchange is not None]


def states(path: Path) -> list[str]:
    return [unknown.variable.derivative.name for unknown in read_model_description(path).derivatives]


def signal(run: Run) -> np.ndarray:
    return np.array(run.signal, dtype=[("time", float), *((name, float) for name in run.inputs)])


def simulate(run: Run, path: Path, interface: str, **options: object) -> np.ndarray:
    return simulate_fmu(
        path,
        fmi_type=interface,
        stop_time=run.stop_time,
        output_interval=run.output_interval,
        start_values=run.start_values,
        input=signal(run),
        output=states(path),
        **options,
    )


def test_every_plant_offers_both_interfaces_and_is_run_here() -> None:
    for path in plants():
        description = read_model_description(path)
        assert description.coSimulation is not None
        assert path.stem in {run.model for run in RUNS.values()}, f"no run of {path.stem}"
    assert {path.parent.name for path in plants()} == {"fmi2", "fmi3"}


@pytest.mark.parametrize("name", RUNS)
def test_cvode_gives_the_result_of_co_simulation(fmi_version: int, name: str) -> None:
    run = RUNS[name]
    path = fmu_path(fmi_version, run.model)
    solved = simulate(run, path, "ModelExchange", relative_tolerance=1e-10, record_events=False)
    stepped = simulate(run, path, "CoSimulation")
    np.testing.assert_allclose(solved["time"], stepped["time"], rtol=0, atol=1e-12)
    for state in states(path):
        size = max(np.abs(stepped[state]).max(), 1e-12)
        error = np.abs(solved[state] - stepped[state]).max() / size
        assert error < 1e-6, f"{state}: {error:.2e}"


@pytest.mark.parametrize("path", plants(), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_runs_by_default(path: Path) -> None:
    result = simulate_fmu(path, fmi_type="ModelExchange", stop_time=0.2)
    assert result["time"][-1] == pytest.approx(0.2)
    assert all(np.isfinite(result[name].astype(float)).all() for name in result.dtype.names)


def test_the_rigs_current_flows_and_its_sensor_is_read(fmi_version: int) -> None:
    """What follows from the inputs does so at each instant; a sensor with a sample time is read at its multiples."""
    run = RUNS["rig"]
    outputs = ["current", "voltage_measured", "sensor_voltage", "sensor_voltage_measured"]
    readings: dict[float, np.ndarray] = {}
    for sample_time in [0.0, 0.01]:
        result = simulate_fmu(
            fmu_path(fmi_version, run.model),
            fmi_type="ModelExchange",
            stop_time=0.1,
            output_interval=1e-3,
            start_values={"voltage": 0.76, "sensor.noise": 1e-3, "sensor.sample_time": sample_time},
            output=outputs,
            record_events=False,
        )
        np.testing.assert_allclose(result["voltage_measured"], 0.76, rtol=1e-15)
        np.testing.assert_allclose(result["current"], 0.798, rtol=1e-12)
        readings[sample_time] = result["sensor_voltage_measured"] - result["sensor_voltage"]
        held = np.diff(result["sensor_voltage_measured"]) == 0
        if sample_time:
            # Ten readings in 100 intervals.
            assert 8 <= np.count_nonzero(~held) <= 11
    assert np.all(readings[0.0] == 0.0)
    assert np.any(np.abs(readings[0.01]) > 1e-4)
