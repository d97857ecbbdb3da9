"""Section of docs/conformance.md on calls and states: what random calls found, and the deviations that are meant."""

from __future__ import annotations

import tomllib
from pathlib import Path

from standard_output import tell

REPOSITORY = Path(__file__).resolve().parent.parent
TESTS = REPOSITORY / "tests" / "fmi"
DEVIATIONS = TESTS / "standard" / "deviations.toml"
FIGURES = TESTS / "random" / "figures.toml"
MEMORY = TESTS / "random" / "memory.toml"

HEAD = """\
## Calls, states and arguments

`tests/fmi/standard` holds which call each standard allows in which state, transcribed from the texts of FMI 2.0.5 and
FMI 3.0.2 and independent of the library. Random calls on every package and interface type are judged by it: every
function and variable, declared limits and what lies beyond, input slopes, calls within callbacks, stop times, saved
states with bytes flipped and forged, memory that runs out, hosts that trap floating-point exceptions or round otherwise.
What is allowed has to work, what is forbidden or makes no sense has to be refused and to change nothing, results have
to be finite, every state has to be restorable, and memory has to come back.

- `cargo test --test fmi ten_million -- --ignored` (optimised, with checks for overflow; `--release` works as well) made
  {calls:,} calls on {instances:,} instances of {scenarios} kinds (package, model, interface type), {nested:,} of them
  within callbacks: {ok:,} returned OK, {discard:,} Discard, {error:,} Error. 0 crashes, 0 blocks of memory kept, 0
  disagreements but the ones below. The longest call took {longest:.2g} s.
- `python scripts/check_memory.py` made {memory_calls:,} calls under valgrind: {memory_errors} invalid accesses,
  {memory_lost} bytes lost.

Where the library differs from a text on purpose (*met*: how often in those calls):

| Standard | Section | Text | Library | Reason | Met |
| --- | --- | --- | --- | --- | --- |
"""


def read(path: Path) -> dict:
    return tomllib.loads(path.read_text(encoding="utf-8"))


def met(figures: dict, deviation: str) -> str:
    """How often a deviation was met, if it was listed at the time of those calls."""
    count = figures["deviations"].get(deviation)
    return "not counted yet" if count is None else f"{count:,}"


def section() -> str:
    figures, memory = read(FIGURES), read(MEMORY)
    numbers = {key: value for key, value in figures.items() if key != "deviations"}
    numbers |= {f"memory_{key}": value for key, value in memory.items()}
    rows = [
        f"| {entry['standard']} | {entry['section']} | {entry['text']} | {entry['library']} | {entry['reason']} "
        f"| {met(figures, entry['id'])} |"
        for entry in read(DEVIATIONS)["deviation"]
    ]
    return HEAD.format(**numbers) + "\n".join(rows) + "\n"


if __name__ == "__main__":
    tell(section())
