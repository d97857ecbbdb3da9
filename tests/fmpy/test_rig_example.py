"""The rig's example in scripts/ runs as a user would run it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from packages import REPOSITORY, dist
from rig import run_program
from test_example import png_size

EXAMPLE = REPOSITORY / "scripts" / "simulate_rig.py"


def run_example(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, EXAMPLE, "--dist", dist(), *arguments]
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)


def errors(output: str) -> dict[str, float]:
    """Root mean square errors of the estimates from the summary."""
    found = re.findall(r"^  (position|velocity) +(\S+) (m|m/s)$", output, re.MULTILINE)
    return {name: float(value) for name, value, _ in found}


@pytest.mark.parametrize("observer", ["linear", "nonlinear", "kalman", "windowed_newton"])
def test_example_draws_and_summarises(fmi_version: int, observer: str, tmp_path: Path) -> None:
    image = tmp_path / "rig.png"
    done = run_example("--fmi", fmi_version, "--observer", observer, "--force", 0.02, "--stop-time", 2, "--out", image)
    assert done.returncode == 0, done.stderr
    assert png_size(image) == (1650, 1275)
    assert image.stat().st_size > 50_000
    found = errors(done.stdout)
    assert found["position"] < 1e-5 and found["velocity"] < 2e-3
    assert "The ball stayed in the air." in done.stdout


def test_disturbance_rejection_beats_the_pid(fmi_version: int) -> None:
    def control_error(law: str) -> float:
        push = ["--force", 0.02, "--amplitude", 0, "--stop-time", 3]
        done = run_example("--fmi", fmi_version, "--control", law, *push)
        assert done.returncode == 0, done.stderr
        return float(re.search(r"Control error: rms (\S+) mV", done.stdout)[1])

    assert 3.0 * control_error("disturbance_rejection") < control_error("pid")


def test_parameter_file_reaches_the_observer(tmp_path: Path) -> None:
    path = tmp_path / "tuned.json"
    run_program("tune", "--objective", "noise-aware", "--noise", 1e-3, "--particles", 8, "--iterations", 10, "--out", path)
    printed, tuned = run_example("--noise", 1e-3, "--force", 0.02), run_example(
        "--noise", 1e-3, "--force", 0.02, "--parameters", path
    )
    assert tuned.returncode == 0, tuned.stderr
    assert errors(tuned.stdout)["velocity"] < errors(printed.stdout)["velocity"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--observer", "x"], "observer.kind = x: expected one of linear, nonlinear, kalman, windowed_newton"),
        (["--dist", "/nowhere"], "cargo run --release -- build"),
        (["--parameters", "/nowhere.json"], "cannot read the parameter file"),
        (["--noise", "-1"], "failed with status 3"),
    ],
)
def test_example_explains_what_is_wrong(arguments: list[str], message: str) -> None:
    done = run_example(*arguments)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr
