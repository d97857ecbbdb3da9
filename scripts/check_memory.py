#!/usr/bin/env python3
"""Random calls under valgrind: invalid accesses and memory that is lost; writes what it found for docs/conformance.md.

python scripts/check_memory.py
"""

from __future__ import annotations

import json
import re
import subprocess
import sys

from standard_calls import MEMORY, REPOSITORY
from standard_output import Parser, tell

TEST = "random::a_hundred_thousand_random_calls_for_a_memory_checker"
# What the test program's own tables keep until it ends is "possibly" lost to valgrind, which sees no pointers inside.
KINDS = "definite,indirect"
VALGRIND = ["valgrind", "--leak-check=full", f"--show-leak-kinds={KINDS}", f"--errors-for-leak-kinds={KINDS}"]


def test_program() -> str:
    """Builds the tests of the C boundary; path of the program."""
    command = ["cargo", "test", "--locked", "--test", "fmi", "--no-run", "--message-format=json"]
    built = subprocess.run(command, cwd=REPOSITORY, stdout=subprocess.PIPE, text=True)
    if built.returncode != 0:
        sys.exit("the test program could not be built")
    messages = [json.loads(line) for line in built.stdout.splitlines() if line.startswith("{")]
    (program,) = (m["executable"] for m in messages if m.get("executable") and m["target"]["name"] == "fmi")
    return program


def main() -> None:
    Parser(description=__doc__.split("\n")[0]).parse_args()
    command = [*VALGRIND, test_program(), "--ignored", "--exact", TEST, "--nocapture", "--test-threads=1"]
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    tell(run.stdout)
    calls = re.search(r"(\d+) calls", run.stdout)
    errors = re.search(r"ERROR SUMMARY: ([\d,]+) errors", run.stdout)
    if run.returncode != 0 or calls is None or errors is None:
        sys.exit(f"the calls did not end well: {run.returncode}")
    kinds = [r"definitely lost: ([\d,]+) bytes", r"indirectly lost: ([\d,]+) bytes"]
    found = [re.search(kind, run.stdout) for kind in kinds]
    lost = sum(int(kind[1].replace(",", "")) for kind in found if kind)
    number_of_errors = int(errors[1].replace(",", ""))
    MEMORY.write_text(
        "# Written by scripts/check_memory.py.\n"
        f"calls = {calls[1]}\nerrors = {number_of_errors}\nlost = {lost}\n",
        encoding="utf-8",
    )
    if number_of_errors or lost:
        sys.exit(f"{number_of_errors} errors, {lost} bytes lost")


if __name__ == "__main__":
    main()
