"""The FMUs under test."""

from __future__ import annotations

import os
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
FMI_VERSIONS = [2, 3]
PLANT, CONTROLLER = BEARING_UNITS = ["MagneticBearingPlant", "MagneticBearingController"]
BALL_UNITS = ["LevitatedBallPlant", "LevitatedBallController"]
UNITS = BEARING_UNITS + BALL_UNITS


def dist() -> Path:
    """Directory with fmi2/ and fmi3/."""
    return Path(os.environ.get("MAGLEV_DIST", REPOSITORY / "dist")).resolve()


def fmu_path(fmi_version: int, unit: str) -> Path:
    return dist() / f"fmi{fmi_version}" / f"{unit}.fmu"
