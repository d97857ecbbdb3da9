"""Where the tests find the FMUs: in $MAGLEV_DIST, or else in the repository's dist/."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from bearing import Loop
from cosimulation import Fmu
from packages import BEARING_MODELS, FMI_VERSIONS, SAMPLED_MODELS, MODELS, all_fmus, clocked_path, fmu_path

# Same condition as in requirements.txt.
if sys.platform != "linux" or platform.machine() != "x86_64" or sys.version_info >= (3, 15):
    collect_ignore = ["test_importers_in_cpp.py"]


def pytest_configure() -> None:
    """Stop at once when there is nothing to test."""
    paths = [fmu_path(version, model) for version in FMI_VERSIONS for model in MODELS]
    paths += [clocked_path(model) for model in SAMPLED_MODELS]
    missing = [str(path) for path in paths if not path.is_file()]
    if missing:
        raise pytest.UsageError(
            f"no FMU at {', '.join(missing)}. Build them with `cargo run --release -- build`, "
            "or set MAGLEV_DIST to the directory that holds fmi2/, fmi3/ and fmi3-clocked/."
        )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test for both FMI versions, or once for every FMU there is."""
    if "fmi_version" in metafunc.fixturenames:
        metafunc.parametrize("fmi_version", FMI_VERSIONS, ids=lambda version: f"fmi{version}")
    if "any_fmu" in metafunc.fixturenames:
        metafunc.parametrize("any_fmu", all_fmus(), ids=lambda path: f"{path.parent.name}-{path.stem}")


@pytest.fixture
def messages() -> list[str]:
    """What the instances made by `open_fmu` logged."""
    return []


@pytest.fixture
def open_fmu(messages: list[str]) -> Iterator[Callable[[Path], Fmu]]:
    """Load an FMU for the time of a test."""
    with ExitStack() as stack:
        yield lambda path: stack.enter_context(Fmu(path, log=messages.append))


@pytest.fixture
def open_loop(open_fmu: Callable[[Path], Fmu]) -> Callable[..., Loop]:
    """Load plant and controller of the bearing for the time of a test and initialize them."""

    def open_both(fmi_version: int, plant: dict | None = None, controller: dict | None = None) -> Loop:
        loop = Loop(*(open_fmu(fmu_path(fmi_version, model)) for model in BEARING_MODELS))
        loop.initialize(plant, controller)
        return loop

    return open_both
