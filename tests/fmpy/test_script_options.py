"""Wrong options and files end the scripts in scripts/ with a message, never with a traceback."""

from __future__ import annotations

import importlib
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from matplotlib.figure import Figure
from packages import REPOSITORY, dist

SCRIPTS = ["simulate_ball", "simulate_bearing", "simulate_rig"]
NUMBERS = {
    "simulate_ball": ["--flux-error", "--initial-position", "--noise"],
    "simulate_bearing": ["--initial-position", "--initial-voltage", "--bias-flux"],
    "simulate_rig": ["--position", "--amplitude", "--frequency", "--force", "--force-time", "--noise"],
}
SHORT = ["--stop-time", "0.01", "--step-size", "1e-3"]
USAGE = 2  # exit status of argparse


class Outcome(NamedTuple):
    """How a script ended and what it said."""

    status: int
    output: str
    message: str


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Runs a script in this process. An exception that would print a traceback fails the test."""

    def run(script: str, *arguments: object) -> Outcome:
        monkeypatch.setattr(sys, "argv", [script, "--dist", str(dist()), *map(str, arguments)])
        status, message = 0, ""
        try:
            importlib.import_module(script).main()
        except SystemExit as ending:
            status, message = (ending.code, "") if isinstance(ending.code, int) else (1, str(ending.code))
        output = capfd.readouterr()
        return Outcome(status, output.out, output.err + message)

    return run


def assert_refused(outcome: Outcome, status: int, *messages: str) -> None:
    assert outcome.status == status, outcome.message
    for message in messages:
        assert message in outcome.message


def run_program(script: str, stdout: object) -> Outcome:
    """Runs a script as a program of its own, with its output to a file."""
    command = [sys.executable, REPOSITORY / "scripts" / f"{script}.py", "--dist", dist(), *SHORT]
    done = subprocess.run([str(part) for part in command], stdout=stdout, stderr=subprocess.PIPE, text=True, check=False)
    assert "Traceback" not in done.stderr
    return Outcome(done.returncode, "", done.stderr)


@pytest.mark.parametrize("script", SCRIPTS)
@pytest.mark.parametrize("option", ["--stop-time", "--step-size"])
@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "-inf", "1e400", "soon", ""])
def test_times_are_positive(run: Callable[..., Outcome], script: str, option: str, value: str) -> None:
    done = run(script, f"{option}={value}")
    assert_refused(done, USAGE, f"argument {option}: {value!r}: expected a finite number greater than 0 of s")


@pytest.mark.parametrize("script", SCRIPTS)
@pytest.mark.parametrize(
    ("stop_time", "step_size", "steps"), [("1e-3", "1", "0.001"), ("1e9", "1e-9", "1e+18"), ("1e300", "1e-300", "inf")]
)
def test_a_run_has_steps_but_not_too_many(run: Callable[..., Outcome], script: str, stop_time: str, step_size: str, steps: str) -> None:
    done = run(script, "--stop-time", stop_time, "--step-size", step_size)
    assert_refused(done, USAGE, f"is {steps} steps: expected 1 to 1000000")


@pytest.mark.parametrize("script", SCRIPTS)
def test_one_step_is_a_run(run: Callable[..., Outcome], script: str, tmp_path: Path) -> None:
    image = tmp_path / "one.png"
    done = run(script, "--stop-time", "1e-3", "--step-size", "1e-3", "--out", image)
    assert (done.status, done.message) == (0, "")
    assert image.stat().st_size > 10_000
    assert os.listdir(tmp_path) == ["one.png"]


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_run_ends_with_a_whole_step(run: Callable[..., Outcome], script: str, tmp_path: Path) -> None:
    """Guards: a last step beyond the stop time that the models were given, which they refuse."""
    done = run(script, "--stop-time", "0.0016", "--step-size", "1e-3", "--out", tmp_path / "two.png")
    assert (done.status, done.message) == (0, "")


@pytest.mark.parametrize(("script", "option"), [(script, option) for script in SCRIPTS for option in NUMBERS[script]])
@pytest.mark.parametrize("value", ["nan", "inf", "much"])
def test_other_numbers_are_finite(run: Callable[..., Outcome], script: str, option: str, value: str) -> None:
    done = run(script, f"{option}={value}")
    assert_refused(done, USAGE, f"argument {option}: {value!r}: expected a finite number of ")


@pytest.mark.parametrize(("script", "option"), [(script, option) for script in SCRIPTS for option in NUMBERS[script]])
def test_numbers_out_of_range_are_refused_by_the_models_or_run(run: Callable[..., Outcome], script: str, option: str) -> None:
    done = run(script, f"{option}=1e300", *SHORT)
    assert done.status == 0 or "failed with status 3" in done.message, done.message


@pytest.mark.parametrize("script", ["simulate_ball", "simulate_rig"])
@pytest.mark.parametrize("value", ["-1", "1.5", "4294967297", "x"])
def test_a_seed_is_a_whole_number_that_fits(run: Callable[..., Outcome], script: str, value: str) -> None:
    assert_refused(run(script, f"--seed={value}"), USAGE, f"argument --seed: {value!r}: expected a whole number from 0")


@pytest.mark.parametrize("script", SCRIPTS)
@pytest.mark.parametrize(
    ("image", "message"),
    [
        ("/nowhere/picture.png", "expected a file in a directory that exists"),
        ("picture.xyz", "expected a name that ends with one of"),
        ("picture", "expected a name that ends with one of"),
        ("/dev/full.png", "expected a file in a directory that exists, no device"),
        ("n" * 300 + ".png", "expected a file in a directory that exists"),
    ],
)
def test_an_image_can_be_written(run: Callable[..., Outcome], script: str, image: str, message: str) -> None:
    assert_refused(run(script, "--out", image), USAGE, f"argument --out: {image!r}: {message}")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_device_is_no_picture(run: Callable[..., Outcome], tmp_path: Path) -> None:
    """Guards: a picture in place of a device or beside it."""
    before = sorted(os.listdir("/dev"))
    link, pipe = tmp_path / "link.png", tmp_path / "pipe.png"
    link.symlink_to("/dev/full")
    os.mkfifo(pipe)
    for image in ["/dev/full.png", "/dev/../dev/full.svg", link, pipe]:
        assert_refused(run("simulate_bearing", *SHORT, "--out", image), USAGE, "no device")
    assert sorted(os.listdir("/dev")) == before
    assert sorted(os.listdir(tmp_path)) == ["link.png", "pipe.png"]


def test_a_picture_is_whole_or_the_old_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A limit on the size of files stands for a full disk."""
    command_line = importlib.import_module("command_line")
    old, link = tmp_path / "old.png", tmp_path / "link.png"
    old.write_text("old")
    link.symlink_to(old)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
    try:
        for path in [old, link, tmp_path / "new.png"]:
            with pytest.raises(SystemExit, match="cannot write .*: File too large"):
                command_line.save(Figure(), path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert (old.read_text(), sorted(os.listdir(tmp_path))) == ("old", ["link.png", "old.png"])
    command_line.save(Figure(), link)
    assert link.is_symlink() and old.read_bytes().startswith(b"\x89PNG")


def test_a_name_may_be_as_long_as_the_system_has_them(tmp_path: Path) -> None:
    """Guards: a longer name for the unfinished picture."""
    path = tmp_path / ("n" * 251 + ".png")
    importlib.import_module("command_line").save(Figure(), path)
    assert path.stat().st_size > 0


@pytest.mark.parametrize("script", SCRIPTS)
def test_packages_that_are_none(run: Callable[..., Outcome], script: str, tmp_path: Path) -> None:
    for name in ["LevitatedBallPlant", "MagneticBearingPlant", "MaglevRigPlant"]:
        (tmp_path / "fmi3").mkdir(exist_ok=True)
        (tmp_path / "fmi3" / f"{name}.fmu").write_bytes(b"PK\x03\x04 but no archive")
    assert_refused(run(script, "--dist", tmp_path), 1, "cannot read", "Plant.fmu")
    assert_refused(run(script, "--dist", Path(__file__)), 1, "Not a directory")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("script", SCRIPTS)
def test_a_full_standard_output_is_an_error(script: str) -> None:
    with open("/dev/full", "w") as full:
        done = run_program(script, full)
    assert_refused(done, 1, "cannot write to standard output: [Errno 28]")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("script", ["simulate_ball", "simulate_rig"])
def test_a_refusal_by_a_model_is_told_where_errors_go(script: str) -> None:
    """Guards: reasons that FMPy printed to standard output, or lost with a traceback if that is full."""
    command = [sys.executable, str(REPOSITORY / "scripts" / f"{script}.py"), "--dist", str(dist()), "--noise=-5", *SHORT]
    for path in [os.devnull, "/dev/full"]:
        with open(path, "w") as output:
            done = subprocess.run(command, stdout=output, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode == 1
        assert "sensor.noise = -5" in done.stderr and "Traceback" not in done.stderr, done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("script", [*SCRIPTS, "check_memory", "conformance"])
def test_help_that_cannot_be_written_is_an_error(script: str) -> None:
    command = [sys.executable, str(REPOSITORY / "scripts" / f"{script}.py"), "--help"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert_refused(Outcome(done.returncode, "", done.stderr), 1, "cannot write to standard output: [Errno 28]")


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_closed_pipe_is_no_error_to_talk_about(script: str) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    done = run_program(script, writer)
    os.close(writer)
    assert (done.status, done.message) == (141, "")


def parameter_file(path: Path, text: str | bytes) -> Path:
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


MODEL = '"model": "MaglevRigController"'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f'{{{MODEL}, "values": {{"observer.bandwidth": 1, "observer.bandwidth": 2}}}}', "'observer.bandwidth' is there twice"),
        (f'{{{MODEL}, "values": {{"observer.bandwidth": NaN}}}}', "NaN is no number of JSON"),
        (f'{{{MODEL}, "values": {{"observer.bandwidth": "fast"}}}}', "observer.bandwidth = 'fast': expected a value of type Float64"),
        (f'{{{MODEL}, "values": {{"observer.bandwidth": [1]}}}}', "observer.bandwidth = [1]: expected a value"),
        (f'{{{MODEL}, "values": {{"observer.bandwidth": true}}}}', "observer.bandwidth = True: expected a value of type Float64"),
        (f'{{{MODEL}, "values": {{"observer.kind": true}}}}', "observer.kind = True: expected a value of type Enumeration"),
        (f'{{{MODEL}, "values": {{"observer.kind": 99999999999999999999}}}}', "observer.kind = 99999999999999999999: expected a value"),
        (f'{{{MODEL}, "values": {{"observer.bandwidth": 1}}, "units": {{"observer.bandwidth": "kg"}}}}', "observer.bandwidth is given in 'kg': expected 1/s"),
        (f'{{{MODEL}, "values": {{"controller.kind": 2.5}}, "units": {{"controller.kind": "item pid"}}}}', "controller.kind = 2.5: expected one of 1 (pid), 2"),
        (f'{{{MODEL}, "values": {{}}, "units": {{"sample_time": "s"}}}}', "'sample_time' has a unit and no value"),
        (f'{{{MODEL}, "values": {{"\\u001b[2J": 1}}}}', r"has no variable '\x1b[2J'"),
        ('{"model": "\\u001b[2J", "values": {}}', r"is for '\x1b[2J': expected a file for MaglevRigController"),
        (f'{{{MODEL}, "values": {{"observer.kind": "\\nlinear"}}}}', r"observer.kind = \nlinear: expected one of"),
        (f'{{{MODEL}, "unit": "MaglevRigController", "values": {{}}}}', "both name the model: expected one of them"),
        ("[" * 100_000, "cannot read the parameter file"),
        (b"\xff\xfe{\x00}\x00", "cannot read the parameter file"),
        (" " * (1 << 20) + "{}", "larger than the 1048576 bytes"),
    ],
)
def test_parameter_files_are_explained(run: Callable[..., Outcome], text: str | bytes, message: str, tmp_path: Path) -> None:
    path = parameter_file(tmp_path / "file.json", text)
    assert_refused(run("simulate_rig", "--parameters", path, "--stop-time", "0.01"), 1, message)


def test_whole_numbers_may_have_a_decimal_point(run: Callable[..., Outcome], tmp_path: Path) -> None:
    values = '"values": {"observer.kind": 2.0, "observer.substeps": 1e0}'
    path = parameter_file(tmp_path / "file.json", f"{{{MODEL}, {values}}}")
    done = run("simulate_rig", "--parameters", path, "--stop-time", "0.01")
    assert done.status == 0, done.message


def test_a_byte_order_mark_is_no_part_of_a_parameter_file(run: Callable[..., Outcome], tmp_path: Path) -> None:
    text = json.dumps({"model": "MaglevRigController", "values": {"observer.bandwidth": 150.0}})
    marked = parameter_file(tmp_path / "marked.json", b"\xef\xbb\xbf" + text.encode())
    plain = parameter_file(tmp_path / "plain.json", text)
    said = [run("simulate_rig", "--parameters", path, "--stop-time", "0.1") for path in (marked, plain)]
    assert [done.status for done in said] == [0, 0], said[0].message
    assert said[0].output == said[1].output


def test_older_parameter_files_call_the_model_a_unit(run: Callable[..., Outcome], tmp_path: Path) -> None:
    text = f'{{{MODEL}, "values": {{"observer.bandwidth": 150.0}}}}'
    paths = [parameter_file(tmp_path / "new.json", text), parameter_file(tmp_path / "old.json", text.replace('"model"', '"unit"'))]
    said = [run("simulate_rig", "--parameters", path, "--stop-time", "0.1") for path in paths]
    assert [done.status for done in said] == [0, 0], said[1].message
    assert said[0].output == said[1].output


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero")
def test_a_device_without_end_is_no_parameter_file(run: Callable[..., Outcome]) -> None:
    assert_refused(run("simulate_rig", "--parameters", "/dev/zero"), 1, "larger than the 1048576 bytes")
