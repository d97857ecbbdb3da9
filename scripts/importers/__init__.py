"""What programs of others make of the FMUs and systems: one module per kind of program, one function per task.

A task takes the path of an FMU or of a system structure package and returns a word about the outcome; it raises if
anything is wrong. `scripts/conformance.py` runs them all and writes the table.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ANY, CO_SIMULATION, MODEL_EXCHANGE, SCHEDULED_EXECUTION = "any", "co-simulation", "model exchange", "scheduled execution"


@dataclass(frozen=True)
class Task:
    """Something that a program of others does with an FMU or a system."""

    program: str
    """Name of its Python package."""
    what: str
    run: Callable[[Path], str]
    fmi_version: int | None = None
    """2 or 3; None for systems."""
    interface: str = ANY
    """Interface type that the FMU must offer."""
    limit: Limit | None = None
    packages: str = "*.ssp"
    """Pattern of the systems that it is done with."""


@dataclass(frozen=True)
class Limit:
    """Something that a program cannot do with anybody's FMU."""

    error: str
    """Part of what it says."""
    why: str
    applies: Callable[[Path], bool] = lambda _: True
    """Whether an FMU is of the kind that the program cannot handle."""
