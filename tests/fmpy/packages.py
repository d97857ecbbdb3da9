"""The FMUs under test."""

from __future__ import annotations

import os
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
FMI_VERSIONS = [2, 3]
PLANT, CONTROLLER = BEARING_MODELS = ["MagneticBearingPlant", "MagneticBearingController"]
BALL_MODELS = ["LevitatedBallPlant", "LevitatedBallController"]

DESCRIPTIONS = REPOSITORY / "modelDescription"
MODELS = sorted(path.stem for path in DESCRIPTIONS.glob("fmi2/*.xml"))
SAMPLED_MODELS = sorted(path.stem for path in DESCRIPTIONS.glob("fmi3-clocked/*.xml"))


def dist() -> Path:
    """Directory with the directories of packages."""
    return Path(os.environ.get("MAGLEV_DIST", REPOSITORY / "dist")).resolve()


def fmu_path(fmi_version: int, model: str) -> Path:
    """The package that every importer reads."""
    return dist() / f"fmi{fmi_version}" / f"{model}.fmu"


def clocked_path(model: str) -> Path:
    """The package of FMI 3.0 that shows the model's clocks."""
    return dist() / "fmi3-clocked" / f"{model}.fmu"


def all_fmus() -> list[Path]:
    """Every package of a model that there is."""
    return sorted(dist().glob("fmi*/*.fmu"))
