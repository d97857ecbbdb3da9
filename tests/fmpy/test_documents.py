"""What the README and the pages in docs/ tell the user to run does run, as it is written there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from packages import REPOSITORY, dist
from rig import run_program

PAGES = sorted([REPOSITORY / "README.md", *(REPOSITORY / "docs").glob("*.md")])
# Runs are cut short; their results are the matter of other tests.
SHORT = ["--stop-time", "0.2"]


def blocks(page: Path) -> list[tuple[str, str]]:
    """Language and text of the blocks of code."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def commands(block: str) -> list[list[str]]:
    """Words of the lines of a block for the shell."""
    return [words for line in block.splitlines() if (words := shlex.split(line, comments=True))]


def run_command(words: list[str]) -> None:
    """Runs a script or a search. The program's other commands are checked by tests in Rust, for they take minutes."""
    match words:
        case ["python", script, *arguments]:
            command = [sys.executable, script, "--dist", str(dist()), *arguments, *SHORT]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{words}: {done.stderr}"
        case ["maglev-fmu", "tune", *arguments]:
            run_program("tune", *arguments)


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page)], ids=lambda page: page.stem)
def test_code_of_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, target in [("dist", dist()), ("scripts", REPOSITORY / "scripts")]:
        (tmp_path / name).symlink_to(target, target_is_directory=True)
    for language, block in blocks(page):
        if language == "python":
            exec(compile(block, str(page), "exec"), {})
        else:
            assert language == "sh", language
            for words in commands(block):
                run_command(words)


def test_pages_have_code_that_is_run() -> None:
    code = [block for page in PAGES for block in blocks(page)]
    assert sum(language == "python" for language, _ in code) >= 3
    scripts = {words[1] for language, block in code if language == "sh" for words in commands(block) if words[0] == "python"}
    assert scripts == {f"scripts/{path.name}" for path in (REPOSITORY / "scripts").glob("simulate_*.py")}
