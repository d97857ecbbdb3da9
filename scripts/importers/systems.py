"""System structure packages in the importers that read them.

All of them step both models and then pass the values on, so each is compared with such a loop of the two FMUs; and each
has to show the physics: bearing and balls where the loop of the paper has them, and estimates that are right.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from cosimulation import Fmu, Value
from importers import Limit, Task
from importers.checkers import schema_errors
from importers.in_cpp import load_ecos
from importers.physics import duration, estimates, check_physics
from importers.reference import compare
from importers.system_structure import STRUCTURE, ParameterValues, SystemStructure

# Later the observer of the bearing makes more of the last digits, where the flux crosses zero.
COMPARED_STEPS = 500
# What becomes of a parameter set with an enumeration, in the programs' own words.
ENUMERATION_ERRORS = {
    "FMPy": "invalid literal for int()",
    "ecospy": "Unknown XML node in ssv:Parameter encountered!",
    "libcosimpy": "the process ended with -6",
}


class PlainLoop:
    """The two FMUs of a package, connected as it says, with the parameters that it binds."""

    def __init__(self, package: Path) -> None:
        self.package = package
        self.structure = SystemStructure(package)
        self.step_size = self.structure.step_size
        self.steps = round(duration(package) / self.step_size)
        wires = self.structure.inner_connections
        self.outputs = sorted({(element, name) for element, name, _, _ in wires} | estimates(package))

    def rows(
        self, steps: int, passes_start_values: bool, parameters: ParameterValues | None = None
    ) -> list[list[float]]:
        """Values of the outputs after each step; `passes_start_values` says whether the first step sees the outputs of
        the initialization, or zeros. Without `parameters` the models start by themselves as their package says."""
        rows = []
        wires = self.structure.inner_connections
        plant, controller = (self.structure.element(kind) for kind in ("Plant", "Controller"))
        with TemporaryDirectory() as folder, ZipFile(self.package) as archive:
            models = {name: Fmu(Path(archive.extract(path, folder))) for name, path in self.structure.sources.items()}

            def passed(to: str) -> dict[str, Value]:
                return {name: models[element].get(output) for element, output, target, name in wires if target == to}

            own = parameters or {}
            models[plant].initialize(own.get(plant))
            # The controller's first estimate may follow from its inputs at the start.
            models[controller].initialize(own.get(controller, {}) | (passed(controller) if passes_start_values else {}))
            pending = {name: passed(name) for name in models}
            if not passes_start_values:
                pending = {name: dict.fromkeys(values, 0.0) for name, values in pending.items()}
            for step in range(steps):
                for name, model in models.items():
                    model.set(pending[name])
                    model.step(step * self.step_size, self.step_size)
                pending = {name: passed(name) for name in models}
                rows.append([models[element].get(connector) for element, connector in self.outputs])
            for model in models.values():
                model.close()
        return rows

    def compare(
        self, rows: list[list[float]], passes_start_values: bool = True, parameters: ParameterValues | None = None
    ) -> str:
        """A program's `rows` beside those of the loop."""
        names = [f"{element}.{connector}" for element, connector in self.outputs]
        return compare(names, rows, self.rows(len(rows), passes_start_values, parameters))

    def judge(
        self, rows: list[list[float]], passes_start_values: bool = True, parameters: ParameterValues | None = None
    ) -> str:
        """As `compare` at the beginning, and the physics have to be right all along."""
        check_physics(self.package, {name: [row[i] for row in rows] for i, name in enumerate(self.outputs)})
        return self.compare(rows[:COMPARED_STEPS], passes_start_values, parameters)


def check_schemas(package: Path) -> str:
    """With the schemas of the version that the package claims."""
    if SystemStructure(package).version == "2.0":
        import pyssp_standard

        folder = Path(pyssp_standard.__file__).parent / "resources" / "ssp2"
    else:
        import fmpy.ssp

        folder = Path(fmpy.ssp.__file__).parent / "schema"
    with ZipFile(package) as archive:
        sets = [name for name in archive.namelist() if name.endswith(".ssv")]
    assert len(sets) == 2
    files = {STRUCTURE: "SystemStructureDescription.xsd"}
    files |= {name: "SystemStructureParameterValues.xsd" for name in sets}
    for member, schema in files.items():
        assert (errors := schema_errors(package, member, folder / schema)) == [], errors
    return "valid"


def read_with_pyssp(package: Path) -> str:
    """A reader with its own typed model of the XML; it has to find the same elements, connectors and wires."""
    from pyssp_standard.ssp import SSP

    structure = SystemStructure(package)
    with SSP(package, mode="r") as read, read.system_structure as description:
        system = description.system
        components = {element.name: element for element in system.elements}
        assert set(components) == set(structure.sources)
        connectors = {(None, connector.name) for connector in system.connectors}
        connectors |= {(name, connector.name) for name, element in components.items() for connector in element.connectors}
        assert connectors == structure.connectors
        assert len(system.connections) == len(structure.connections)
    return "read"


def simulate_with_fmpy(package: Path) -> str:
    """With default arguments: fmpy applies a parameter set only if it is passed one."""
    return _fmpy(package, None)


def simulate_with_fmpy_and_parameters(package: Path) -> str:
    """With the sets that the package binds, for fmpy with the components' names in front."""
    return _fmpy(package, SystemStructure(package).parameters)


def _fmpy(package: Path, parameters: ParameterValues | None) -> str:
    from fmpy.ssp.simulation import simulate_ssp
    from fmpy.ssp.ssd import Parameter, ParameterSet

    loop = PlainLoop(package)
    options = {}
    if parameters is not None:
        # Truth values as such: fmpy takes the text "false" for true.
        options["parameter_set"] = ParameterSet(
            parameters=[
                Parameter(name=f"{element}.{name}", value=value)
                for element, values in parameters.items()
                for name, value in values.items()
            ]
        )
    stop_time = (loop.steps - 0.5) * loop.step_size
    result = simulate_ssp(str(package), stop_time=stop_time, step_size=loop.step_size, **options)
    rows = [[float(row[f"{element}.{connector}"]) for element, connector in loop.outputs] for row in result]
    assert len(rows) == loop.steps
    return loop.judge(rows, passes_start_values=False, parameters=parameters)


def simulate_with_fmpy_by_default(package: Path) -> str:
    """Without a step size fmpy takes a hundredth of the stop time, whatever the package says."""
    from fmpy.ssp.simulation import simulate_ssp

    simulate_ssp(str(package))
    return "exact"


def simulate_with_ecos(package: Path) -> str:
    load_ecos()
    from ecospy import EcosSimulation

    loop = PlainLoop(package)
    rows = []
    with EcosSimulation(ssp_path=str(package), step_size=loop.step_size) as simulation:
        assert simulation.init(parameter_set=package.stem)
        for _ in range(loop.steps):
            simulation.step()
            rows.append([simulation.get_real(f"{element}::{connector}") for element, connector in loop.outputs])
    return loop.judge(rows, parameters=loop.structure.parameters)


def simulate_with_libcosim(package: Path) -> str:
    """libcosim takes the step size from the annotation that the package carries for it."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.FATAL)
    loop = PlainLoop(package)
    execution = CosimExecution.from_ssp_file(str(package))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    index = {info.name.decode(): info.index for info in execution.slave_infos()}
    references = [
        (index[element], [reference_of(package, loop.structure.sources[element], connector)])
        for element, connector in loop.outputs
    ]
    rows = []
    for _ in range(loop.steps):
        assert execution.step()
        rows.append([observer.last_real_values(slave, reference)[0] for slave, reference in references])
    return loop.judge(rows, parameters=loop.structure.parameters)


def reference_of(package: Path, source: str, name: str) -> int:
    """Value reference of a variable of an FMU in a package."""
    from fmpy import read_model_description

    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        variables = read_model_description(archive.extract(source, folder)).modelVariables
    return next(variable.valueReference for variable in variables if variable.name == name)


CLOSED, DRIVEN, TWO = "*.ssp", "driven/*.ssp", "ssp2/*.ssp"
FORMS = {CLOSED: "1.0", DRIVEN: "1.0, driven", TWO: "2.0"}

TASKS = [
    *(
        Task("lxml", "XML schemas", check_schemas, packages=edition)
        for edition in FORMS
    ),
    *(
        Task("pyssp_standard", "read", read_with_pyssp, packages=edition)
        for edition in FORMS
    ),
    *(
        Task("FMPy", what, run, packages=edition)
        for edition in (CLOSED, DRIVEN)
        for what, run in [
            ("simulate", simulate_with_fmpy),
            ("simulate with parameters", simulate_with_fmpy_and_parameters),
        ]
    ),
    Task(
        "FMPy",
        "simulate, no step size",
        simulate_with_fmpy_by_default,
        packages=CLOSED,
        limit=Limit("fmi2DoStep failed", "takes a hundredth of the stop time, 10 ms, for the step, which the models refuse"),
    ),
    Task("FMPy", "simulate", simulate_with_fmpy, packages=TWO, limit=Limit("Failed to validate SystemStructure.ssd", "SSP 2.0")),
    Task("ecospy", "simulate", simulate_with_ecos, packages=CLOSED),
    Task("ecospy", "simulate", simulate_with_ecos, packages=DRIVEN, limit=Limit("No element named: ", "systems with connectors of their own")),
    Task("ecospy", "simulate", simulate_with_ecos, packages=TWO, limit=Limit("Unsupported SSP version", "SSP 2.0")),
    Task("libcosimpy", "simulate", simulate_with_libcosim, packages=CLOSED),
    Task("libcosimpy", "simulate", simulate_with_libcosim, packages=DRIVEN, limit=Limit("Unable to create execution from path", "systems with connectors of their own")),
]
