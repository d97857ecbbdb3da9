"""The pins of the Python packages: complete, exact, and with the hashes that scripts/test has pip check."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).parent
SCRIPT = FOLDER.parents[1] / "scripts" / "test"


def lines(file: str) -> list[str]:
    """Requirements in a file, each on one line, without comments."""
    text = (FOLDER / file).read_text(encoding="utf-8").replace("\\\n", " ")
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def name(requirement: str) -> str:
    """Name of a package as the index writes it."""
    return re.sub(r"[-_.]+", "-", re.match(r"[\w.-]+", requirement)[0]).lower()


def test_every_package_has_an_exact_pin_with_hashes() -> None:
    pins = lines("requirements.txt")
    assert len(pins) > 20
    for pin in pins:
        assert re.match(r"[\w.-]+==[\w.]+ ", pin), pin
        assert re.search(r"--hash=sha256:[0-9a-f]{64}\b", pin), pin


def test_everything_wanted_is_pinned() -> None:
    pinned = {name(pin) for pin in lines("requirements.txt")}
    assert {name(wanted) for wanted in lines("requirements.in")} <= pinned


def test_pip_and_cargo_take_nothing_but_what_is_pinned() -> None:
    commands = SCRIPT.read_text(encoding="utf-8").splitlines()
    install = [line for line in commands if "pip install" in line]
    assert install and all("--require-hashes" in line and "--no-deps" in line for line in install)
    cargo = [line.strip() for line in commands if re.match(r"\s*cargo (clippy|test|run|build|fetch)", line)]
    assert cargo and all("--locked" in line for line in cargo), cargo
