"""What the simulation scripts share on the command line: options, their checks, and how a script ends."""

from __future__ import annotations

import argparse
import io
import math
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from fmpy.fmi1 import FMICallException
from matplotlib import pyplot
from matplotlib.figure import Figure
from standard_output import Parser, tell

REPOSITORY = Path(__file__).resolve().parent.parent

# Every row of a run is kept to be drawn.
MOST_STEPS = 1_000_000
# What the seed's variable holds, a 32-bit integer.
LARGEST_SEED = 2**31 - 1


def number(unit: str) -> Callable[[str], float]:
    """Type of an option: a finite number."""
    return _checked(unit, "a finite number", lambda value: True)


def positive(unit: str) -> Callable[[str], float]:
    """Type of an option: a finite number greater than 0."""
    return _checked(unit, "a finite number greater than 0", lambda value: value > 0.0)


def _checked(unit: str, expected: str, fits: Callable[[float], bool]) -> Callable[[str], float]:
    def parse(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or not fits(value):
            raise argparse.ArgumentTypeError(f"{text!r}: expected {expected} of {unit}")
        return value

    return parse


def seed(text: str) -> int:
    """Type of an option: a seed of random numbers."""
    try:
        value = int(text)
    except ValueError:
        value = -1
    if not 0 <= value <= LARGEST_SEED:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a whole number from 0 to {LARGEST_SEED}")
    return value


def image(text: str) -> Path:
    """Type of an option: a picture that can be written."""
    path = Path(text)
    kinds = sorted(Figure().canvas.get_supported_filetypes())
    if path.suffix.removeprefix(".").lower() not in kinds:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a name that ends with one of .{', .'.join(kinds)}")
    try:
        directory = path.absolute().parent.resolve(strict=True)
        is_file = path.is_file() or not path.exists()
    except OSError:
        is_file = False
    # A picture is written under another name first, which is no business of a directory of devices.
    if not is_file or not directory.is_dir() or directory == Path("/dev"):
        raise argparse.ArgumentTypeError(f"{text!r}: expected a file in a directory that exists, no device")
    return path


def parser(documentation: str) -> argparse.ArgumentParser:
    """Parser with the options that say which models to run."""
    made = Parser(
        description=documentation.split("\n")[0], formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    made.add_argument("--fmi", type=int, choices=[2, 3], default=3, help="FMI version of the FMUs")
    made.add_argument("--dist", type=Path, default=REPOSITORY / "dist", help="directory with fmi2/ and fmi3/")
    return made


def add_run_options(made: argparse.ArgumentParser, stop_time: float, step_size: float, step_help: str, name: str) -> None:
    """The options of the run's extent and of its picture."""
    made.add_argument(
        "--stop-time", type=positive("s"), default=stop_time, metavar="S", help="end of the simulation in s"
    )
    made.add_argument("--step-size", type=positive("s"), default=step_size, metavar="S", help=step_help)
    made.add_argument("--out", type=image, metavar="FILE", help=f"image to write, for instance {name}")
    made.add_argument("--show", action="store_true", help="open a window with the plots")


def parse(made: argparse.ArgumentParser) -> argparse.Namespace:
    """The options, if they fit together; without a window, pictures are drawn without one."""
    options = made.parse_args()
    steps = options.stop_time / options.step_size
    if not 1 <= round(min(steps, MOST_STEPS + 1)) <= MOST_STEPS:
        made.error(
            f"--stop-time {options.stop_time:g} s with --step-size {options.step_size:g} s is {steps:.4g} steps: "
            f"expected 1 to {MOST_STEPS}"
        )
    # Whole steps: the models compute nothing past the stop time.
    options.stop_time = round(steps) * options.step_size
    if not options.show:
        pyplot.switch_backend("Agg")
    return options


@contextmanager
def explained() -> Iterator[None]:
    """Ends the script with a message where the user can help it, and without a traceback."""
    try:
        yield
    except FileNotFoundError as error:
        sys.exit(f"{one_line(error)}\nBuild the FMUs first: cargo run --release -- build")
    except (OSError, ValueError, FMICallException) as error:
        sys.exit(one_line(error))
    except KeyError as error:
        sys.exit(one_line(error.args[0]))


def one_line(text: object) -> str:
    """A message in one line, with whatever steers the terminal escaped: messages quote names from files."""
    return "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in str(text))


def finish(summary: str, figure: Figure, options: argparse.Namespace) -> None:
    """Tell the summary, and save and show the figure as the options say."""
    if options.out:
        save(figure, options.out)
    tell(summary)
    if options.out:
        tell(f"Figure: {options.out}")
    if options.show:
        pyplot.show()


def save(figure: Figure, path: Path) -> None:
    """Write a picture under another name first, so that it appears whole or not at all; a link stays a link."""
    picture = io.BytesIO()
    try:
        figure.savefig(picture, format=path.suffix.removeprefix(".").lower(), dpi=150)
    except Exception as error:  # of whatever library or program draws this kind of picture
        sys.exit(f"cannot draw {path}: {one_line(error)}")
    path = path.resolve()
    part = path.with_name(f".{os.getpid()}.part")
    try:
        with part.open("xb") as file:
            file.write(picture.getvalue())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        sys.exit(f"cannot write {path}: {error.strerror or error}")
