"""System structure packages in the importers that read them.

All of them step both units and then pass the values on, so each is compared with such a loop of the two FMUs.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from cosimulation import Fmu, Value
from importers import Task
from importers.checkers import schema_errors
from importers.in_cpp import load_ecos
from importers.reference import compare

STEPS = 500
STRUCTURE = "SystemStructure.ssd"
# What becomes of a parameter set with an enumeration, in the programs' own words.
ENUMERATION_ERRORS = {
    "FMPy": "invalid literal for int()",
    "ecospy": "Unknown XML node in ssv:Parameter encountered!",
    "libcosimpy": "the process ended with -6",
}


class PlainLoop:
    """The two FMUs of a package, connected as it says, with the parameters that it binds."""

    def __init__(self, package: Path) -> None:
        from fmpy.ssp.ssd import read_ssd

        system = read_ssd(str(package)).system
        self.connections = [
            (c.startElement, c.startConnector, c.endElement, c.endConnector) for c in system.connections
        ]
        self.sources = {element.name: element.source for element in system.elements}
        self.parameters = {
            element.name: {
                parameter.name: value_of(parameter)
                for binding in element.parameterBindings
                for values in binding.parameterValues
                for parameter in values.parameters
            }
            for element in system.elements
        }
        self.package = package
        self.outputs = sorted({(element, connector) for element, connector, _, _ in self.connections})
        with TemporaryDirectory() as folder, ZipFile(package) as archive:
            step_sizes = []
            for source in self.sources.values():
                with Fmu(Path(archive.extract(source, folder))) as unit:
                    step_sizes.append(float(unit.description.defaultExperiment.stepSize))
        self.step_size = min(step_sizes)

    def rows(self, steps: int, passes_start_values: bool) -> list[list[float]]:
        """Values of all connected outputs after each step; `passes_start_values` says whether the first step sees the
        outputs of the initialization, or zeros."""
        rows = []
        with TemporaryDirectory() as folder, ZipFile(self.package) as archive:
            units = {name: Fmu(Path(archive.extract(source, folder))) for name, source in self.sources.items()}
            for name, unit in units.items():
                unit.initialize(self.parameters[name])
            pending = []
            for element, connector, target, target_connector in self.connections:
                value = units[element].get(connector) if passes_start_values else 0.0
                pending.append((target, target_connector, value))
            for step in range(steps):
                for target, connector, value in pending:
                    units[target].set({connector: value})
                for unit in units.values():
                    unit.step(step * self.step_size, self.step_size)
                pending = [
                    (target, target_connector, units[element].get(connector))
                    for element, connector, target, target_connector in self.connections
                ]
                rows.append([units[element].get(connector) for element, connector in self.outputs])
            for unit in units.values():
                unit.close()
        return rows

    def compare(self, rows: list[list[float]], passes_start_values: bool = True) -> str:
        names = [f"{element}.{connector}" for element, connector in self.outputs]
        return compare(names, rows, self.rows(len(rows), passes_start_values))


def value_of(parameter: object) -> Value:
    """A parameter's value, which fmpy keeps as text; of an enumeration, the item's name."""
    if parameter.type == "Enumeration":
        return parameter.value
    if parameter.type == "Boolean":
        return parameter.value == "true"
    return int(parameter.value) if parameter.type == "Integer" else float(parameter.value)


def check_schemas(package: Path) -> str:
    import fmpy.ssp

    folder = Path(fmpy.ssp.__file__).parent / "schema"
    files = {STRUCTURE: "SystemStructureDescription.xsd"}
    with ZipFile(package) as archive:
        sets = [name for name in archive.namelist() if name.endswith(".ssv")]
    assert len(sets) == 2
    files |= {name: "SystemStructureParameterValues.xsd" for name in sets}
    for member, schema in files.items():
        assert (errors := schema_errors(package, member, folder / schema)) == [], errors
    return "valid"


def simulate_with_fmpy(package: Path) -> str:
    """fmpy applies a parameter set only if it is handed one, with the components' names in front."""
    from fmpy.ssp.simulation import simulate_ssp
    from fmpy.ssp.ssd import Parameter, ParameterSet

    loop = PlainLoop(package)
    parameters = [
        # Truth values as such: fmpy takes the text "false" for true.
        Parameter(name=f"{element}.{name}", value=value)
        for element, values in loop.parameters.items()
        for name, value in values.items()
    ]
    stop_time = (STEPS - 0.5) * loop.step_size
    result = simulate_ssp(
        str(package), stop_time=stop_time, step_size=loop.step_size, parameter_set=ParameterSet(parameters=parameters)
    )
    rows = [[float(row[f"{element}.{connector}"]) for element, connector in loop.outputs] for row in result]
    assert len(rows) == STEPS
    return loop.compare(rows, passes_start_values=False)


def simulate_with_ecos(package: Path) -> str:
    load_ecos()
    from ecospy import EcosSimulation

    loop = PlainLoop(package)
    rows = []
    with EcosSimulation(ssp_path=str(package), step_size=loop.step_size) as simulation:
        assert simulation.init(parameter_set=package.stem)
        for _ in range(STEPS):
            simulation.step()
            rows.append([simulation.get_real(f"{element}::{connector}") for element, connector in loop.outputs])
    return loop.compare(rows)


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
    infos = execution.slave_infos()
    index = {info.name.decode(): info.index for info in infos}
    references = {
        (element, connector): execution_reference(package, loop.sources[element], connector)
        for element, connector in loop.outputs
    }
    rows = []
    for _ in range(STEPS):
        assert execution.step()
        rows.append(
            [observer.last_real_values(index[element], [reference])[0] for (element, _), reference in references.items()]
        )
    return loop.compare(rows)


def execution_reference(package: Path, source: str, name: str) -> int:
    """Value reference of a variable of an FMU in a package."""
    from fmpy import read_model_description

    with TemporaryDirectory() as folder, ZipFile(package) as archive:
        variables = read_model_description(archive.extract(source, folder)).modelVariables
    return next(variable.valueReference for variable in variables if variable.name == name)


TASKS = [
    Task("lxml", "XML schemas", check_schemas),
    Task("FMPy", "simulate", simulate_with_fmpy),
    Task("ecospy", "simulate", simulate_with_ecos),
    Task("libcosimpy", "simulate", simulate_with_libcosim),
]
