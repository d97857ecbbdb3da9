"""System structure packages: a parameter that is changed in a package reaches the unit in every importer."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_DEFLATED, ZipFile

import conformance
import pytest
from fmpy import read_model_description
from importers import systems
from packages import dist

PACKAGES = sorted(dist().glob("*.ssp"))
SIMULATIONS = [task for task in systems.TASKS if task.what == "simulate" and conformance.is_installed(task)]


def with_text(package: Path, member: str, change: Callable[[str], str], target: Path) -> Path:
    """A copy of a package with one of its files changed."""
    with ZipFile(package) as source, ZipFile(target, "w", ZIP_DEFLATED) as copy:
        for name in source.namelist():
            content = source.read(name)
            if name == member:
                changed = change(content.decode())
                assert changed != content.decode()
                content = changed.encode()
            copy.writestr(name, content)
    return target


def move_start(text: str) -> str:
    """The plant begins a tenth of a millimetre further on."""
    pattern = r'(name="initial.position".*?<ssv:Real value=")([^"]+)'
    return re.sub(pattern, lambda found: f"{found[1]}{float(found[2]) + 1e-4!r}", text, count=1, flags=re.DOTALL)


@pytest.fixture(params=PACKAGES, ids=lambda path: path.stem)
def changed(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    package = request.param
    return with_text(package, "resources/plant.ssv", move_start, tmp_path / package.name)


def test_there_are_packages() -> None:
    assert PACKAGES


@pytest.mark.parametrize("task", SIMULATIONS, ids=lambda task: task.program)
def test_changed_parameters_arrive(changed: Path, task: systems.Task) -> None:
    """The plain loop reads the changed set, so agreement means that the importer has applied it."""
    outcome = conformance.run(task, changed)
    assert outcome.is_good, outcome.error


def test_changed_parameters_matter(changed: Path) -> None:
    original = dist() / changed.name
    rows = [systems.PlainLoop(package).rows(10, passes_start_values=True) for package in (original, changed)]
    assert rows[0] != rows[1]


@pytest.mark.parametrize("task", SIMULATIONS, ids=lambda task: task.program)
def test_enumerations_are_still_too_much(changed: Path, task: systems.Task, tmp_path: Path) -> None:
    """Why the packages' sets have none. Once a program takes them, this fails and they can be added."""
    (tmp_path / "choices").mkdir()
    source, name, item = first_choice(changed)
    choice = f'<ssv:Parameters><ssv:Parameter name="{name}"><ssv:Enumeration value="{item}"/></ssv:Parameter>'
    package = with_text(
        changed, source, lambda text: text.replace("<ssv:Parameters>", choice), tmp_path / "choices" / changed.name
    )
    schemas = next(task for task in systems.TASKS if task.what == "XML schemas")
    assert conformance.run(schemas, package).is_good
    assert systems.ENUMERATION_ERRORS[task.program] in conformance.run(task, package).error


def first_choice(package: Path) -> tuple[str, str, str]:
    """Parameter set of the controller, an enumeration among its parameters, and an item."""
    loop = systems.PlainLoop(package)
    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        description = read_model_description(archive.extract(loop.sources["controller"], folder))
    variables = description.modelVariables
    choice = next(v for v in variables if v.type == "Enumeration" and v.causality == "parameter")
    return "resources/controller.ssv", choice.name, choice.declaredType.items[0].name


def test_broken_wires_are_noticed(changed: Path, tmp_path: Path) -> None:
    """The schema check of the conformance job sees what is wrong."""
    broken = tmp_path / "broken"
    broken.mkdir()
    package = with_text(
        changed, systems.STRUCTURE, lambda text: text.replace("endConnector", "endConector", 1), broken / changed.name
    )
    task = next(task for task in systems.TASKS if task.what == "XML schemas")
    outcome = conformance.run(task, package)
    assert not outcome.is_good and "endConector" in outcome.error
    shutil.rmtree(broken)
