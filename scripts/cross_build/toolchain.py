"""What cross builds take: a Rust compiler with the sources of its standard library, zig, and MinGW-w64."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from dataclasses import dataclass
from pathlib import Path

from cross_build.platforms import MINGW, Platform

ROOT = Path(__file__).resolve().parents[2]
REQUIREMENTS = Path(__file__).with_name("requirements.txt")

DEBIAN_RUST = ["cargo-web", "rustc-web", "rust-web-src"]
DEBIAN_MINGW = ["gcc-mingw-w64-x86-64"]
DEBIAN_EMULATORS = {
    "wine": ["wine", "wine64"],
    "qemu-aarch64": ["qemu-user"],
    "aarch64-linux-gnu-gcc": ["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross"],
}
"""Packages by the program in them: with these, libraries for other platforms are run by the tests."""


class MissingToolError(Exception):
    """A tool that is not there, and how to get it."""


@dataclass(frozen=True)
class Rust:
    """A compiler that can build its standard library anew."""

    cargo: str
    rustc: str
    version: str
    sources: Path
    """Of the standard library."""


def output(*command: str | Path) -> str:
    """What a command prints, or nothing if it fails."""
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return run.stdout.strip() if run.returncode == 0 else ""


def oldest_version() -> tuple[int, ...]:
    """Of the compiler, as Cargo.toml demands it."""
    manifest = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    return tuple(int(part) for part in manifest["workspace"]["package"]["rust-version"].split("."))


def with_sources(cargo: str | None, rustc: str | None) -> Rust | None:
    """This compiler, if it is there, new enough, and has the sources of its standard library."""
    if not cargo or not rustc:
        return None
    version = output(rustc, "--version")
    sources = Path(output(rustc, "--print", "sysroot")) / "lib/rustlib/src/rust"
    number = re.match(r"rustc (\d+)\.(\d+)", version)
    if not number or not (sources / "library/std/Cargo.toml").exists():
        return None
    is_new_enough = tuple(map(int, number.groups())) >= oldest_version()[:2]
    return Rust(cargo, rustc, version, sources.resolve()) if is_new_enough else None


def find_rust(install: bool) -> Rust:
    """The compiler of rustup, which may fetch its sources, or that of the system, such as Debian's."""
    cargo, rustc = shutil.which("cargo"), shutil.which("rustc")
    own = with_sources(cargo, rustc)
    if own is None and shutil.which("rustup"):
        # Where rustup reaches its server; nothing changes where it does not.
        subprocess.run(["rustup", "component", "add", "rust-src"], capture_output=True, check=False)
        own = with_sources(cargo, rustc)
    system = ("/usr/bin/cargo", "/usr/bin/rustc")
    found = own or with_sources(*system)
    if found is None and install and install_debian(DEBIAN_RUST):
        found = with_sources(*system)
    if found is None:
        version = ".".join(map(str, oldest_version()))
        raise MissingToolError(
            f"no Rust {version} or newer with the sources of its standard library: "
            f"`rustup component add rust-src`, or on Debian `apt-get install {' '.join(DEBIAN_RUST)}`"
        )
    return found


def install_debian(packages: list[str]) -> bool:
    """Installs packages of Debian or Ubuntu, where that is possible."""
    if shutil.which("apt-get") is None or os.geteuid() != 0:
        return False
    print(f"installing {' '.join(packages)}", flush=True)
    quiet = ["apt-get", "-q", "-y"]
    for command in ([*quiet, "update"], [*quiet, "install", "--no-install-recommends", *packages]):
        if subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode != 0:
            return False
    return True


def install_emulators() -> None:
    """Installs what libraries for other platforms are tried with, where it is missing."""
    missing = [name for program, names in DEBIAN_EMULATORS.items() if shutil.which(program) is None for name in names]
    if missing and not install_debian(missing):
        print(f"not installed: {', '.join(missing)}", flush=True)


def find_mingw(install: bool) -> str:
    """The linker for Windows."""
    if shutil.which(MINGW) is None and install:
        install_debian(DEBIAN_MINGW)
    found = shutil.which(MINGW)
    if found is None:
        raise MissingToolError(f"no {MINGW}: on Debian `apt-get install {' '.join(DEBIAN_MINGW)}`")
    return found


def find_zig(directory: Path) -> list[str]:
    """The command of zig, from an environment in `directory` that holds what the requirements say."""
    python = directory / "bin/python"
    stamp, wanted = directory / "requirements.txt", REQUIREMENTS.read_text(encoding="utf-8")
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        shutil.rmtree(directory, ignore_errors=True)
        venv.create(directory, with_pip=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        run = subprocess.run([*pip, "--no-deps", "--require-hashes", "-r", REQUIREMENTS], check=False)
        if run.returncode != 0:
            raise MissingToolError(f"zig could not be installed: pip says why above ({sys.platform})")
        stamp.write_text(wanted, encoding="utf-8")
    return [str(python), "-m", "ziglang"]


def linker(platform: Platform, directory: Path, install: bool) -> str:
    """Path of a program that links for the platform; tools go to `directory`."""
    if platform.zig_target is None:
        return find_mingw(install)
    zig = find_zig(directory / "zig")
    script = directory / "linkers" / platform.tuple
    script.parent.mkdir(parents=True, exist_ok=True)
    words = " ".join(f"'{word}'" for word in [*zig, "cc", "-target", platform.zig_target])
    script.write_text(f'#!/bin/sh\nexec {words} "$@"\n', encoding="utf-8")
    script.chmod(0o755)
    return str(script)
