"""The reference run that travels in every FMU, and how a program's results compare with it."""

from __future__ import annotations

import csv
import io
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
STEP_ATTRIBUTE = "stepSize"
TOLERANCE = 1e-9


@dataclass
class Reference:
    """Inputs over each step and outputs after each step."""

    inputs: list[str]
    input_times: list[float]
    input_rows: list[list[float]]
    outputs: list[str]
    output_times: list[float]
    output_rows: list[list[float]]
    step_size: float

    @classmethod
    def of(cls, fmu: Path) -> Reference:
        with zipfile.ZipFile(fmu) as archive:
            tables = [archive.read(f"{FOLDER}/reference-{kind}.csv").decode() for kind in ("input", "output")]
            step_size = default_step_size(archive.read("modelDescription.xml"))
        (inputs, input_times, input_rows), (outputs, output_times, output_rows) = map(read_table, tables)
        return cls(inputs, input_times, input_rows, outputs, output_times, output_rows, step_size)

    def compare(self, rows: Sequence[Sequence[float]], names: Sequence[str] | None = None) -> str:
        """`exact` if the values of `names` after each step are those of the reference in every bit, else how close.

        Values may differ by a billionth of the largest magnitude that their variable reaches.
        """
        names = list(self.outputs if names is None else names)
        columns = [self.outputs.index(name) for name in names]
        wanted = [[row[column] for column in columns] for row in self.output_rows[1:]]
        return compare(names, rows, wanted)


def compare(names: Sequence[str], got: Sequence[Sequence[float]], wanted: Sequence[Sequence[float]]) -> str:
    """`exact` if both have the same values, else the tolerance within which they agree."""
    assert len(got) == len(wanted), f"{len(got)} rows, expected {len(wanted)}"
    if [list(row) for row in got] == [list(row) for row in wanted]:
        return "exact"
    for column, name in enumerate(names):
        scale = max(abs(row[column]) for row in wanted)
        for number, (here, there) in enumerate(zip(got, wanted)):
            error = abs(here[column] - there[column])
            assert error <= TOLERANCE * scale, f"{name} after step {number + 1}: {here[column]!r}, not {there[column]!r}"
    return f"to {TOLERANCE:g}"


def read_table(text: str) -> tuple[list[str], list[float], list[list[float]]]:
    """Names of the columns after the first, its times, and the values."""
    head, *lines = csv.reader(io.StringIO(text))
    rows = [[float(value) for value in line] for line in lines]
    return head[1:], [row[0] for row in rows], [row[1:] for row in rows]


def default_step_size(description: bytes) -> float:
    """Step size of the default experiment in a model description, in s."""
    from lxml import etree

    return float(etree.fromstring(description).find("DefaultExperiment").get(STEP_ATTRIBUTE))
