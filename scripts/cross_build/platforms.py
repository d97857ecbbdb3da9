"""The platforms that packages hold a library for."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Platform:
    """A platform, and how its library is built."""

    tuple: str
    """Its name in FMI 3.0."""
    target: str
    """The compiler's name for it."""
    library: str
    """What Cargo calls the file."""
    zig_target: str | None
    """Whose libraries zig links with; MinGW-w64 links if there is none."""

    @property
    def link_arguments(self) -> list[str]:
        """What the linker is told beside what the compiler tells it."""
        # Else the library holds where it was built.
        return [f"-Wl,-install_name,@rpath/{self.library}"] if self.tuple.endswith("darwin") else []

    @property
    def linker_variable(self) -> str:
        """Environment variable that tells Cargo the linker."""
        return f"CARGO_TARGET_{self.target.replace('-', '_').upper()}_LINKER"


OLDEST_GLIBC = "2.17"
"""Of the C library that both Linux libraries are linked with: RHEL 7 and newer."""

OLDEST_MACOS = {"x86_64": "10.13", "aarch64": "11.0"}
"""By processor."""

PLATFORMS = [
    Platform("x86_64-linux", "x86_64-unknown-linux-gnu", "libmaglev_models.so", f"x86_64-linux-gnu.{OLDEST_GLIBC}"),
    Platform("aarch64-linux", "aarch64-unknown-linux-gnu", "libmaglev_models.so", f"aarch64-linux-gnu.{OLDEST_GLIBC}"),
    # The target of Windows 7 takes no library that Windows 10 or Wine lacks.
    Platform("x86_64-windows", "x86_64-win7-windows-gnu", "maglev_models.dll", None),
    Platform("x86_64-darwin", "x86_64-apple-darwin", "libmaglev_models.dylib", f"x86_64-macos.{OLDEST_MACOS['x86_64']}"),
    Platform("aarch64-darwin", "aarch64-apple-darwin", "libmaglev_models.dylib", f"aarch64-macos.{OLDEST_MACOS['aarch64']}"),
]

MINGW = "x86_64-w64-mingw32-gcc"


def find(names: list[str]) -> list[Platform]:
    """The platforms of these names, all if there are none; unknown ones end the program."""
    known = {platform.tuple: platform for platform in PLATFORMS}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"error: no platform {', '.join(unknown)}: expected some of {', '.join(known)}")
    return [known[name] for name in dict.fromkeys(names)] or PLATFORMS
