"""The product's public interface: names, kinds, units and start values that users rely on."""

from __future__ import annotations

from typing import NamedTuple

import pytest
from cosimulation import enumeration_items
from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ModelVariable
from packages import BALL_MODELS, CONTROLLER, PLANT, fmu_path

BALL_PLANT, BALL_CONTROLLER = BALL_MODELS
CARRYING_FLUX = 0.010298006650609622  # Wb


class Expected(NamedTuple):
    """What a variable must be; `unit` of an enumeration is its items, `start` None where the model computes it."""

    kind: str
    causality: str
    unit: str | list[str] | None
    start: float | str | None


def measured(unit: str) -> Expected:
    return Expected("real", "input", unit, 0.0)


def output(unit: str | None, kind: str = "real") -> Expected:
    return Expected(kind, "output", unit, None)


def parameter(unit: str, start: float) -> Expected:
    return Expected("real", "parameter", unit, start)


def count(start: int) -> Expected:
    return Expected("integer", "parameter", None, start)


def choice(items: str, start: str) -> Expected:
    return Expected("enumeration", "parameter", items.split(), start)


INTERFACE = {
    PLANT: {
        "voltage": measured("V"),
        "position": output("m"),
        "velocity": output("m/s"),
        "flux": output("Wb"),
        "voltage_measured": output("V"),
        "position_measured": output("m"),
        "initial.position": parameter("m", 0.01),
        "initial.velocity": parameter("m/s", 0.0),
        "initial.flux": parameter("Wb", 1e-9),
        "bias_flux": parameter("Wb", 0.0),
        "saturation_flux": parameter("Wb", 0.0022),
        "epsilon": Expected("real", "calculatedParameter", "1", None),
        "sensor.noise": parameter("m", 0.0),
        "sensor.resolution": parameter("m", 0.0),
        "sensor.sample_time": parameter("s", 0.0),
        "sensor.seed": count(1),
        "process.flux_noise": parameter("Wb", 0.0),
        "map": choice("exact printed", "exact"),
    },
    CONTROLLER: {
        "position": measured("m"),
        "voltage_applied": measured("V"),
        "state.velocity": measured("m/s"),
        "state.flux": measured("Wb"),
        "voltage": output("V"),
        "estimate.position": output("m"),
        "estimate.velocity": output("m/s"),
        "estimate.flux": output("Wb"),
        "observer.residual": output("m"),
        "observer.iterations": output(None, "integer"),
        "observer.converged": output(None, "boolean"),
        "tick_time": Expected("real", "local", "s", None),
        "sample_time": parameter("s", 1e-3),
        "observer.kind": choice("newton reduced_newton reduced_newton_compensated kalman", "newton"),
        "observer.map": choice("printed exact", "printed"),
        "observer.max_iterations": count(10),
        "observer.step_size": parameter("1", 1.0),
        "observer.window": count(3),
        "observer.filter_time": parameter("s", 1e-3),
        "observer.position_noise": parameter("m", 1e-6),
        "observer.flux_noise": parameter("Wb", 1e-6),
        "observer.initial.position": parameter("m", 0.0),
        "observer.initial.velocity": parameter("m/s", 0.0),
        "observer.initial.flux": parameter("Wb", 1e-9),
        "observer.voltage_source": choice("command applied", "command"),
        "controller.law": choice("a b c flux_cascade", "a"),
        "controller.feedback": choice("estimate state", "estimate"),
        "controller.k1": parameter("V/m", 0.92),
        "controller.k2": parameter("V.s/m", 9.94),
        "controller.cascade.position_gain": parameter("1/s2", 25.0),
        "controller.cascade.velocity_gain": parameter("1/s", 10.0),
        "controller.cascade.flux_gain": parameter("1/s", 200.0),
        "controller.cascade.regularisation": parameter("Wb", 1e-3),
        "controller.initial_voltage": parameter("V", -150.0),
        "controller.voltage_limit": parameter("V", 150.0),
        "bias_flux": parameter("Wb", 0.0),
        "saturation_flux": parameter("Wb", 0.0022),
    },
    BALL_PLANT: {
        "voltage": measured("V"),
        "force": measured("N"),
        "current": output("A"),
        "position": output("m"),
        "velocity": output("m/s"),
        "flux": output("Wb"),
        "voltage_measured": output("V"),
        "current_measured": output("A"),
        "contact": output(None, "boolean"),
        "mass": parameter("kg", 0.0844),
        "resistance": parameter("Ohm", 2.52),
        "inductance_constant": parameter("N.m2/A2", 6.4042e-5),
        "gap": parameter("m", 0.005),
        "gravity": parameter("m/s2", 9.81),
        "lower_stop": parameter("m", -0.02),
        "initial.position": parameter("m", 0.0),
        "initial.velocity": parameter("m/s", 0.0),
        "initial.flux": parameter("Wb", CARRYING_FLUX),
        "sensor.noise": parameter("A", 0.0),
        "sensor.resolution": parameter("A", 0.0),
        "sensor.sample_time": parameter("s", 0.0),
        "sensor.seed": count(1),
    },
    BALL_CONTROLLER: {
        "current": measured("A"),
        "reference": measured("m"),
        "voltage_applied": measured("V"),
        "state.position": measured("m"),
        "state.velocity": measured("m/s"),
        "state.flux": measured("Wb"),
        "voltage": output("V"),
        "estimate.flux": output("Wb"),
        "estimate.velocity": output("m/s"),
        "estimate.position": output("m"),
        "reference.position": output("m"),
        "observer.flux_offset": output("Wb"),
        "observer.excitation": output("1"),
        "observer.residual": output("1"),
        "observer.active": output(None, "boolean"),
        "observer.estimated_resistance": output("Ohm"),
        "observer.voltage_offset": output("V"),
        "sample_time": parameter("s", 1e-4),
        "observer.kind": choice("drem polynomial_newton polynomial_newton_adaptive", "drem"),
        "observer.adaptation": choice("resistance voltage_offset", "resistance"),
        "observer.gain": parameter("1/s", 10.0),
        "observer.excitation_scale": parameter("1", 1e9),
        "observer.normalisation": parameter("1", 0.0),
        "observer.prefilter[1]": parameter("1/s", 100.0),
        "observer.prefilter[2]": parameter("1/s", 300.0),
        "observer.filter[1]": parameter("1/s", 10.0),
        "observer.filter[2]": parameter("1/s", 25.0),
        "observer.filter[3]": parameter("1/s", 60.0),
        "observer.filter[4]": parameter("1/s", 150.0),
        "observer.speed_rate": parameter("1/s", 200.0),
        "observer.position_rate": parameter("1/s", 200.0),
        "observer.startup_hold": parameter("s", 0.1),
        "observer.initial.flux": parameter("Wb", CARRYING_FLUX),
        "observer.initial.flux_offset": parameter("Wb", 0.0),
        "observer.initial.velocity": parameter("m/s", 0.0),
        "observer.initial.position": parameter("m", 0.0),
        "observer.voltage_source": choice("command applied", "command"),
        "controller.pole": parameter("1/s", 60.0),
        "controller.reference_filter": parameter("1/s", 80.0),
        "controller.feedback": choice("estimate state", "estimate"),
        "controller.voltage_limit": parameter("V", 12.0),
        "mass": parameter("kg", 0.0844),
        "resistance": parameter("Ohm", 2.52),
        "inductance_constant": parameter("N.m2/A2", 6.4042e-5),
        "gap": parameter("m", 0.005),
        "gravity": parameter("m/s2", 9.81),
    },
}
CASES = [(model, name) for model, variables in INTERFACE.items() for name in variables]
KINDS = {
    "Real": "real",
    "Float64": "real",
    "Integer": "integer",
    "Int32": "integer",
    "Boolean": "boolean",
    "Enumeration": "enumeration",
}
# Exponents of kg, m, s, A.
BASE_UNITS = {
    "m": (0, 1, 0, 0),
    "m/s": (0, 1, -1, 0),
    "m/s2": (0, 1, -2, 0),
    "s": (0, 0, 1, 0),
    "1/s": (0, 0, -1, 0),
    "1/s2": (0, 0, -2, 0),
    "V": (1, 2, -3, -1),
    "Wb": (1, 2, -2, -1),
    "V/m": (1, 1, -3, -1),
    "V.s/m": (1, 1, -2, -1),
    "1": (0, 0, 0, 0),
    "kg": (1, 0, 0, 0),
    "N": (1, 1, -2, 0),
    "A": (0, 0, 0, 1),
    "Ohm": (1, 2, -3, -2),
    "N.m2/A2": (1, 3, -2, -2),
}


def description(fmi_version: int, model: str) -> ModelDescription:
    return read_model_description(fmu_path(fmi_version, model))


def find(fmi_version: int, model: str, name: str) -> ModelVariable:
    return next(v for v in description(fmi_version, model).modelVariables if v.name == name)


@pytest.mark.parametrize(("model", "name"), CASES)
def test_variable(fmi_version: int, model: str, name: str) -> None:
    variable, expected = find(fmi_version, model, name), INTERFACE[model][name]
    assert KINDS[variable.type] == expected.kind
    assert variable.causality == expected.causality
    if expected.kind == "real":
        assert (variable.unit or variable.declaredType.unit) == expected.unit
    if expected.start is None:
        assert variable.start is None
    elif expected.kind == "enumeration":
        items = enumeration_items(variable)
        assert set(expected.unit) <= set(items)
        assert int(variable.start) == items[expected.start]
    else:
        assert float(variable.start) == expected.start


@pytest.mark.parametrize("model", INTERFACE)
def test_every_variable_is_described(fmi_version: int, model: str) -> None:
    assert [v.name for v in description(fmi_version, model).modelVariables if not v.description] == []


@pytest.mark.parametrize("model", INTERFACE)
def test_units_are_defined_by_the_right_base_units(fmi_version: int, model: str) -> None:
    for definition in description(fmi_version, model).unitDefinitions:
        base = definition.baseUnit
        assert (base.kg, base.m, base.s, base.A) == BASE_UNITS[definition.name], definition.name
        assert (base.K, base.mol, base.cd, base.rad) == (0, 0, 0, 0)
        assert (base.factor, base.offset) == (1.0, 0.0)


@pytest.mark.parametrize("model", INTERFACE)
def test_real_parameters_have_a_range_around_their_start(fmi_version: int, model: str) -> None:
    for variable in description(fmi_version, model).modelVariables:
        if variable.causality == "parameter" and KINDS[variable.type] in ("real", "integer"):
            assert float(variable.min) <= float(variable.start) <= float(variable.max), variable.name


@pytest.mark.parametrize("model", INTERFACE)
def test_value_references_with_start_are_unique(fmi_version: int, model: str) -> None:
    references = [v.valueReference for v in description(fmi_version, model).modelVariables if v.start is not None]
    assert len(references) == len(set(references))


@pytest.mark.parametrize("model", INTERFACE)
def test_both_versions_describe_the_same_variables(model: str) -> None:
    # FMI 2.0 has no clocks.
    two, three = (
        [(v.name, v.causality, v.variability) for v in description(n, model).modelVariables if v.type != "Clock"]
        for n in (2, 3)
    )
    assert two == three
