#!/usr/bin/env python3
"""Magnetic bearing under its Newton observer: plant and controller FMU, stepped sample by sample with fmpy.

cargo run --release -- build
python scripts/simulate_bearing.py --law b --initial-position 0.001 --out bearing.png
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import command_line
import numpy as np
from command_line import number
from cosimulation import Fmu
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

STATE = ["position", "velocity", "flux"]
ESTIMATE = ["estimate.position", "estimate.velocity", "estimate.flux"]

# Wires: output of one model, input of the other.
PLANT_TO_CONTROLLER = {
    "position_measured": "position",
    "velocity": "state.velocity",
    "flux": "state.flux",
    "voltage_measured": "voltage_applied",
}
CONTROLLER_TO_PLANT = {"voltage": "voltage"}

# From here on the estimation errors count as settled, in s.
SETTLED_FROM = 0.05
# Length of the enlarged start, in s.
START = 0.02
# Lower edge of the plotted errors.
SMALLEST_ERROR = 1e-18


@dataclass
class Trajectory:
    """One row per communication point, in the units of the model descriptions."""

    time: np.ndarray
    state: np.ndarray
    voltage: np.ndarray
    estimate: np.ndarray
    final_state: list[float]


def transfer(source: Fmu, target: Fmu, wires: dict[str, str]) -> None:
    """Copy outputs of `source` to the inputs of `target` they are wired to."""
    target.set_reals(list(wires.values()), source.get_reals(list(wires)))


def simulate(plant: Fmu, controller: Fmu, order: str, step_size: float, stop_time: float) -> Trajectory:
    """Step two initialized models up to `stop_time` with a fixed `step_size`, both in s.

    In the order `controller-first` the plant gets the voltage at once, as in the paper. In the order `parallel` both
    models step before anything is exchanged, so the plant gets the voltage one step late.
    """
    times = step_size * np.arange(round(stop_time / step_size))
    rows = []
    for time in times:
        transfer(plant, controller, PLANT_TO_CONTROLLER)
        state = plant.get_reals(STATE)
        controller.step(time, step_size)
        rows.append(state + controller.get_reals(["voltage", *ESTIMATE]))
        if order == "controller-first":
            transfer(controller, plant, CONTROLLER_TO_PLANT)
        plant.step(time, step_size)
        if order == "parallel":
            transfer(controller, plant, CONTROLLER_TO_PLANT)
    columns = np.array(rows)
    return Trajectory(times, columns[:, 0:3], columns[:, 3], columns[:, 4:7], plant.get_reals(STATE))


def initialize(plant: Fmu, controller: Fmu, options: argparse.Namespace) -> None:
    """Give both models their parameters and initialize them."""
    plant.initialize(
        {"initial.position": options.initial_position, "bias_flux": options.bias_flux}, stop_time=options.stop_time
    )
    controller.initialize(
        {
            "controller.law": options.law,
            "controller.initial_voltage": options.initial_voltage,
            "observer.voltage_source": "applied" if options.order == "parallel" else "command",
            "bias_flux": options.bias_flux,
        },
        stop_time=options.stop_time,
    )


def summary(trajectory: Trajectory) -> str:
    """What a reader wants to know first, as text."""
    errors = np.abs(trajectory.estimate - trajectory.state)[trajectory.time >= SETTLED_FROM]
    lines = [f"Largest estimation error from {SETTLED_FROM * 1e3:g} ms on:"]
    if len(errors):
        for name, error, unit in zip(STATE, errors.max(axis=0), ["m", "m/s", "Wb"]):
            lines.append(f"  {name:<9} {error:9.2e} {unit}")
    else:
        lines.append("  the simulation ends before")
    lines.append(f"Largest voltage: {np.abs(trajectory.voltage).max():.6g} V")
    if len(trajectory.voltage) > 1:
        lines.append(f"  after the first sample: {np.abs(trajectory.voltage[1:]).max():.6g} V")
    position, velocity, flux = trajectory.final_state
    lines.append(f"Final state: {position:.6e} m, {velocity:.6e} m/s, {flux:.6e} Wb")
    return "\n".join(lines)


def draw(trajectory: Trajectory, plant: Fmu, title: str) -> Figure:
    """Position, velocity, flux, voltage and estimation errors: the whole run on the left, its start on the right."""
    pyplot.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.axisbelow": True})
    figure, panels = pyplot.subplots(5, 2, figsize=(11, 11), sharex="col", layout="constrained")
    figure.suptitle(title, fontsize=11)
    start = trajectory.time < START
    for column, rows, scale, marker in [(0, slice(None), 1.0, ""), (1, start, 1e3, ".")]:
        time = trajectory.time[rows] * scale
        state, estimate = trajectory.state[rows], trajectory.estimate[rows]
        for index, name in enumerate(STATE):
            unit, factor = plant.display_unit(name)
            panel = panels[index, column]
            draw_state(panel, time, state[:, index] * factor, estimate[:, index] * factor, marker)
            panel.set_ylabel(f"{name.capitalize()} [{unit}]")
        draw_voltage(panels[3, column], time, trajectory.voltage[rows])
        draw_errors(panels[4, column], time, np.abs(estimate - state), marker)
        panels[0, column].margins(x=0.01)
    panels[0, 0].set_title("Whole run")
    panels[0, 1].set_title(f"First {START * 1e3:g} ms, one mark per sample")
    panels[-1, 0].set_xlabel("Time [s]")
    panels[-1, 1].set_xlabel("Time [ms]")
    panels[0, 0].legend(loc="best")
    panels[-1, 0].legend(loc="upper right", ncols=3)
    figure.align_ylabels()
    return figure


def draw_state(panel: Axes, time: np.ndarray, state: np.ndarray, estimate: np.ndarray, marker: str) -> None:
    """One component of the state, true and estimated."""
    panel.plot(time, state, color="0.7", linewidth=4, label="true")
    panel.plot(time, estimate, color="C0", linewidth=1.2, marker=marker, label="estimated")


def draw_voltage(panel: Axes, time: np.ndarray, voltage: np.ndarray) -> None:
    """The voltage, held between samples. A first sample that dwarfs the others is named instead of shown."""
    panel.step(time, voltage, where="post", color="C3", linewidth=1.2)
    panel.set_ylabel("Voltage [V]")
    later = voltage[1:]
    if len(later) and abs(voltage[0]) > 5.0 * np.abs(later).max():
        margin = 0.1 * max(np.ptp(later), 1e-9)
        panel.set_ylim(later.min() - margin, later.max() + margin)
        note = f"first sample, outside: {voltage[0]:g} V"
        panel.annotate(note, (0.98, 0.5), xycoords="axes fraction", color="C3", ha="right")


def draw_errors(panel: Axes, time: np.ndarray, errors: np.ndarray, marker: str) -> None:
    """Magnitudes of the estimation errors; smaller ones, zero too, appear at the lower edge."""
    for error, label in zip(errors.T, ["position [m]", "velocity [m/s]", "flux [Wb]"]):
        panel.plot(time, np.maximum(error, SMALLEST_ERROR), linewidth=0.8, marker=marker, label=label)
    panel.set_yscale("log")
    panel.set_ylim(SMALLEST_ERROR, 100.0)
    panel.set_ylabel("Estimation error")


def arguments() -> argparse.Namespace:
    parser = command_line.parser(__doc__)
    parser.add_argument(
        "--order",
        choices=["controller-first", "parallel"],
        default="controller-first",
        help="exchange order; parallel lets the observer use the measured voltage",
    )
    parser.add_argument("--initial-position", type=number("m"), default=0.01, metavar="M", help="x1(0) in m")
    parser.add_argument("--initial-voltage", type=number("V"), default=-150.0, metavar="V", help="u(0) in V")
    parser.add_argument("--law", default="a", help="control law: a, b or c for equation (8a), (8b) or (8c)")
    parser.add_argument("--bias-flux", type=number("Wb"), default=0.0, metavar="WB", help="Phi0 in Wb")
    command_line.add_run_options(parser, 10.0, 1e-3, "communication step size in s", "bearing.png")
    return command_line.parse(parser)


def title(options: argparse.Namespace, fmi_version: str) -> str:
    return (
        f"Magnetic bearing with Newton observer, law ({options.law}), $x_1(0)$ = {options.initial_position:g} m, "
        f"$u(0)$ = {options.initial_voltage:g} V, $\\Phi_0$ = {options.bias_flux:g} Wb\n"
        f"FMI {fmi_version}, exchange order {options.order}"
    )


def main() -> None:
    options = arguments()
    folder = options.dist / f"fmi{options.fmi}"
    with command_line.explained():
        with (
            Fmu(folder / "MagneticBearingPlant.fmu") as plant,
            Fmu(folder / "MagneticBearingController.fmu") as controller,
        ):
            initialize(plant, controller, options)
            trajectory = simulate(plant, controller, options.order, options.step_size, options.stop_time)
            figure = draw(trajectory, plant, title(options, plant.description.fmiVersion))
    command_line.finish(summary(trajectory), figure, options)


if __name__ == "__main__":
    main()
