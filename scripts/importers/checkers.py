"""Programs that read an FMU without running it."""

from __future__ import annotations

import subprocess
import sysconfig
from pathlib import Path
from zipfile import ZipFile

from importers import Task


def schema_errors(package: Path, member: str, schema: Path) -> list[str]:
    """What an XML schema says against a file in a package."""
    from lxml import etree

    validator = etree.XMLSchema(etree.parse(schema))
    with ZipFile(package) as archive, archive.open(member) as file:
        validator.validate(etree.parse(file))
    return [str(entry) for entry in validator.error_log]


def fmi_version(description: bytes) -> str:
    """Major version of the standard that a model description is written in."""
    from lxml import etree

    return etree.fromstring(description).get("fmiVersion")[0]


def schemas() -> Path:
    """Where fmpy keeps the schemas of the standards."""
    import fmpy

    return Path(fmpy.__file__).parent / "schema"


def validate_with_fmpy(fmu: Path) -> str:
    from fmpy.validation import validate_fmu

    problems = validate_fmu(str(fmu))
    assert problems == [], problems
    return "valid"


def check_schemas(fmu: Path) -> str:
    """Model description, and terminals in the form that both standards take from FMI 3.0."""
    with ZipFile(fmu) as archive:
        version = "fmi" + fmi_version(archive.read("modelDescription.xml"))
    files = {
        "modelDescription.xml": f"{version}/{version}ModelDescription.xsd",
        "terminalsAndIcons/terminalsAndIcons.xml": "fmi3/fmi3TerminalsAndIcons.xsd",
    }
    for member, schema in files.items():
        assert (errors := schema_errors(fmu, member, schemas() / schema)) == [], errors
    return "valid"


def check_with_fmutool(fmu: Path) -> str:
    """Semantic rules of the standards, checked independently of fmpy; any violation is an exit code other than 0."""
    tool = Path(sysconfig.get_path("scripts")) / "fmutool"
    check = subprocess.run([tool, "-input", fmu, "-check"], capture_output=True, text=True, check=False)
    report = check.stdout + check.stderr
    assert check.returncode == 0 and "No semantic error" in report, report
    assert [line for line in report.splitlines() if line.startswith(("ERROR", "WARNING"))] == [], report
    return "valid"


def read_with_fmureader(fmu: Path) -> str:
    """A reader with its own typed model of the XML; it has to find all variables under their names."""
    import fmpy
    from fmureader.fmi import read_model_description

    names = {variable.name for variable in read_model_description(fmu).model_variables}
    assert names == {variable.name for variable in fmpy.read_model_description(fmu).modelVariables}
    return "read"


TASKS = [
    Task(program, what, run, version)
    for version in (2, 3)
    for program, what, run in [
        ("FMPy", "validate", validate_with_fmpy),
        ("lxml", "XML schemas", check_schemas),
        ("fmu_manipulation_toolbox", "check rules", check_with_fmutool),
        ("fmureader", "read", read_with_fmureader),
    ]
]
