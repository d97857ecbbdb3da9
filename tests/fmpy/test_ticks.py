"""Ticks of a sampled controller: within steps, as events, and scheduled, by fmpy and by fmuloader; the same bits."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from ctypes import c_double, c_int, c_uint32
from pathlib import Path

import numpy as np
import pytest
from bearing import bits
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi3 import FMU3ScheduledExecution, FMU3Slave
from fmuloader.fmi3 import Fmi3IntervalQualifier, Fmi3Slave
from packages import CONTROLLER, FMI_VERSIONS, all_fmus, clocked_path, fmu_path

STOP_TIME = 0.5  # s
OUTPUTS = ["voltage", "estimate.velocity", "estimate.flux", "tick_time"]
Trajectory = list[tuple[int, ...]]


def position(time: float) -> float:
    """Input [m] from `time` [s] on, constant over a sample."""
    return 0.01 + 0.003 * np.sin(300.0 * time)


@pytest.fixture
def controller(tmp_path: Path) -> Iterator[tuple[str, object]]:
    """Directory and description of the unpacked controller of FMI 3.0."""
    path = clocked_path(CONTROLLER)
    folder = extract(path, unzipdir=str(tmp_path / "fmu"))
    yield folder, read_model_description(path)
    shutil.rmtree(folder)


def references(description: object) -> dict[str, int]:
    return {variable.name: variable.valueReference for variable in description.modelVariables}


class Fmpy:
    """fmpy's class for scheduled execution with the methods that `scheduled` needs."""

    def __init__(self, folder: str, description: object) -> None:
        identifier = description.scheduledExecution.modelIdentifier
        self.model = FMU3ScheduledExecution(
            guid=description.guid, unzipDirectory=folder, modelIdentifier=identifier, instanceName="scheduled"
        )
        self.model.instantiate()
        self.put, self.get = self.model.setFloat64, self.model.getFloat64
        self.activate = self.model.activateModelPartition

    def initialize(self, tick: int) -> float:
        """Interval of the clock `tick` [s]."""
        self.model.enterInitializationMode()
        interval, qualifier = c_double(), c_int()
        self.model.fmi3GetIntervalDecimal(self.model.component, (c_uint32 * 1)(tick), 1, interval, qualifier)
        assert qualifier.value == Fmi3IntervalQualifier.INTERVAL_CHANGED
        self.model.exitInitializationMode()
        return interval.value

    def close(self) -> None:
        self.model.terminate()
        self.model.freeInstance()


class Fmuloader:
    """fmuloader, which passes no callbacks."""

    def __init__(self, _: str, description: object) -> None:
        self.model = Fmi3Slave(clocked_path(CONTROLLER), model_identifier=CONTROLLER)
        self.model.instantiate_scheduled_execution("scheduled", instantiation_token=description.guid)
        self.put, self.get = self.model.set_float64, self.model.get_float64
        self.activate = self.model.activate_model_partition

    def initialize(self, tick: int) -> float:
        self.model.enter_initialization_mode(start_time=0.0)
        [interval], _ = self.model.get_interval_decimal([tick])
        [counter], [resolution], _ = self.model.get_interval_fraction([tick])
        assert counter / resolution == interval
        assert self.model.get_shift_decimal([tick]) == [0.0]
        self.model.exit_initialization_mode()
        return interval

    def close(self) -> None:
        self.model.terminate()
        self.model.free_instance()


def scheduled(model: Fmpy | Fmuloader, by_name: dict[str, int]) -> Trajectory:
    """Rows after each tick."""
    interval = model.initialize(by_name["tick"])
    rows = []
    for k in range(round(STOP_TIME / interval)):
        time = k * interval
        model.put([by_name["position"]], [position(time)])
        model.activate(by_name["tick"], time)
        rows.append(bits(model.get([by_name[name] for name in OUTPUTS])))
    model.close()
    return rows


def stepped(path: Path, *, event_mode: bool, step_size: float = 1e-3) -> Trajectory:
    """Rows at the end of each step of fmpy's own simulation, that is after the tick at its start."""
    count = round(STOP_TIME / 1e-3)
    signal = np.array([(k * 1e-3, position(k * 1e-3)) for k in range(count + 1)], [("time", "f8"), ("position", "f8")])
    result = simulate_fmu(
        str(path),
        stop_time=STOP_TIME,
        output_interval=step_size,
        input=hold(signal),
        output=OUTPUTS,
        use_event_mode=event_mode,
        early_return_allowed=event_mode,
        fmi_type="CoSimulation",
    )
    return [bits([row[name] for name in OUTPUTS]) for row in result]


def hold(signal: np.ndarray) -> np.ndarray:
    """The signal as steps: two rows at each jump, the value before and the one after."""
    rows = [signal[0]]
    for before, after in zip(signal, signal[1:], strict=False):
        rows += [(after["time"], before["position"]), tuple(after)]
    return np.array([tuple(row) for row in rows], signal.dtype)


@pytest.mark.parametrize("importer", [Fmpy, Fmuloader])
def test_schedulers_get_the_ticks_of_steps(importer: type, controller: tuple[str, object]) -> None:
    folder, description = controller
    by_name = references(description)
    rows = scheduled(importer(folder, description), by_name)
    assert len(set(rows)) == len(rows) == 500
    model = Fmi3Slave(clocked_path(CONTROLLER), model_identifier=CONTROLLER)
    model.instantiate_co_simulation("stepped", instantiation_token=description.guid)
    model.enter_initialization_mode(start_time=0.0)
    model.exit_initialization_mode()
    expected = []
    for k in range(len(rows)):
        model.set_float64([by_name["position"]], [position(k * 1e-3)])
        model.do_step(k * 1e-3, 1e-3)
        expected.append(bits(model.get_float64([by_name[name] for name in OUTPUTS])))
    model.terminate()
    model.free_instance()
    assert rows == expected


@pytest.mark.parametrize("step_size", [1e-3, 5e-4, 2.5e-4])
def test_fmpy_gets_the_same_ticks_with_and_without_events(step_size: float) -> None:
    """With events every tick is sampled, whatever the step; the last row per tick is what holds until the next."""
    without = stepped(clocked_path(CONTROLLER), event_mode=False, step_size=step_size)
    for fmi_version in FMI_VERSIONS:
        assert without == stepped(fmu_path(fmi_version, CONTROLLER), event_mode=False, step_size=step_size)
    with_events = stepped(clocked_path(CONTROLLER), event_mode=True, step_size=step_size)
    # Rows of one tick are equal; with events the tick at the end of the simulation is run, too.
    ticks = list(dict.fromkeys(without))
    ticks_of_events = list(dict.fromkeys(with_events))
    assert len(ticks) > 400
    first = next((k for k, pair in enumerate(zip(ticks[1:], ticks_of_events, strict=False)) if pair[0] != pair[1]), None)
    assert first is None, f"tick {first}"


def test_clocked_packages_and_no_others_can_be_scheduled() -> None:
    clocked = [path for path in all_fmus() if path.parent.name == "fmi3-clocked"]
    controllers = {path.stem for path in all_fmus() if path.stem.endswith("Controller")}
    assert {path.stem for path in clocked} == controllers
    for path in all_fmus():
        description = read_model_description(path)
        clocks = {variable.name for variable in description.modelVariables if variable.type == "Clock"}
        has_clocks = path in clocked
        assert (description.scheduledExecution is not None) == has_clocks
        assert clocks == ({"tick", "ticked"} if has_clocks else set())
        assert bool(description.coSimulation.hasEventMode) == has_clocks


def test_plain_package_refuses_events_and_names_the_other(tmp_path: Path) -> None:
    path = fmu_path(3, CONTROLLER)
    description = read_model_description(path)
    messages = []
    model = FMU3Slave(
        guid=description.guid,
        unzipDirectory=extract(path, unzipdir=str(tmp_path)),
        modelIdentifier=CONTROLLER,
        instanceName="plain",
    )
    with pytest.raises(Exception, match="instantiate"):
        model.instantiate(eventModeUsed=True, logMessage=lambda *arguments: messages.append(arguments[-1].decode()))
    assert any(f"fmi3-clocked/{CONTROLLER}.fmu" in message for message in messages), messages
    model.freeLibrary()
