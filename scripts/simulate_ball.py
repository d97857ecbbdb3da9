#!/usr/bin/env python3
"""Levitated ball without a position sensor: plant and controller FMU, stepped sample by sample with fmpy.

The controller sees the coil's current and the reference only.

cargo run --release -- build
python scripts/simulate_ball.py --reference steps --observer polynomial_newton --out ball.png
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass

import command_line
import numpy as np
from command_line import number
from cosimulation import Fmu
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

# Wires: output of one model, input of the other. The true state is for controller.feedback = state only.
PLANT_TO_CONTROLLER = {
    "current_measured": "current",
    "voltage_measured": "voltage_applied",
    "position": "state.position",
    "velocity": "state.velocity",
    "flux": "state.flux",
}
CONTROLLER_TO_PLANT = {"voltage": "voltage"}

STATE = ["position", "velocity", "flux"]
RECORDED_PLANT = [*STATE, "current"]
RECORDED_CONTROLLER = [
    "voltage",
    *(f"estimate.{name}" for name in STATE),
    "reference.position",
    "observer.flux_offset",
    "observer.excitation",
]

# What the errors are summarised over: the last part of the run, in s.
TAIL = 1.0
# Lower edges of the logarithmic panels.
SMALLEST_ERROR = 1e-12
SMALLEST_EXCITATION = 1e-6

# References in m over time in s, and the rate of the filter that smooths them, in 1/s.
Reference = Callable[[float], float]


def sinusoids(time: float) -> float:
    return 0.6e-3 * sum(math.sin(15.0 * multiple * time) for multiple in (1.0, 2.2, 3.7))


def steps(time: float) -> float:
    return (0.0, 1e-3, -1e-3, 0.5e-3)[math.floor(time + 1e-9) % 4]


def constant(time: float) -> float:
    return 0.0


REFERENCES: dict[str, tuple[Reference, float]] = {
    "sinusoids": (sinusoids, 80.0),
    "steps": (steps, 60.0),
    "constant": (constant, 60.0),
}


@dataclass
class Trajectory:
    """Columns by name, one row per communication point, in the units of the model descriptions."""

    time: np.ndarray
    columns: dict[str, np.ndarray]
    in_contact: np.ndarray

    def error(self, name: str) -> np.ndarray:
        """Estimate minus truth."""
        return self.columns[f"estimate.{name}"] - self.columns[name]

    def tracking_error(self) -> np.ndarray:
        return self.columns["position"] - self.columns["reference.position"]


def transfer(source: Fmu, target: Fmu, wires: dict[str, str]) -> None:
    """Copy outputs of `source` to the inputs of `target` they are wired to."""
    target.set_reals(list(wires.values()), source.get_reals(list(wires)))


def simulate(
    plant: Fmu, controller: Fmu, reference: Reference, order: str, step_size: float, stop_time: float
) -> Trajectory:
    """Step two initialized models up to `stop_time` with a fixed `step_size`, both in s.

    In the order `controller-first` the plant gets the voltage at once. In the order `parallel` both models step before
    anything is exchanged, so the plant gets the voltage one step late.
    """
    times = step_size * np.arange(round(stop_time / step_size))
    rows, contacts = [], []
    for time in times:
        transfer(plant, controller, PLANT_TO_CONTROLLER)
        controller.set_reals(["reference"], [reference(time)])
        plant_row = plant.get_reals(RECORDED_PLANT)
        contacts.append(plant.get("contact"))
        controller.step(time, step_size)
        rows.append(plant_row + controller.get_reals(RECORDED_CONTROLLER))
        if order == "controller-first":
            transfer(controller, plant, CONTROLLER_TO_PLANT)
        plant.step(time, step_size)
        if order == "parallel":
            transfer(controller, plant, CONTROLLER_TO_PLANT)
    columns = dict(zip(RECORDED_PLANT + RECORDED_CONTROLLER, np.array(rows).T))
    return Trajectory(times, columns, np.array(contacts))


def initialize(plant: Fmu, controller: Fmu, options: argparse.Namespace) -> None:
    """Give both models their parameters and initialize them.

    The plant starts at rest in the middle of the range; `flux_error` is what the observer's first flux lacks.
    """
    plant.initialize(
        {"sensor.noise": options.noise, "sensor.seed": options.seed, "initial.position": options.initial_position},
        stop_time=options.stop_time,
    )
    equilibrium_flux = plant.get("flux")
    controller.initialize(
        {
            "current": plant.get("current_measured"),
            "sample_time": options.step_size,
            "observer.kind": options.observer,
            "observer.initial.flux": (1.0 - options.flux_error) * equilibrium_flux,
            "observer.voltage_source": "applied" if options.order == "parallel" else "command",
            "controller.reference_filter": REFERENCES[options.reference][1],
        },
        stop_time=options.stop_time,
    )


def root_mean_square(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def summary(trajectory: Trajectory) -> str:
    """What a reader wants to know first, as text."""
    touched = trajectory.time[trajectory.in_contact]
    lines = [f"The ball touches a stop at {touched[0]:g} s" if len(touched) else "The ball touches no stop"]
    tail = trajectory.time >= trajectory.time[-1] - TAIL
    lines.append(f"Root mean square errors of the last {TAIL:g} s:")
    lines.append(f"  position - reference {root_mean_square(trajectory.tracking_error()[tail]):9.2e} m")
    for name, unit in zip(STATE, ["m", "m/s", "Wb"]):
        lines.append(f"  estimated {name:<10} {root_mean_square(trajectory.error(name)[tail]):9.2e} {unit}")
    flux_share = 100.0 * root_mean_square(trajectory.error("flux")[tail]) / trajectory.columns["flux"][0]
    lines.append(f"Flux error: {flux_share:.3g} % of the flux that carries the ball")
    lines.append(f"Largest voltage: {np.abs(trajectory.columns['voltage']).max():.4g} V")
    return "\n".join(lines)


def draw(trajectory: Trajectory, title: str) -> Figure:
    """Position, velocity, flux and its offset, excitation, errors, voltage and current."""
    pyplot.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.axisbelow": True})
    figure, panels = pyplot.subplots(4, 2, figsize=(12, 10), sharex=True, layout="constrained")
    figure.suptitle(title, fontsize=11)
    time, columns = trajectory.time, trajectory.columns

    draw_state(panels[0, 0], trajectory, "position", 1e3, "Position [mm]")
    panels[0, 0].plot(time, columns["reference.position"] * 1e3, color="C1", linewidth=1.0, label="reference")
    draw_contact(panels[0, 0], trajectory)
    panels[0, 0].legend(loc="best", ncols=2)
    draw_state(panels[0, 1], trajectory, "velocity", 1e3, "Velocity [mm/s]")
    draw_state(panels[1, 0], trajectory, "flux", 1e3, "Flux linkage [mWb]")
    draw_offset(panels[1, 1], trajectory)
    draw_excitation(panels[2, 0], trajectory)
    draw_errors(panels[2, 1], trajectory)
    panels[3, 0].step(time, columns["voltage"], where="post", color="C3", linewidth=1.0)
    panels[3, 0].set_ylabel("Voltage [V]")
    panels[3, 1].plot(time, columns["current"], color="C2", linewidth=1.0)
    panels[3, 1].set_ylabel("Current [A]")
    for panel in panels[-1]:
        panel.set_xlabel("Time [s]")
        panel.margins(x=0.01)
    figure.align_ylabels()
    return figure


def draw_state(panel: Axes, trajectory: Trajectory, name: str, factor: float, label: str) -> None:
    """One component of the state, true and estimated."""
    time, columns = trajectory.time, trajectory.columns
    panel.plot(time, columns[name] * factor, color="0.7", linewidth=3.5, label="true")
    panel.plot(time, columns[f"estimate.{name}"] * factor, color="C0", linewidth=1.0, label="estimated")
    panel.set_ylabel(label)


def draw_contact(panel: Axes, trajectory: Trajectory) -> None:
    """Shades the time during which the ball rests on the magnet or on the lower stop."""
    if trajectory.in_contact.any():
        reach = panel.get_ylim()
        panel.fill_between(
            trajectory.time, *reach, where=trajectory.in_contact, color="C3", alpha=0.15, label="in contact"
        )
        panel.set_ylim(reach)


def draw_offset(panel: Axes, trajectory: Trajectory) -> None:
    """What the observer adds to the integrated voltage, and what it should add."""
    offset = trajectory.columns["observer.flux_offset"] * 1e3
    panel.plot(trajectory.time, offset - trajectory.error("flux") * 1e3, color="0.7", linewidth=3.5, label="true")
    panel.plot(trajectory.time, offset, color="C0", linewidth=1.0, label="estimated")
    panel.set_ylabel("Flux offset [mWb]")


def draw_excitation(panel: Axes, trajectory: Trajectory) -> None:
    """The determinant that drives drem; the other observers need none."""
    excitation = np.abs(trajectory.columns["observer.excitation"])
    panel.set_ylabel("|Excitation| [1]")
    if (excitation > SMALLEST_EXCITATION).any():
        panel.plot(trajectory.time, np.maximum(excitation, SMALLEST_EXCITATION), color="C4", linewidth=0.8)
        panel.set_yscale("log")
    else:
        panel.annotate("none, or none needed", (0.5, 0.5), xycoords="axes fraction", ha="center", color="0.4")


def draw_errors(panel: Axes, trajectory: Trajectory) -> None:
    """Magnitudes of the estimation errors; smaller ones, zero too, appear at the lower edge."""
    for name, unit in zip(STATE, ["m", "m/s", "Wb"]):
        error = np.maximum(np.abs(trajectory.error(name)), SMALLEST_ERROR)
        panel.plot(trajectory.time, error, linewidth=0.8, label=f"{name} [{unit}]")
    panel.set_yscale("log")
    panel.set_ylabel("Estimation error")
    panel.legend(loc="best", ncols=3)


def arguments() -> argparse.Namespace:
    parser = command_line.parser(__doc__)
    parser.add_argument(
        "--order",
        choices=["controller-first", "parallel"],
        default="controller-first",
        help="exchange order; parallel lets the observer use the measured voltage",
    )
    parser.add_argument("--reference", choices=list(REFERENCES), default="sinusoids", help="position reference")
    parser.add_argument(
        "--observer", default="drem", help="observer: drem, polynomial_newton or polynomial_newton_adaptive"
    )
    parser.add_argument(
        "--flux-error",
        type=number("1"),
        default=0.1,
        metavar="SHARE",
        help="initial flux error of the observer, as a share of the equilibrium flux",
    )
    parser.add_argument("--initial-position", type=number("m"), default=0.0, metavar="M", help="y(0) in m")
    parser.add_argument(
        "--noise", type=number("A"), default=0.0, metavar="A", help="current noise, standard deviation in A"
    )
    parser.add_argument("--seed", type=command_line.seed, default=1, help="seed of the noise")
    command_line.add_run_options(parser, 4.0, 1e-4, "sample time and communication step size in s", "ball.png")
    return command_line.parse(parser)


def title(options: argparse.Namespace, fmi_version: str) -> str:
    return (
        f"Levitated ball without position sensor, {options.observer}, reference {options.reference}, "
        f"{options.flux_error:+.0%} initial flux error, noise {options.noise:g} A, T = {options.step_size:g} s\n"
        f"FMI {fmi_version}, exchange order {options.order}"
    )


def main() -> None:
    options = arguments()
    folder = options.dist / f"fmi{options.fmi}"
    with command_line.explained():
        with (
            Fmu(folder / "LevitatedBallPlant.fmu") as plant,
            Fmu(folder / "LevitatedBallController.fmu") as controller,
        ):
            initialize(plant, controller, options)
            reference = REFERENCES[options.reference][0]
            trajectory = simulate(plant, controller, reference, options.order, options.step_size, options.stop_time)
            figure = draw(trajectory, title(options, plant.description.fmiVersion))
    command_line.finish(summary(trajectory), figure, options)


if __name__ == "__main__":
    main()
