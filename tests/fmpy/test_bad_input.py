"""What is wrong is refused with a message that says so, and leaves the instance as it was."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from bearing import Loop, bits
from cosimulation import Fmu
from fmpy.fmi1 import FMICallException
from packages import BEARING_MODELS, CONTROLLER, PLANT, MODELS, fmu_path

ERROR = 3  # status of both FMI versions
DONE = 50  # samples before the offence
TIME = DONE * 1e-3  # s
NAN, INFINITY = math.nan, math.inf


class Offence(NamedTuple):
    """A call that must be refused, and what the message must hold."""

    name: str
    model: str
    call: Callable[[Fmu], object]
    message: list[str]


def setting(model: str, variable: str, value: float | int, message: list[str]) -> Offence:
    return Offence(f"{variable}={value}", model, lambda fmu: fmu.set({variable: value}), [variable, *message])


def stepping(model: str, time: float, step_size: float, message: list[str]) -> Offence:
    return Offence(f"{model}-step-{time}-{step_size}", model, lambda fmu: fmu.step(time, step_size), message)


def call_by_reference(fmu: Fmu, verb: str, *arguments: list) -> object:
    """Get or set reals by value reference."""
    return getattr(fmu.slave, verb + ("Real" if fmu.fmi_version == 2 else "Float64"))(*arguments)


def reading(model: str, references: list[int], message: list[str]) -> Offence:
    return Offence(f"{model}-get-{references}", model, lambda fmu: call_by_reference(fmu, "get", references), message)


REAL_INPUTS = [
    (PLANT, "voltage", "V"),
    (CONTROLLER, "position", "m"),
    (CONTROLLER, "voltage_applied", "V"),
    (CONTROLLER, "state.velocity", "m/s"),
    (CONTROLLER, "state.flux", "Wb"),
]
NOT_FINITE = [
    setting(model, name, value, [f"{text} {unit_name}", "finite"])
    for model, name, unit_name in REAL_INPUTS
    for value, text in [(NAN, "NaN"), (INFINITY, "inf"), (-INFINITY, "-inf")]
]
OUT_OF_RANGE = [
    setting(CONTROLLER, "observer.step_size", 0.0, ["0 1", "expected 0.001 to 1 1"]),
    setting(CONTROLLER, "observer.step_size", NAN, ["NaN 1", "finite"]),
    setting(CONTROLLER, "observer.max_iterations", 0, ["= 0", "expected 1 to 1000"]),
    setting(CONTROLLER, "observer.max_iterations", 1001, ["= 1001", "expected 1 to 1000"]),
    setting(CONTROLLER, "controller.voltage_limit", -1.0, ["-1 V", "expected 0 to 1000000 V"]),
    setting(PLANT, "sensor.noise", -1e-6, ["-1e-6 m", "expected 0 to 1 m"]),
    setting(CONTROLLER, "controller.law", 0, ["= 0", "item of BearingLaw, 1 to"]),
    setting(CONTROLLER, "controller.law", 99, ["= 99", "item of BearingLaw, 1 to"]),
    setting(CONTROLLER, "controller.feedback", -1, ["= -1", "item of Feedback, 1 to 2"]),
]
NOT_SETTABLE = [
    setting(CONTROLLER, "sample_time", 2e-3, ["fixed parameter", "step mode"]),
    setting(CONTROLLER, "observer.kind", 1, ["fixed parameter", "step mode"]),
    setting(PLANT, "initial.position", 0.0, ["fixed parameter", "step mode"]),
    setting(PLANT, "sensor.seed", 2, ["fixed parameter", "step mode"]),
    setting(PLANT, "position", 0.0, ["is a continuous state", "step mode"]),
    setting(PLANT, "epsilon", 0.0, ["calculated by the model"]),
    setting(CONTROLLER, "time", 0.0, ["independent variable"]),
]
WRONG_REFERENCE = [
    reading(PLANT, [999], ["999", "unknown", "expected 0 to"]),
    reading(CONTROLLER, [1, 999], ["999", "unknown", "expected 0 to"]),
    Offence(
        "set-999",
        CONTROLLER,
        lambda fmu: call_by_reference(fmu, "set", [1, 999], [0.5, 0.5]),
        ["999", "unknown"],
    ),
    Offence("get-another-type", CONTROLLER, lambda fmu: fmu.slave.getBoolean([1]), ["position", "a real variable"]),
]
WRONG_TIME = [
    stepping(model, *arguments)
    for model in BEARING_MODELS
    for arguments in [
        (TIME, 0.0, ["communicationStepSize", "0 s", "greater than 0"]),
        (TIME, -1e-3, ["communicationStepSize", "-0.001 s", "greater than 0"]),
        (TIME, NAN, ["communicationStepSize", "NaN s"]),
        (TIME, INFINITY, ["communicationStepSize", "inf s"]),
        (NAN, 1e-3, ["currentCommunicationPoint", "NaN s"]),
        (0.049, 1e-3, ["currentCommunicationPoint", "0.049 s", "0.05 s"]),
        (0.051, 1e-3, ["currentCommunicationPoint", "0.051 s", "0.05 s"]),
        (0.0, 1e-3, ["currentCommunicationPoint", "= 0 s", "0.05 s"]),
    ]
]
WRONG_PHASE = [
    Offence("initialize-twice", CONTROLLER, lambda fmu: fmu.slave.enterInitializationMode(), ["step mode"]),
    Offence("exit-twice", PLANT, lambda fmu: fmu.slave.exitInitializationMode(), ["step mode"]),
]
OFFENCES = NOT_FINITE + OUT_OF_RANGE + NOT_SETTABLE + WRONG_REFERENCE + WRONG_TIME + WRONG_PHASE


def assert_refused(call: Callable[[], object], messages: list[str], expected: list[str]) -> None:
    """The call returns the status Error and one message that holds all that is expected."""
    messages.clear()
    with pytest.raises(FMICallException) as refusal:
        call()
    assert refusal.value.status == ERROR
    assert len(messages) == 1
    assert [part for part in [refusal.value.function, *expected] if part not in messages[0]] == [], messages[0]


@pytest.mark.parametrize("offence", OFFENCES, ids=lambda offence: offence.name)
def test_refused_and_unchanged(
    fmi_version: int, offence: Offence, open_loop: Callable[..., Loop], messages: list[str]
) -> None:
    twin, disturbed = open_loop(fmi_version), open_loop(fmi_version)
    twin.run(DONE)
    disturbed.run(DONE)
    victim = disturbed.plant if offence.model == PLANT else disturbed.controller
    # Clocks can be read at events only.
    readable = [name for name, variable in victim.variables.items() if variable.type != "Clock"]
    before = [victim.get(name) for name in readable]
    assert_refused(lambda: offence.call(victim), messages, offence.message)
    assert [victim.get(name) for name in readable] == before
    assert [bits(row) for row in disturbed.run(DONE)] == [bits(row) for row in twin.run(DONE)]


@pytest.mark.parametrize("model", MODELS)
def test_no_step_before_initialization(
    fmi_version: int, model: str, open_fmu: Callable[[Path], Fmu], messages: list[str]
) -> None:
    fmu = open_fmu(fmu_path(fmi_version, model))
    assert_refused(lambda: fmu.step(0.0, 1e-3), messages, ["instantiated"])
    fmu.initialize()
    fmu.step(0.0, 1e-3)


@pytest.mark.parametrize("model", MODELS)
def test_no_step_after_termination_but_after_reset(
    fmi_version: int, model: str, open_fmu: Callable[[Path], Fmu], messages: list[str]
) -> None:
    fmu = open_fmu(fmu_path(fmi_version, model))
    fmu.initialize()
    fmu.slave.terminate()
    assert_refused(lambda: fmu.step(0.0, 1e-3), messages, ["terminated"])
    fmu.slave.reset()
    fmu.initialize()
    fmu.step(0.0, 1e-3)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("sample_time", 0.0, ["0 s", "expected 1e-6 to 1 s"]),
        ("sample_time", NAN, ["NaN s", "finite"]),
        ("controller.initial_voltage", INFINITY, ["inf V", "finite"]),
        ("saturation_flux", 0.0, ["0 Wb", "expected 1e-6 to 1 Wb"]),
        ("observer.kind", 99, ["= 99", "item of BearingObserver"]),
    ],
)
def test_parameters_are_checked_before_initialization(
    fmi_version: int,
    name: str,
    value: float,
    message: list[str],
    open_fmu: Callable[[Path], Fmu],
    messages: list[str],
) -> None:
    controller = open_fmu(fmu_path(fmi_version, CONTROLLER))
    assert_refused(lambda: controller.set({name: value}), messages, [name, *message])
    controller.initialize()
    controller.step(0.0, 1e-3)


def test_a_start_time_that_is_no_number(fmi_version: int, open_fmu: Callable[[Path], Fmu], messages: list[str]) -> None:
    plant = open_fmu(fmu_path(fmi_version, PLANT))
    assert_refused(lambda: plant.initialize(start_time=NAN), messages, ["startTime", "NaN s"])


def log_to(messages: list[str]) -> Callable[..., None]:
    """Callback for FMI 3.0."""
    return lambda *arguments: messages.append(arguments[-1].decode())


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("token", ["", "{00000000-0000-0000-0000-000000000000}"])
def test_a_wrong_token_is_no_instance(
    fmi_version: int, model: str, token: str, open_fmu: Callable[[Path], Fmu], messages: list[str]
) -> None:
    fmu = open_fmu(fmu_path(fmi_version, model))
    component, fmu.slave.guid = fmu.slave.component, token
    arguments = {"callbacks": fmu.slave.callbacks} if fmi_version == 2 else {"logMessage": log_to(messages)}
    with pytest.raises(Exception, match="Failed to instantiate"):
        fmu.slave.instantiate(**arguments)
    fmu.slave.component = component
    assert f'"{token}"' in messages[-1]
    assert model in messages[-1]
