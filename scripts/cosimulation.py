"""Co-simulation FMUs of FMI 2.0 and FMI 3.0 behind one small class, with variables addressed by name."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from ctypes import ArgumentError
from pathlib import Path
from tempfile import TemporaryDirectory

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import ModelVariable
from fmpy.simulation import instantiate_fmu

Value = float | int | bool | str

# As for maglev-fmu; what a user names may be a device without end [byte].
LONGEST_PARAMETER_FILE = 1 << 20

# fmpy passes the messages of all FMI 2.0 instances to the callback that was registered last, even after the instance
# it belongs to is gone, so callbacks must never be collected.
_callbacks: list[object] = []


# Types of variables that hold whole numbers.
WHOLE = ("Integer", "Int32", "Enumeration")


class Fmu:
    """One instance of a co-simulation FMU.

    Values are in the variables' units, times in s; an enumeration is set and read as the name of its item::

        with Fmu(Path("dist/fmi3/MagneticBearingPlant.fmu")) as plant:
            plant.initialize({"initial.position": 0.001, "map": "exact"})
            plant.set({"voltage": -50.0})
            plant.step(time=0.0, step_size=1e-3)
            print(plant.get("position"))
    """

    def __init__(self, path: Path, log: Callable[[str], None] | None = None) -> None:
        """Load and instantiate the FMU at `path`; its messages go to `log`, or to standard error."""
        try:
            self.description = read_model_description(path)
        except OSError:
            raise
        except Exception as error:
            raise ValueError(f"cannot read {path}: {error}") from None
        self.fmi_version = int(self.description.fmiVersion[0])
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self._references = {name: variable.valueReference for name, variable in self.variables.items()}
        self._folder = TemporaryDirectory(prefix="fmu-")
        try:
            extract(path, unzipdir=self._folder.name)
            self.slave: FMU2Slave | FMU3Slave = instantiate_fmu(
                self._folder.name, self.description, "CoSimulation", logger=_logger(log)
            )
        except Exception as error:
            self._folder.cleanup()
            raise ValueError(f"cannot load {path}: {error}") from error
        _callbacks.append(self.slave.callbacks if self.fmi_version == 2 else self.slave.logMessage)
        reals = "Real" if self.fmi_version == 2 else "Float64"
        self._get_reals = getattr(self.slave, f"get{reals}")
        self._set_reals = getattr(self.slave, f"set{reals}")

    def __enter__(self) -> Fmu:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the instance and remove the extracted files."""
        self.slave.freeInstance()
        self._folder.cleanup()

    def initialize(
        self, values: Mapping[str, Value] | None = None, start_time: float = 0.0, stop_time: float | None = None
    ) -> None:
        """Set `values`, parameters and inputs, and run the initialization; times in s."""
        if self.fmi_version == 2:
            self.slave.setupExperiment(startTime=start_time, stopTime=stop_time)
            self.set(values or {})
            self.slave.enterInitializationMode()
        else:
            self.set(values or {})
            self.slave.enterInitializationMode(startTime=start_time, stopTime=stop_time)
        self.slave.exitInitializationMode()

    def step(self, time: float, step_size: float) -> None:
        """Advance from `time` by `step_size`, both in s, with the inputs held."""
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=step_size)

    def get(self, name: str) -> Value:
        """Value of the variable `name`; of an enumeration, the item's name."""
        variable = self._variable(name)
        value = self._accessor("get", variable)([variable.valueReference])[0]
        if variable.type == "Enumeration":
            return next(item for item, number in enumeration_items(variable).items() if number == value)
        return bool(value) if variable.type == "Boolean" else value

    def set(self, values: Mapping[str, Value]) -> None:
        """Give values to variables of any type; an enumeration takes the name of an item or its number."""
        for name, value in values.items():
            variable = self._variable(name)
            is_item = variable.type == "Enumeration" and isinstance(value, str)
            number = item_number(variable, value) if is_item else value
            # JSON does not tell 2 from 2.0.
            if variable.type in WHOLE and isinstance(number, float) and number.is_integer():
                number = int(number)
            # Integers of C wrap around, and truth values are integers of Python.
            is_true_or_false = isinstance(value, bool)
            fits = variable.type not in WHOLE or _is_32_bit(number)
            if not fits or is_true_or_false != (variable.type == "Boolean"):
                raise ValueError(f"{name} = {value!r}: expected a value of type {variable.type}")
            try:
                self._accessor("set", variable)([variable.valueReference], [number])
            except (TypeError, OverflowError, ArgumentError):
                raise ValueError(f"{name} = {value!r}: expected a value of type {variable.type}") from None

    def get_reals(self, names: Sequence[str]) -> list[float]:
        """Values of several real variables in one call."""
        return self._get_reals([self._references[name] for name in names])

    def set_reals(self, names: Sequence[str], values: Sequence[float]) -> None:
        """Give values to several real variables in one call."""
        self._set_reals([self._references[name] for name in names], values)

    def display_unit(self, name: str) -> tuple[str, float]:
        """Unit in which the real variable `name` should be shown, and how many of it make one of its own unit."""
        variable = self._variable(name)
        unit_name = variable.unit or variable.declaredType.unit
        shown = variable.displayUnit or variable.declaredType.displayUnit
        unit = next(unit for unit in self.description.unitDefinitions if unit.name == unit_name)
        factors = {display.name: float(display.factor) for display in unit.displayUnits}
        return (shown, factors[shown]) if shown in factors else (unit_name, 1.0)

    def unit_text(self, name: str, value: Value) -> str:
        """What parameter files call the unit of a value."""
        variable = self._variable(name)
        if variable.type == "Enumeration":
            items = enumeration_items(variable)
            item = next((item for item, number in items.items() if value in (item, number)), None)
            if item is None:
                expected = ", ".join(f"{number} ({item})" for item, number in items.items())
                raise ValueError(f"{name} = {value!r}: expected one of {expected}")
            return f"item {item}"
        if variable.type in ("Boolean", "Integer", "Int32"):
            return "boolean" if variable.type == "Boolean" else "integer"
        return variable.unit or variable.declaredType.unit

    def _variable(self, name: str) -> ModelVariable:
        try:
            return self.variables[name]
        except KeyError:
            raise KeyError(f"{self.description.modelName} has no variable {name!r}") from None

    def _accessor(self, verb: str, variable: ModelVariable) -> Callable[..., list]:
        kind = variable.type
        if kind == "Enumeration":
            kind = "Integer" if self.fmi_version == 2 else "Int64"
        return getattr(self.slave, verb + kind)


def parameter_values(path: Path, fmu: Fmu) -> dict[str, Value]:
    """Start values for a model from a parameter file, such as `maglev-fmu tune` writes; items of enumerations by number."""
    try:
        with path.open("rb") as file:
            text = file.read(LONGEST_PARAMETER_FILE + 1)
        if len(text) > LONGEST_PARAMETER_FILE:
            raise ValueError(f"it is larger than the {LONGEST_PARAMETER_FILE} bytes that such a file may have")
        # Editors of Windows put a byte-order mark at its start.
        content = json.loads(text.decode("utf-8-sig"), object_pairs_hook=_unique, parse_constant=_no_number)
    except (OSError, ValueError, RecursionError) as error:
        raise ValueError(f"cannot read the parameter file {path}: {error}") from None
    if not isinstance(content, dict) or not isinstance(content.get("values"), dict):
        raise ValueError(f'{path} is no parameter file: expected {{"model": NAME, "values": {{...}}}}')
    if "model" in content and "unit" in content:
        raise ValueError(f'{path}: "model" and "unit" both name the model: expected one of them')
    model, named = fmu.description.modelName, content.get("model", content.get("unit"))
    if named != model:
        raise ValueError(f"{path} is for {named!r}: expected a file for {model}")
    units = content.get("units", {})
    if not isinstance(units, dict):
        raise ValueError(f'{path}: expected "units": {{...}}')
    for name, given in units.items():
        if name not in content["values"]:
            raise ValueError(f"{path}: {name!r} has a unit and no value")
        expected = fmu.unit_text(name, content["values"][name])
        if given != expected:
            raise ValueError(f"{name} is given in {given!r}: expected {expected}")
    return content["values"]


def _is_32_bit(number: object) -> bool:
    """Whether a number is a whole one of 32 bits."""
    return isinstance(number, int) and -(2**31) <= number < 2**31


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """A JSON object, refused if it has a key twice."""
    content: dict[str, object] = {}
    for key, value in pairs:
        if key in content:
            raise ValueError(f"the key {key!r} is there twice, expected one value")
        content[key] = value
    return content


def _no_number(text: str) -> None:
    raise ValueError(f"{text} is no number of JSON")


def enumeration_items(variable: ModelVariable) -> dict[str, int]:
    """Items of an enumeration variable: name and number."""
    return {item.name: int(item.value) for item in variable.declaredType.items}


def item_number(variable: ModelVariable, name: str) -> int:
    """Number of the item called `name` of an enumeration variable."""
    items = enumeration_items(variable)
    if name not in items:
        raise ValueError(f"{variable.name} = {name}: expected one of {', '.join(items)}")
    return items[name]


def _logger(log: Callable[[str], None] | None) -> Callable[..., None]:
    """Callback of either FMI version that passes the text on; the message is its last argument in both."""
    told = log or _tell
    return lambda *arguments: told(arguments[-1].decode("utf-8", errors="replace"))


def _tell(message: str) -> None:
    """Messages of a model go where errors go; nothing may come out of a callback of C."""
    try:
        print(message, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        pass
