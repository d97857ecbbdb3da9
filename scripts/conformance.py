#!/usr/bin/env python3
"""Runs the FMUs and systems through the importers and checkers there are, and writes docs/conformance.md.

cargo run --release -- build
python scripts/conformance.py --write
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import platform
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from zipfile import ZipFile

import standard_calls
from importers import ANY, CO_SIMULATION, MODEL_EXCHANGE, SCHEDULED_EXECUTION, Task, checkers, in_cpp, systems
from importers import with_fmpy, with_fmuloader
from lxml import etree
from standard_calls import REPOSITORY
from standard_output import Parser, tell

PAGE = REPOSITORY / "docs" / "conformance.md"
TIME_LIMIT = 120.0  # s

MODEL_TASKS = [task for module in (checkers, with_fmpy, with_fmuloader, in_cpp) for task in module.TASKS]
# Directories of packages, the version of the standard in them, and how a table calls it.
FORMS = {"fmi2": (2, "FMI 2"), "fmi3": (3, "FMI 3"), "fmi3-clocked": (3, "FMI 3, clocks")}
ELEMENTS = {"CoSimulation": CO_SIMULATION, "ModelExchange": MODEL_EXCHANGE, "ScheduledExecution": SCHEDULED_EXECUTION}

HEAD = """\
# Conformance

What programs of others make of the FMUs and systems of this repository. Written by `scripts/conformance.py --write`;
the Python tests run every cell again and fail if this page is not what they found.

Each FMU carries a reference input and the output that belongs to it (`extra/org.fmi-standard.fmi-ls-ref`). A program
that runs an FMU is given the one and has to return the other: *exact* means the same bits at every step, *to 1e-09*
within that part of the largest magnitude of each variable, *to 1e-06* the same, or within that part of its nominal
value, for states that the program's own integrator has solved for. *valid* and *read* are the words of checkers and readers. An empty cell: the model does not
offer that interface, or does not come in that form: controllers for FMI 3 come without clocks (`fmi3/`) and with them
(`fmi3-clocked/`), plants have none. *limit*: the program cannot do this with any FMU of that kind; its own words are below the table.
"""


@dataclass(frozen=True)
class Outcome:
    """What came of a task."""

    word: str
    error: str | None = None

    @property
    def is_good(self) -> bool:
        return self.error is None


def is_installed(task: Task) -> bool:
    try:
        version(task.program)
    except PackageNotFoundError:
        return False
    return True


def interfaces(fmu: Path) -> set[str]:
    """Interface types that the model description of an FMU declares."""
    with ZipFile(fmu) as archive:
        root = etree.fromstring(archive.read("modelDescription.xml"))
    return {ANY} | {kind for element, kind in ELEMENTS.items() if root.find(element) is not None}


def cells(dist: Path) -> Iterator[tuple[Task, Path]]:
    """Every task with every package that it applies to, of the programs that are installed."""
    for form, (fmi_version, _) in FORMS.items():
        for task in MODEL_TASKS:
            for fmu in sorted(dist.glob(f"{form}/*.fmu")):
                if task.fmi_version == fmi_version and is_installed(task) and task.interface in interfaces(fmu):
                    yield task, fmu
    for task in systems.TASKS:
        for package in sorted(dist.glob(task.packages)):
            if is_installed(task):
                yield task, package


def run(task: Task, package: Path) -> Outcome:
    """Carries out a task in a process of its own, since a program in C++ may end it."""
    context = multiprocessing.get_context("fork" if "fork" in multiprocessing.get_all_start_methods() else "spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=carry_out, args=(task, package, sender))
    process.start()
    sender.close()
    try:
        found = receiver.recv() if receiver.poll(TIME_LIMIT) else (None, f"no answer within {TIME_LIMIT:g} s")
    except EOFError:
        process.join()
        found = None, f"the process ended with {process.exitcode}"
    process.kill()
    process.join()
    word, error = found
    if task.limit is None or not task.limit.applies(package):
        return Outcome(word or "error", error)
    if error is None or task.limit.error not in error:
        return Outcome("error", f"expected the error {task.limit.error!r}, found {error or word!r}")
    return Outcome("limit")


def carry_out(task: Task, package: Path, sender: object) -> None:
    """In the other process: reports a word or an error, and leaves what programs print out of the way."""
    faulthandler.disable()
    with tempfile.TemporaryFile() as log:
        for stream in (1, 2):
            os.dup2(log.fileno(), stream)
        try:
            sender.send((task.run(package), None))
        except BaseException as error:  # noqa: BLE001 - whatever it is, it is an answer
            sender.send((None, f"{type(error).__name__}: {error}"))
    # No destructors: those of some programs end the process with an error.
    os._exit(0)


def form_of(package: Path) -> str | None:
    """Directory in which a model is packaged; None for systems."""
    return package.parent.name if package.suffix == ".fmu" else None


def label(task: Task, form: str | None) -> str:
    """First cells of the row of a task with packages of one form."""
    what = task.what if task.interface == ANY else f"{task.what}, {task.interface}"
    standard = systems.FORMS[task.packages] if form is None else FORMS[form][1]
    return f"| {standard} | {task.program} {version(task.program)} | {what} |"


def table(tasks: list[Task], outcomes: dict[tuple[Task, Path], Outcome], first: str) -> list[str]:
    """Lines of a table with a row per task and form of packages, and a column per package name."""
    rows: dict[str, dict[str, str]] = {}
    for (task, package), outcome in outcomes.items():
        if task in tasks:
            rows.setdefault(label(task, form_of(package)), {})[package.stem] = outcome.word
    names = sorted({name for words in rows.values() for name in words})
    lines = [f"|{first} {' | '.join(names)} |", "| --- " * (first.count("|") + len(names)) + "|"]
    lines += [f"{head} {' | '.join(words.get(name, '') for name in names)} |" for head, words in rows.items()]
    return lines


def limits_of(tasks: list[Task], outcomes: dict[tuple[Task, Path], Outcome]) -> set[str]:
    """Lines on what the programs of some tasks cannot do."""
    return {
        f"- {task.program} {version(task.program)}, {task.limit.why}: `{task.limit.error}`"
        for (task, _), outcome in outcomes.items()
        if task in tasks and task.limit is not None and outcome.word == "limit"
    }


def page(outcomes: dict[tuple[Task, Path], Outcome]) -> str:
    """The whole of docs/conformance.md."""
    lines = [
        HEAD,
        "## FMUs",
        "",
        *table(MODEL_TASKS, outcomes, " Standard | Program | Task |"),
        "",
        *sorted(limits_of(MODEL_TASKS, outcomes)),
        "",
        "## Systems (SSP)",
        "",
        SYSTEMS_HEAD,
        *table(systems.TASKS, outcomes, " SSP | Program | Task |"),
        "",
        *sorted(limits_of(systems.TASKS, outcomes)),
        NOTES.format(enumerations=", ".join(f"{name} (`{error}`)" for name, error in systems.ENUMERATION_ERRORS.items())),
        standard_calls.section(),
    ]
    return "\n".join(lines)


SYSTEMS_HEAD = """\
`1.0` are the packages in `dist/`, whose loop is closed; `1.0, driven` those in `dist/driven/`, which also have
connectors of the system: the inputs that the loop leaves open, and its outputs; `2.0` those in `dist/ssp2/`, with
connectors of the system and the models for FMI 3.0.

A program that runs a package is asked two things. *exact*, and *to 1e-09* as above, compare its bits with a plain loop
of the same FMUs in the program's own order of exchange, over 500 steps: both models step, then values are passed on, and
the first step sees the start values, in FMPy zeros. Beside the bits the physics have to be right: after two seconds the
bearing is where the loop of the paper has it, in which the controller reads and acts within the same sample, to 2 %; the
ball is up, the rig's ball at its operating point; and from the observers' start-up on the estimates are within 1 % of
the true values.
"""

NOTES = """\
- FMPy does not apply the parameter sets that a package binds unless it is handed them, and starts all wires at 0. The
  models in a package therefore have the start values of the loop inside, and a controller lets the first step pass.
- The packages' parameter sets have no enumerations, since none of the programs takes them: {enumerations}.
- The step of a package is in its default experiment, where libcosim reads it, on its system, where OMSimulator writes it
  in packages of its own, and in the default experiments of its models. FMPy and ecospy are
  told it. With FMPy's own choice of 10 ms each value acts two steps late, and no loop is stable: the bearing's observer
  would see ten equal positions in a row, the current of the ball's coil decays within 5 ms, so that even state feedback
  from the true states loses the ball, and on the rig the printed PID is unstable from 2 ms on. The controllers in the
  packages refuse steps beyond 1 ms and say so. Ball and rig are stable with all steps from 0.1 ms on that were tried, 0.3
  and 0.7 ms among them; the bearing's sample time of 1 ms has to be a multiple of the step (0.5 ms, 0.25 ms): otherwise
  ticks lie within steps and use older inputs, and the observer, which inverts exact positions, loses the rotor.
- OMSimulator's Python package downloads its program from a server of its own when it is installed, which the tests
  cannot rely on; it is not among the programs.
"""


def main() -> None:
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("--dist", type=Path, default=REPOSITORY / "dist", help="directory with the packages")
    parser.add_argument("--write", action="store_true", help="write docs/conformance.md")
    options = parser.parse_args()
    outcomes = {}
    for task, package in cells(options.dist.resolve()):
        outcome = outcomes[task, package] = run(task, package)
        tell(f"{label(task, form_of(package))} {package.stem}: {outcome.error or outcome.word}")
    if not outcomes:
        sys.exit(f"no packages in {options.dist}: build them first, cargo run --release -- build")
    if not all(outcome.is_good for outcome in outcomes.values()):
        sys.exit("not everything went well")
    if options.write:
        PAGE.write_text(page(outcomes), encoding="utf-8")
        tell(f"written: {PAGE} on {platform.platform()}")


if __name__ == "__main__":
    main()
