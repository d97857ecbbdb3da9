"""The libraries that `scripts/cross` builds for other platforms ask for nothing new, and give the bits of the native one.

Where they can run, a C program steps a loop through a library: under Wine, under QEMU, or natively against an old glibc. What
it prints is compared with `maglev-fmu trace`, which knows no FMI and was built for this machine.
"""

from __future__ import annotations

import os
import re
import shutil
import struct
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from cross_build.platforms import MINGW, OLDEST_GLIBC, OLDEST_MACOS, PLATFORMS
from fmpy import read_model_description
from fmpy.model_description import ModelDescription
from importers.system_structure import SystemStructure
from packages import DESCRIPTIONS, REPOSITORY, dist
from test_bit_identity import executable

STEPS = 10_000
SYSTEMS = ["bearing", "ball", "rig"]
PROGRAM = REPOSITORY / "tests" / "platforms" / "loop.c"
FLAGS = ["-std=c99", "-O2", "-pedantic", "-Wall", "-Wextra", "-Werror"]


@dataclass(frozen=True)
class Machine:
    """How a program for a platform is made and run here."""

    compiler: list[str]
    runner: list[str]


MACHINES = {
    "x86_64-linux": Machine(["cc", "-D_POSIX_C_SOURCE=200809L", "-ldl"], []),
    "aarch64-linux": Machine(
        ["aarch64-linux-gnu-gcc", "-D_POSIX_C_SOURCE=200809L", "-ldl"],
        ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
    ),
    "x86_64-windows": Machine([MINGW, "-D__USE_MINGW_ANSI_STDIO=1"], ["wine"]),
}


def library(name: str) -> Path:
    """Where `scripts/cross` leaves the library of a platform."""
    platform = next(platform for platform in PLATFORMS if platform.tuple == name)
    return REPOSITORY / "target" / "cross" / platform.target / "release" / platform.library


def missing(name: str) -> list[str]:
    """What a platform lacks here."""
    machine = MACHINES.get(name)
    if machine is None:
        return ["a machine of this kind, or a program that stands for one"]
    tools = [tool for tool in [machine.compiler[0], *machine.runner[:1]] if shutil.which(tool) is None]
    return tools if library(name).is_file() else [*tools, "the library: scripts/cross"]


@cache
def description(model: str) -> ModelDescription:
    return read_model_description(str(DESCRIPTIONS / "fmi2" / f"{model}.xml"), validate=False)


def choices() -> list[tuple[str, str, str]]:
    """Every observer and every law of each system's controller."""
    found = []
    for system in SYSTEMS:
        controller = SystemStructure(dist() / f"{system}.ssp").element("Controller")
        for variable in description(controller).modelVariables:
            if variable.name in ("observer.kind", "controller.law", "controller.kind", "observer.discretisation"):
                found += [(system, variable.name, item.name) for item in variable.declaredType.items]
    return found


def bits(value: float) -> str:
    return struct.pack(">d", value).hex()


def script(system: str, name: str, item: str, header: str) -> str:
    """What the C program is to do so that it prints the columns that `trace` printed."""
    structure = SystemStructure(dist() / f"{system}.ssp")
    models = {"p": structure.element("Plant"), "c": structure.element("Controller")}
    letters = {model: letter for letter, model in models.items()}

    def variable(letter: str, wanted: str):
        return next(known for known in description(models[letter]).modelVariables if known.name == wanted)

    def reference(letter: str, wanted: str) -> int:
        return variable(letter, wanted).valueReference

    lines = [f"make {letter} {model} {description(model).guid}" for letter, model in models.items()]
    lines.append(f"real p {reference('p', 'sensor.noise')} {bits(NOISE[system])}")
    choice = variable("c", name)
    number = next(known.value for known in choice.declaredType.items if known.name == item)
    lines.append(f"item c {choice.valueReference} {number}")
    for source, start, target, end in structure.inner_connections:
        lines.append(f"wire {letters[source]} {reference(letters[source], start)} {reference(letters[target], end)}")
    for column in header.split(","):
        model, _, output = column.partition(".")
        lines.append(f"out {model[0]} {reference(model[0], output)}")
    lines.append(f"run {STEPS} {bits(float(variable('c', 'sample_time').start))}")
    return "\n".join(lines) + "\n"


# Standard deviations of the sensors, so that what is random takes part.
NOISE = {"bearing": 1e-7, "ball": 1e-6, "rig": 1e-3}


@cache
def trace(system: str, name: str, item: str) -> list[str]:
    """The lines of the run without FMI, the names of the columns first."""
    command = [executable(), "trace", system, "--steps", str(STEPS)]
    command += ["--plant", f"sensor.noise={NOISE[system]!r}", "--controller", f"{name}={item}"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()


# What each system has had for long.
SYSTEM_LIBRARIES = {
    "linux": {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"},
    "windows": {"kernel32.dll", "ntdll.dll", "msvcrt.dll", "advapi32.dll", "userenv.dll", "ws2_32.dll"},
    "darwin": {"/usr/lib/libSystem.B.dylib"},
}
LARGEST = 1 << 20
IDENTITY, LOAD, SIGNATURE = 0xD, 0xC, 0x1D
OLDEST_SYSTEM = {0x24: 8, 0x32: 12}
"""Commands for the loader of macOS; where in a command the version of the oldest system stands."""


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def number(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def loader_commands(binary: bytes) -> list[tuple[int, bytes]]:
    """Kind and contents of the commands in a library for macOS."""
    (count,), place, found = struct.unpack_from("<I", binary, 16), 32, []
    for _ in range(count):
        kind, size = struct.unpack_from("<2I", binary, place)
        found.append((kind, binary[place : place + size]))
        place += size
    return found


def text_at(command: bytes, place: int) -> str:
    return command[place:].split(b"\0")[0].decode()


def check_linux(path: Path) -> set[str]:
    """Libraries that one for Linux asks for, whose versions are checked."""
    versions = re.findall(r"Name: GLIBC_([\d.]+)", output("readelf", "--wide", "--version-info", path))
    assert versions and max(map(number, versions)) <= number(OLDEST_GLIBC), versions
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "--wide", "--dynamic", path)))


def check_windows(path: Path) -> set[str]:
    """Libraries that one for Windows asks for."""
    names = re.findall(r"DLL Name: (\S+)", output(MINGW.replace("gcc", "objdump"), "--private-headers", path))
    return {name.lower() for name in names}


def check_darwin(path: Path) -> set[str]:
    """Libraries that one for macOS asks for; Arm processors run signed ones only."""
    commands = loader_commands(path.read_bytes())
    processor = "aarch64" if "aarch64" in str(path) else "x86_64"
    assert processor == "x86_64" or any(kind == SIGNATURE for kind, _ in commands)
    versions = [(command, OLDEST_SYSTEM[kind]) for kind, command in commands if kind in OLDEST_SYSTEM]
    (oldest,) = [struct.unpack_from("<I", command, place)[0] for command, place in versions]
    assert (oldest >> 16, oldest >> 8 & 255) <= number(OLDEST_MACOS[processor])
    assert [text_at(command, 24) for kind, command in commands if kind == IDENTITY] == [f"@rpath/{path.name}"]
    return {text_at(command, 24) for kind, command in commands if kind == LOAD}


CHECKS = {"linux": check_linux, "windows": check_windows, "darwin": check_darwin}


@pytest.mark.parametrize("platform", [platform.tuple for platform in PLATFORMS])
def test_library_is_small_and_asks_for_nothing_new(platform: str) -> None:
    path = library(platform)
    if not path.is_file():
        pytest.skip(f"{platform} not checked: no library: scripts/cross")
    system = platform.rpartition("-")[2]
    needed = CHECKS[system](path)
    assert needed and needed <= SYSTEM_LIBRARIES[system]
    assert path.stat().st_size <= LARGEST
    # The same wherever it was built.
    for place in (REPOSITORY, Path.home() / ".cargo", Path.home() / ".rustup"):
        assert str(place).encode() not in path.read_bytes()


@pytest.fixture(scope="session")
def programs(tmp_path_factory: pytest.TempPathFactory):
    """Makes the C program for a platform."""
    directory = tmp_path_factory.mktemp("platforms")

    @cache
    def make(name: str) -> Path:
        program = directory / f"loop-{name}.exe"
        compiler, *options = MACHINES[name].compiler
        subprocess.run([compiler, *FLAGS, PROGRAM, "-o", program, *options], check=True)
        return program

    return make


@pytest.fixture(scope="session")
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Wine keeps its files away from the user's."""
    prefix = tmp_path_factory.mktemp("wine")
    return {**os.environ, "WINEPREFIX": str(prefix), "WINEDEBUG": "-all", "WINEARCH": "win64"}


@pytest.mark.parametrize(("system", "name", "item"), choices(), ids="-".join)
@pytest.mark.parametrize("platform", [platform.tuple for platform in PLATFORMS])
def test_bits_are_those_of_this_machine(
    platform: str, system: str, name: str, item: str, programs, environment: dict[str, str]
) -> None:
    if lacking := missing(platform):
        pytest.skip(f"{platform} not run: no {', no '.join(lacking)}")
    header, *native = trace(system, name, item)
    command = [*MACHINES[platform].runner, programs(platform), library(platform)]
    run = subprocess.run(
        command, input=script(system, name, item, header), capture_output=True, text=True, env=environment, check=False
    )
    assert run.returncode == 0, run.stderr
    rows = run.stdout.split()
    first = next((row for row, pair in enumerate(zip(rows, native, strict=False)) if pair[0] != pair[1]), None)
    assert first is None, f"row {first}: {rows[first]} on {platform}, {native[first]} here"
    assert len(rows) == len(native) == STEPS
