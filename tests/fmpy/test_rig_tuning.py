"""What `maglev-fmu tune` writes is accepted by everything that takes parameters."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree
from zipfile import ZipFile

import pytest
from cosimulation import Fmu, parameter_values
from fmpy import simulate_fmu
from packages import fmu_path
from rig import RIG_CONTROLLER, bits, open_rig, run_program

OpenFmu = Callable[[Path], Fmu]
NAMES = ["plant.position", "controller.voltage", "controller.estimate.velocity"]


@pytest.fixture(scope="module", params=["linear", "nonlinear"])
def parameter_file(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("tuned") / f"{request.param}.json"
    run_program("tune", "--observer", request.param, "--particles", 6, "--iterations", 5, "--out", path)
    return path


def test_tuning_is_reproducible(parameter_file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.json"
    arguments = ["--particles", 6, "--iterations", 5, "--out", again]
    run_program("tune", "--observer", parameter_file.stem, *arguments)
    assert again.read_bytes() == parameter_file.read_bytes()
    run_program("tune", "--observer", parameter_file.stem, "--seed", 2, *arguments)
    assert again.read_bytes() != parameter_file.read_bytes()
    assert {path.suffix for path in tmp_path.iterdir()} == {".json", ".csv", ".svg", ".png"}


def test_values_carry_units_and_provenance(parameter_file: Path, open_fmu: OpenFmu) -> None:
    content = json.loads(parameter_file.read_text())
    assert content["model"] == RIG_CONTROLLER
    assert content["units"].keys() == content["values"].keys()
    assert content["units"]["observer.kind"] == f"item {parameter_file.stem}"
    controller = open_fmu(fmu_path(3, RIG_CONTROLLER))
    for name, unit in content["units"].items():
        variable = controller.variables[name]
        if variable.type == "Float64":
            assert unit == variable.declaredType.unit, name
    provenance = content["provenance"]
    assert provenance["seed"] == 1 and provenance["evaluations"] == 36
    assert provenance["cost"] < provenance["cost of the printed parameters"]


def test_fmpy_takes_the_values_as_start_values(fmi_version: int, parameter_file: Path) -> None:
    values = json.loads(parameter_file.read_text())["values"]
    result = simulate_fmu(
        fmu_path(fmi_version, RIG_CONTROLLER), start_values=values, stop_time=0.01, output=["estimate.velocity"]
    )
    assert len(result) > 1


def test_build_makes_them_start_values_that_the_library_honours(
    fmi_version: int, parameter_file: Path, tmp_path: Path, open_fmu: OpenFmu
) -> None:
    """Nothing is set in the new package; its loop runs bit for bit like the old one with the values set."""
    run_program("build", "--parameters", parameter_file, "--out", tmp_path)
    package = tmp_path / f"fmi{fmi_version}" / f"{RIG_CONTROLLER}.fmu"
    values = parameter_values(parameter_file, open_fmu(fmu_path(fmi_version, RIG_CONTROLLER)))

    description = ElementTree.fromstring(ZipFile(package).read("modelDescription.xml"))
    starts = {}
    for variable in description.find("ModelVariables"):
        typed = variable if fmi_version == 3 else variable[0]
        starts[variable.get("name")] = typed.get("start")
    assert {name: float(starts[name]) for name in values} == values

    told = open_rig(open_fmu, fmi_version, {"sensor.noise": 1e-3}, dict(values))
    built = open_rig(open_fmu, fmi_version, {"sensor.noise": 1e-3}, None)
    built.controller = open_fmu(package)
    built.controller.initialize()
    rows = [[bits(row) for row in loop.run(2000, NAMES)] for loop in (told, built)]
    assert rows[0] == rows[1]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('{"model": "MaglevRigController", "values": {"observer.bandwith": 1}}', "has no variable observer.bandwith"),
        ('{"model": "MaglevRigController", "values": {"sample_time": 5.0}}', "sample_time = 5 s: expected"),
        ('{"model": "MaglevRigController", "values": {"observer.kind": "luenberger"}}', "expected one of linear"),
        ('{"model": "Pendulum", "values": {}}', "no model Pendulum"),
        ("[]", "is no parameter file"),
    ],
)
def test_build_explains_what_is_wrong(content: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.json"
    path.write_text(content)
    done: subprocess.CompletedProcess[str] = run_program("build", "--parameters", path, "--out", tmp_path, check=False)
    assert done.returncode == 1
    assert message in done.stderr
    assert not (tmp_path / "fmi2").exists()
