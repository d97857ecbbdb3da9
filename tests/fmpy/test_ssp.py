"""System structure packages: what is changed in one reaches the models in every importer, and inputs drive the loops."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_DEFLATED, ZipFile

import conformance
import numpy as np
import pytest
from cosimulation import Fmu
from fmpy import read_model_description
from fmpy.ssp.simulation import simulate_ssp
from importers import physics, systems
from importers.system_structure import SystemStructure
from packages import dist

PACKAGES = sorted(dist().glob(systems.CLOSED))
# Those that take a package's parameters, with packages that all of them can open.
SIMULATIONS = [
    task
    for task in systems.TASKS
    if task.what in ("simulate", "simulate with parameters")
    and task.packages == systems.CLOSED
    and task.run is not systems.simulate_with_fmpy
    and conformance.is_installed(task)
]


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


def parameters_of(package: Path, kind: str) -> str:
    """File with the parameters of the plant or the controller of a package."""
    return f"resources/{SystemStructure(package).element(kind)}.ssv"


def move_start(text: str) -> str:
    """The plant begins a tenth of a millimetre further on."""
    pattern = r'(name="initial.position".*?<ssv:Real value=")([^"]+)'
    return re.sub(pattern, lambda found: f"{found[1]}{float(found[2]) + 1e-4!r}", text, count=1, flags=re.DOTALL)


@pytest.fixture(params=PACKAGES, ids=lambda path: path.stem)
def changed(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    package = request.param
    return with_text(package, parameters_of(package, "Plant"), move_start, tmp_path / package.name)


def test_there_are_packages() -> None:
    assert PACKAGES
    for edition in systems.FORMS:
        assert [path.name for path in sorted(dist().glob(edition))] == [path.name for path in PACKAGES]


@pytest.mark.parametrize("task", SIMULATIONS, ids=lambda task: task.program)
def test_changed_parameters_arrive(changed: Path, task: systems.Task) -> None:
    """The plain loop is given the changed set, so agreement means that the importer has applied it."""
    outcome = conformance.run(task, changed)
    assert outcome.is_good, outcome.error


def test_changed_parameters_matter(changed: Path) -> None:
    loops = [systems.PlainLoop(package) for package in (dist() / changed.name, changed)]
    rows = [loop.rows(10, passes_start_values=True, parameters=loop.structure.parameters) for loop in loops]
    assert rows[0] != rows[1]


def test_parameter_sets_repeat_what_the_models_start_with() -> None:
    """So that a package runs the same loop in importers that apply the sets and in those that do not."""
    for package in PACKAGES:
        loop = systems.PlainLoop(package)
        by_themselves, by_sets = (
            loop.rows(50, passes_start_values=False, parameters=parameters)
            for parameters in (None, loop.structure.parameters)
        )
        assert by_themselves == by_sets


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
    structure = SystemStructure(package)
    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        path = archive.extract(structure.sources[structure.element("Controller")], folder)
        description = read_model_description(path)
    variables = description.modelVariables
    choice = next(v for v in variables if v.type == "Enumeration" and v.causality == "parameter")
    return parameters_of(package, "Controller"), choice.name, choice.declaredType.items[0].name


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


def test_a_loop_that_is_lost_is_noticed() -> None:
    """The physics are no mere formality: a ball that lies, and an estimate that is off, fail."""
    package = dist() / "ball.ssp"
    loop = systems.PlainLoop(package)
    rows = loop.rows(loop.steps, passes_start_values=True)
    columns = {name: [row[i] for row in rows] for i, name in enumerate(loop.outputs)}
    physics.check_physics(package, columns)
    for (element, name), values in columns.items():
        if name in ("position", "flux", "estimate.position", "estimate.flux"):
            with pytest.raises(AssertionError):
                physics.check_physics(package, columns | {(element, name): [1.05 * v - 2e-4 for v in values]})


@pytest.mark.parametrize(("name", "target"), [("ball", 1e-3), ("rig", 0.1)])
def test_references_drive_loops(name: str, target: float) -> None:
    """The input `reference` of the system, in m and in V of the sensor, is where the ball goes."""
    package = dist() / "driven" / f"{name}.ssp"
    step_size = SystemStructure(package).step_size
    result = simulate_ssp(
        str(package), stop_time=1.5, step_size=step_size, input={"reference": lambda time: target if time > 0.5 else 0.0}
    )
    where = result["position"] if name == "ball" else result["sensor_voltage"]
    before = int(0.45 / step_size)
    assert abs(where[before]) < 0.02 * abs(target)
    # The rig's PID has a static error that its integral takes seconds to remove.
    assert abs(where[-1] - target) < 0.25 * abs(target)
    assert np.array_equal(result["estimate_position"], result[f"{controller_of(package)}.estimate.position"])


@pytest.mark.parametrize("name", ["ball", "rig"])
def test_forces_push_balls(name: str) -> None:
    package = dist() / "driven" / f"{name}.ssp"
    step_size = SystemStructure(package).step_size
    resting, pushed = (
        simulate_ssp(
            str(package), stop_time=0.5, step_size=step_size, input={"force": lambda time: force if time > 0.4 else 0.0}
        )["position"]
        for force in (0.0, 0.005)
    )
    assert np.array_equal(resting[: int(0.39 / step_size)], pushed[: int(0.39 / step_size)])
    assert pushed[-1] - resting[-1] > 1e-7


def controller_of(package: Path) -> str:
    return SystemStructure(package).element("Controller")


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.stem)
def test_steps_that_lose_a_loop_are_refused_with_a_reason(package: Path) -> None:
    structure = SystemStructure(package)
    messages: list[str] = []
    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        path = Path(archive.extract(structure.sources[controller_of(package)], folder))
        with Fmu(path, log=messages.append) as controller:
            controller.initialize()
            with pytest.raises(Exception, match="failed"):
                controller.step(0.0, 0.01)
            controller.step(0.0, 1e-3)
    assert any("a step of 0.01 s: expected at most longest_step = 0.001 s" in message for message in messages)


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.stem)
def test_every_edition_runs_the_same_loop(package: Path) -> None:
    """No program here runs SSP 2.0, so its wires and its models for FMI 3.0 are run by the plain loop."""
    closed = systems.PlainLoop(package)
    rows = closed.rows(closed.steps, passes_start_values=False)
    for edition in (systems.DRIVEN, systems.TWO):
        loop = systems.PlainLoop(package.parent / edition.replace("*", package.stem))
        assert loop.outputs == closed.outputs
        assert loop.judge(loop.rows(loop.steps, False), False, loop.structure.parameters) == "exact"
        assert loop.rows(loop.steps, False) == rows
