"""The state of an FMU: saved and restored, in another instance, in another process, in the other version of FMI."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from bearing import bits
from cosimulation import Fmu
from fmpy.fmi1 import FMICallException
from packages import CONTROLLER, FMI_VERSIONS, PLANT, REPOSITORY, MODELS, fmu_path

STEP_SIZE = 1e-3  # s
STEPS = 200
# Parameters that bring as much hidden state into play as possible: noise generators, a filter with memory. Other models run
# with their start values.
PARAMETERS = {
    PLANT: {"sensor.noise": 1e-7, "process.flux_noise": 1e-6},
    CONTROLLER: {"observer.kind": "kalman"},
    "LevitatedBallPlant": {"sensor.noise": 1e-3},
    "LevitatedBallController": {"observer.kind": "polynomial_newton_adaptive"},
    "MaglevRigPlant": {"sensor.noise": 1e-3},
    "MaglevRigController": {"observer.kind": "nonlinear"},
}
# A process of its own that goes on from a state.
CONTINUE = """
import sys
from pathlib import Path
from cosimulation import Fmu
from test_state import continue_from, digits
path, state, first, last = sys.argv[1:]
with Fmu(Path(path)) as fmu:
    for row in continue_from(fmu, Path(state).read_bytes(), int(first), int(last)):
        print(digits(row))
"""


def reals(fmu: Fmu) -> list[float]:
    return fmu.get_reals([name for name, variable in fmu.variables.items() if variable.type in ("Real", "Float64")])


def first_input(fmu: Fmu) -> str:
    return next(name for name, variable in fmu.variables.items() if variable.causality == "input")


def step(fmu: Fmu, k: int) -> tuple[int, ...]:
    fmu.set({first_input(fmu): 1e-4 * (k % 7)})
    fmu.step(k * STEP_SIZE, STEP_SIZE)
    return bits(reals(fmu))


def digits(row: tuple[int, ...]) -> str:
    return " ".join(f"{number:016x}" for number in row)


def started(fmu: Fmu, model: str) -> Fmu:
    fmu.initialize(PARAMETERS.get(model, {}))
    return fmu


def saved_bytes(fmu: Fmu) -> bytes:
    state = fmu.slave.getFMUState()
    serialized = fmu.slave.serializeFMUState(state)
    fmu.slave.freeFMUState(state)
    return bytes(serialized)


def continue_from(fmu: Fmu, state: bytes, first: int, last: int) -> list[tuple[int, ...]]:
    """Restore a serialized state in an instance that was not even initialized, and go on."""
    handle = fmu.slave.deserializeFMUState(state)
    fmu.slave.setFMUState(handle)
    fmu.slave.freeFMUState(handle)
    return [step(fmu, k) for k in range(first, last)]


@pytest.mark.parametrize("model", MODELS)
def test_a_restored_run_repeats_itself(fmi_version: int, model: str, open_fmu: Callable[[Path], Fmu]) -> None:
    fmu = started(open_fmu(fmu_path(fmi_version, model)), model)
    for k in range(STEPS):
        step(fmu, k)
    state = fmu.slave.getFMUState()
    runs = []
    for _ in range(3):
        runs.append([step(fmu, k) for k in range(STEPS, 2 * STEPS)])
        fmu.slave.setFMUState(state)
    fmu.slave.freeFMUState(state)
    assert runs[0] == runs[1] == runs[2]
    assert len(set(runs[0])) == STEPS, "the run stands still"


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("other_version", FMI_VERSIONS, ids=lambda version: f"to-fmi{version}")
def test_another_process_and_version_continue(
    fmi_version: int, other_version: int, model: str, open_fmu: Callable[[Path], Fmu], tmp_path: Path
) -> None:
    fmu = started(open_fmu(fmu_path(fmi_version, model)), model)
    for k in range(STEPS):
        step(fmu, k)
    file = tmp_path / "state"
    file.write_bytes(saved_bytes(fmu))
    assert file.stat().st_size <= 4096
    straight = [digits(step(fmu, k)) for k in range(STEPS, 2 * STEPS)]
    arguments = [fmu_path(other_version, model), file, str(STEPS), str(2 * STEPS)]
    process = subprocess.run(
        [sys.executable, "-c", CONTINUE, *arguments],
        env={"PYTHONPATH": f"{REPOSITORY / 'scripts'}:{REPOSITORY / 'tests' / 'fmpy'}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    assert process.stdout.split("\n")[:-1] == straight


@pytest.mark.parametrize("model", MODELS)
def test_what_is_no_state_is_refused(
    fmi_version: int, model: str, open_fmu: Callable[[Path], Fmu], messages: list[str]
) -> None:
    fmu = started(open_fmu(fmu_path(fmi_version, model)), model)
    step(fmu, 0)
    state = saved_bytes(fmu)
    before = bits(reals(fmu))
    other = next(name for name in MODELS if name != model)
    foreign = saved_bytes(started(open_fmu(fmu_path(fmi_version, other)), other))
    damaged = bytearray(state)
    damaged[len(state) // 2] ^= 1
    for wrong, said in [
        (state[:-1], "bytes: expected"),
        (state + b"\0", "bytes: expected"),
        (bytes(damaged), "damaged"),
        (foreign, f"a state of {other}: expected {model}"),
        (b"?" * len(state), "the mark of a saved state"),
    ]:
        messages.clear()
        with pytest.raises(FMICallException):
            fmu.slave.deserializeFMUState(wrong)
        assert said in messages[-1]
        assert bits(reals(fmu)) == before
