"""Every importer and checker with every FMU and system, and the page in docs/ that tells what came of it."""

from __future__ import annotations

import os
import platform
import signal
import sys
from pathlib import Path

import conformance
import pytest
from conformance import Outcome
from importers import Limit, Task, systems
from packages import all_fmus, dist

# What requirements.txt installs everywhere else is less, see there.
ALL_PROGRAMS = sys.platform == "linux" and platform.machine() == "x86_64" and sys.version_info < (3, 15)
CELLS = list(conformance.cells(dist()))
RENEW = "renew it with `python scripts/conformance.py --write`"


@pytest.fixture(scope="module")
def outcomes() -> dict[tuple[Task, Path], Outcome]:
    """What has been found so far."""
    return {}


@pytest.mark.parametrize(
    ("task", "package"),
    CELLS,
    ids=lambda part: f"{part.parent.name}-{part.stem}" if isinstance(part, Path) else f"{part.program}-{part.what}",
)
def test_program_agrees(task: Task, package: Path, outcomes: dict[tuple[Task, Path], Outcome]) -> None:
    outcome = outcomes[task, package] = conformance.run(task, package)
    assert outcome.is_good, outcome.error


def test_page_tells_what_was_found(outcomes: dict[tuple[Task, Path], Outcome]) -> None:
    for cell in CELLS:
        if cell not in outcomes:
            outcomes[cell] = conformance.run(*cell)
    in_order = {cell: outcomes[cell] for cell in CELLS}
    found, checked_in = conformance.page(in_order), conformance.PAGE.read_text(encoding="utf-8")
    if ALL_PROGRAMS:
        assert found == checked_in, RENEW
    else:
        missing = set(found.splitlines()) - set(checked_in.splitlines())
        assert not missing, RENEW


def test_every_program_has_something_to_do() -> None:
    """A misspelt interface or package name would leave cells out without a word."""
    used = {task.program for task, _ in CELLS}
    wanted = {task.program for task in [*conformance.MODEL_TASKS, *systems.TASKS]}
    if ALL_PROGRAMS:
        assert used == wanted
    for fmu in all_fmus():
        declared = conformance.interfaces(fmu)
        tried = {task.interface for task, package in CELLS if package == fmu}
        assert tried == declared, fmu


def test_a_program_that_dies_is_an_error() -> None:
    outcome = conformance.run(Task("FMPy", "die", lambda _: os.kill(os.getpid(), signal.SIGKILL)), Path())
    assert outcome.error == "the process ended with -9"


def test_an_importer_that_learns_something_is_noticed() -> None:
    task = Task("FMPy", "nothing", lambda _: "exact", limit=Limit("no such thing", "never"))
    assert "no such thing" in conformance.run(task, Path()).error
