#!/usr/bin/env python3
"""Maglev rig with its observers: plant and controller FMU, stepped sample by sample with fmpy.

cargo run --release -- build
python scripts/simulate_rig.py --observer nonlinear --force 0.02 --out rig.png
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import command_line
import numpy as np
from command_line import number
from cosimulation import Fmu, Value, parameter_values
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

# Wires: output of one model, input of the other.
PLANT_TO_CONTROLLER = {"sensor_voltage_measured": "sensor_voltage", "voltage_measured": "voltage_applied"}
CONTROLLER_TO_PLANT = {"voltage": "voltage"}

PLANT_OUTPUTS = ["position", "velocity", "acceleration", "sensor_voltage", "sensor_voltage_measured", "voltage_measured"]
# In metres, whatever observer.measurement.
ESTIMATES = ["estimate.si.position", "estimate.si.velocity", "estimate.si.extended"]
CONTROLLER_OUTPUTS = ["voltage", *ESTIMATES]

# What an observer needs to close the loop: the plant's input gain at 9 mm, and to be some five times as fast as the loop.
FOR_DISTURBANCE_REJECTION: dict[str, Value] = {"observer.input_gain": -3705.0, "observer.bandwidth": 300.0}

# Lower edge of the plotted errors.
SMALLEST_ERROR = 1e-9


@dataclass
class Trajectory:
    """One row per communication point, in the units of the model descriptions."""

    time: np.ndarray
    reference: np.ndarray
    plant: dict[str, np.ndarray]
    controller: dict[str, np.ndarray]
    contact: bool

    def errors(self) -> np.ndarray:
        """Estimated minus true position [m] and velocity [m/s]."""
        pairs = zip(ESTIMATES, ["position", "velocity"])
        return np.array([self.controller[estimate] - self.plant[true] for estimate, true in pairs])


def transfer(source: Fmu, target: Fmu, wires: dict[str, str]) -> None:
    """Copy outputs of `source` to the inputs of `target` they are wired to."""
    target.set_reals(list(wires.values()), source.get_reals(list(wires)))


def simulate(plant: Fmu, controller: Fmu, options: argparse.Namespace) -> Trajectory:
    """Step two initialized models with a fixed step size, the controller first."""
    times = options.step_size * np.arange(round(options.stop_time / options.step_size))
    rest = plant.get_reals(["sensor_voltage"])[0]
    reference = rest + options.amplitude * np.sin(2.0 * np.pi * options.frequency * times)
    plant_rows, controller_rows, contact = [], [], False
    for time, wanted in zip(times, reference):
        transfer(plant, controller, PLANT_TO_CONTROLLER)
        plant_rows.append(plant.get_reals(PLANT_OUTPUTS))
        contact = contact or bool(plant.get("contact"))
        controller.set_reals(["reference"], [wanted])
        controller.step(time, options.step_size)
        controller_rows.append(controller.get_reals(CONTROLLER_OUTPUTS))
        transfer(controller, plant, CONTROLLER_TO_PLANT)
        plant.set_reals(["force"], [options.force if time >= options.force_time else 0.0])
        plant.step(time, options.step_size)
    return Trajectory(
        times,
        reference,
        dict(zip(PLANT_OUTPUTS, np.array(plant_rows).T)),
        dict(zip(CONTROLLER_OUTPUTS, np.array(controller_rows).T)),
        contact,
    )


def initialize(plant: Fmu, controller: Fmu, options: argparse.Namespace) -> None:
    """Give both models their parameters and initialize them; what the parameter file says comes last."""
    plant.initialize(
        {"initial.position": options.position, "sensor.noise": options.noise, "sensor.seed": options.seed},
        stop_time=options.stop_time,
    )
    measured, held = plant.get_reals(["sensor_voltage", "position"])
    values: dict[str, Value] = {"sensor_voltage": measured, "reference": measured, "controller.kind": options.control}
    if options.observer is not None:
        values["observer.kind"] = options.observer
    if options.control == "disturbance_rejection":
        values |= FOR_DISTURBANCE_REJECTION
    # The voltage that holds the ball grows with its distance.
    values["controller.operating_voltage"] = float(controller.variables["controller.operating_voltage"].start) * (
        held / float(plant.variables["initial.position"].start)
    )
    if options.parameters:
        values |= parameter_values(options.parameters, controller)
    controller.initialize(values, stop_time=options.stop_time)


def summary(trajectory: Trajectory) -> str:
    """What a reader wants to know first, as text."""
    lines = ["Root mean square errors of the estimates:"]
    for name, errors, unit in zip(["position", "velocity"], trajectory.errors(), ["m", "m/s"]):
        lines.append(f"  {name:<9} {np.sqrt(np.mean(errors**2)):9.3e} {unit}")
    control = trajectory.plant["sensor_voltage"] - trajectory.reference
    lines.append(f"Control error: rms {1e3 * np.sqrt(np.mean(control**2)):.3f} mV, peak {1e3 * np.abs(control).max():.2f} mV")
    voltage = trajectory.controller["voltage"]
    lines.append(f"Voltage: {voltage.min():.4f} to {voltage.max():.4f} V")
    lines.append("The ball touched a stop." if trajectory.contact else "The ball stayed in the air.")
    return "\n".join(lines)


def draw(trajectory: Trajectory, plant: Fmu, input_gain: float, title: str) -> Figure:
    """Position, velocity, extended state, sensor, voltage and estimation errors over the run."""
    pyplot.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.axisbelow": True})
    figure, panels = pyplot.subplots(3, 2, figsize=(11, 8.5), sharex="col", layout="constrained")
    figure.suptitle(title, fontsize=11)
    time, true, estimated = trajectory.time, trajectory.plant, trajectory.controller
    # f = x'' - b u of the voltage that acted up to the sample; none acted before the first.
    extended = true["acceleration"] - input_gain * true["voltage_measured"]
    extended[0] = np.nan
    states = [true["position"], true["velocity"], extended]
    units = [plant.display_unit("position"), plant.display_unit("velocity"), ("m/s²", 1.0)]
    for panel, name, state, estimate, (unit, factor) in zip(
        panels[:, 0], ["Position", "Velocity", "Extended state"], states, ESTIMATES, units
    ):
        panel.plot(time, estimated[estimate] * factor, color="C0", linewidth=1.8, label="estimated")
        panel.plot(time, state * factor, color="0.1", linestyle="--", linewidth=0.9, label="true")
        panel.set_ylabel(f"{name} [{unit}]")
    panels[0, 0].legend(loc="best")
    draw_sensor(panels[0, 1], trajectory)
    panels[1, 1].step(time, estimated["voltage"], where="post", color="C3", linewidth=1.0)
    panels[1, 1].set_ylabel("Coil voltage [V]")
    for error, label in zip(trajectory.errors(), ["position [m]", "velocity [m/s]"]):
        panels[2, 1].plot(time, np.maximum(np.abs(error), SMALLEST_ERROR), linewidth=0.8, label=label)
    panels[2, 1].set_yscale("log")
    panels[2, 1].set_ylabel("Estimation error")
    panels[2, 1].legend(loc="best")
    for panel in panels[-1]:
        panel.set_xlabel("Time [s]")
        panel.margins(x=0.01)
    figure.align_ylabels()
    return figure


def draw_sensor(panel: Axes, trajectory: Trajectory) -> None:
    """What the controller sees and what it wants."""
    measured = trajectory.plant["sensor_voltage_measured"]
    panel.plot(trajectory.time, measured, color="C2", linewidth=0.8, label="measured")
    panel.plot(trajectory.time, trajectory.reference, color="0.2", linestyle="--", linewidth=1.0, label="reference")
    panel.set_ylabel("Sensor voltage [V]")
    panel.legend(loc="best")


def metric_input_gain(controller: Fmu) -> float:
    """b of the observer in m/(s2 V)."""
    gain, sensor_gain = controller.get_reals(["observer.input_gain", "sensor_gain"])
    return gain if controller.get("observer.measurement") == "metres" else gain / sensor_gain


def arguments() -> argparse.Namespace:
    parser = command_line.parser(__doc__)
    parser.add_argument("--observer", help="item of observer.kind; the FMU's start value, linear, if not given")
    parser.add_argument("--control", default="pid", help="pid, or disturbance_rejection through the extended state")
    parser.add_argument(
        "--parameters", type=Path, metavar="FILE", help="parameter file for the controller, of maglev-fmu tune"
    )
    parser.add_argument(
        "--position", type=number("m"), default=0.009, metavar="M", help="where the ball starts, in m"
    )
    parser.add_argument("--amplitude", type=number("V"), default=0.1, metavar="V", help="sine of the reference, in V")
    parser.add_argument("--frequency", type=number("Hz"), default=0.5, metavar="HZ", help="its frequency in Hz")
    parser.add_argument(
        "--force", type=number("N"), default=0.0, metavar="N", help="disturbing force, positive downwards, in N"
    )
    parser.add_argument(
        "--force-time", type=number("s"), default=1.0, metavar="S", help="time of the force step, in s"
    )
    parser.add_argument(
        "--noise", type=number("V"), default=0.0, metavar="V", help="standard deviation of the sensor in V"
    )
    parser.add_argument("--seed", type=command_line.seed, default=1, help="seed of the noise")
    command_line.add_run_options(parser, 4.0, 1e-3, "communication step size in s", "rig.png")
    return command_line.parse(parser)


def main() -> None:
    options = arguments()
    folder = options.dist / f"fmi{options.fmi}"
    with command_line.explained():
        with Fmu(folder / "MaglevRigPlant.fmu") as plant, Fmu(folder / "MaglevRigController.fmu") as controller:
            initialize(plant, controller, options)
            trajectory = simulate(plant, controller, options)
            observer = controller.get("observer.kind")
            title = f"Maglev rig, {observer} observer, {options.control}, FMI {options.fmi}"
            figure = draw(trajectory, plant, metric_input_gain(controller), title)
    command_line.finish(summary(trajectory), figure, options)


if __name__ == "__main__":
    main()
