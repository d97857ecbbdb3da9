"""The examples in scripts/ run as a user would run them."""

from __future__ import annotations

import re
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from packages import REPOSITORY, dist

BEARING = "simulate_bearing.py"
BALL = "simulate_ball.py"


def run_example(*arguments: object, script: str = BEARING) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, REPOSITORY / "scripts" / script, "--dist", dist(), *arguments]
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)


def png_size(path: Path) -> tuple[int, int]:
    """Width and height in pixels from the file's header."""
    header = path.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", header[16:24])


@pytest.mark.parametrize("order", ["controller-first", "parallel"])
def test_example_draws_and_summarises(fmi_version: int, order: str, tmp_path: Path) -> None:
    image = tmp_path / "bearing.png"
    done = run_example("--fmi", fmi_version, "--order", order, "--stop-time", 0.3, "--out", image)
    assert done.returncode == 0, done.stderr
    assert png_size(image) == (1650, 1650)
    assert image.stat().st_size > 50_000
    errors = re.findall(r"^  (position|velocity|flux) +(\S+) (\S+)$", done.stdout, re.MULTILINE)
    assert [(name, unit) for name, _, unit in errors] == [("position", "m"), ("velocity", "m/s"), ("flux", "Wb")]
    assert all(float(value) < bound for (_, value, _), bound in zip(errors, [1e-9, 1e-7, 1e-5]))
    assert "Largest voltage: 150 V" in done.stdout


def test_example_takes_every_option(fmi_version: int) -> None:
    options = "--initial-position 0.001 --initial-voltage -50 --law b --bias-flux 1e-4 --stop-time 0.1 --step-size 5e-4"
    done = run_example("--fmi", fmi_version, *options.split())
    assert done.returncode == 0, done.stderr
    assert "Largest voltage: 50 V" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--law", "z"], "controller.law = z: expected one of a, b, c"),
        (["--dist", "/nowhere"], "cargo run --release -- build"),
        (["--initial-position", "5"], "failed with status 3"),
    ],
)
def test_example_explains_what_is_wrong(arguments: list[str], message: str) -> None:
    done = run_example(*arguments)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("observer", "reference", "step_size", "flux_percent"),
    [
        ("drem", "sinusoids", 1e-4, 1.0),
        ("polynomial_newton", "constant", 1e-3, 1e-6),
        ("polynomial_newton_adaptive", "steps", 1e-3, 0.1),
    ],
)
def test_ball_example_draws_and_summarises(
    fmi_version: int, observer: str, reference: str, step_size: float, flux_percent: float, tmp_path: Path
) -> None:
    image = tmp_path / "ball.png"
    options = f"--observer {observer} --reference {reference} --step-size {step_size} --stop-time 2.5".split()
    done = run_example("--fmi", fmi_version, *options, "--out", image, script=BALL)
    assert done.returncode == 0, done.stderr
    assert png_size(image) == (1800, 1500)
    assert image.stat().st_size > 50_000
    assert "The ball touches no stop" in done.stdout
    deviation = float(re.search(r"position - reference +(\S+) m$", done.stdout, re.MULTILINE)[1])
    assert deviation < 1e-4
    assert float(re.search(r"^Flux error: (\S+) %", done.stdout, re.MULTILINE)[1]) < flux_percent


@pytest.mark.parametrize("order", ["controller-first", "parallel"])
def test_ball_example_takes_every_option(fmi_version: int, order: str) -> None:
    options = "--flux-error -0.05 --initial-position 0.0005 --noise 1e-3 --seed 3 --observer polynomial_newton"
    done = run_example("--fmi", fmi_version, "--order", order, *options.split(), "--stop-time", 1.5, script=BALL)
    assert done.returncode == 0, done.stderr
    assert "The ball touches no stop" in done.stdout


def test_ball_example_tells_of_a_lost_ball() -> None:
    done = run_example("--noise", 1e-2, "--stop-time", 1.5, script=BALL)
    assert done.returncode == 0, done.stderr
    assert re.search(r"^The ball touches a stop at \S+ s$", done.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--observer", "magic"], "observer.kind = magic: expected one of drem, polynomial_newton"),
        (["--dist", "/nowhere"], "cargo run --release -- build"),
        (["--noise", "-1"], "failed with status 3"),
    ],
)
def test_ball_example_explains_what_is_wrong(arguments: list[str], message: str) -> None:
    done = run_example(*arguments, script=BALL)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr
