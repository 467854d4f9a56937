"""The results of a study as the report reads them."""

from __future__ import annotations

from pathlib import Path

from .. import store
from ..report.catalogue import calibrated_on
from ..report.study import Site, Study


def load(results: Path, config: dict, software: dict | None = None) -> Study:
    """Every dataset that tables, figures and page are made from, read from the folder of results."""
    model = config["model"]
    calibrations = {name: results / name / model / "calibration.nc" for name in calibrated_on(config["sites"])}
    assessment = results / "comfort" / model / "agreement.nc"
    return Study(
        sites=tuple(_site(results, name, model, settings) for name, settings in config["sites"].items()),
        calibrations={name: store.read(file) for name, file in calibrations.items()},
        calibration_files={name: file.as_posix() for name, file in calibrations.items()},
        assessment=store.read(assessment),
        assessment_file=assessment.as_posix(),
        model=model,
        settings=config,
        software=software or {},
    )


def _site(results: Path, name: str, model: str, settings: dict) -> Site:
    files = {key: results / name / f"{key}.nc" for key in ("road", "samples", "inspection")}
    files |= {key: results / name / model / "comfort" / f"{key}.nc" for key in ("thresholds", "iso2631", "iri")}
    if settings["has_drives"]:
        files["comparison"] = results / name / model / "comparison.nc"
    return Site(
        name,
        **{key: store.read(file) for key, file in files.items()},
        standin=settings["standin"],
        title=settings["title"],
        calibrated_on=settings["calibrated_on"],
        speed_limit_km_h=settings["speed"]["limit_km_h"],
        sampling=settings["sampling"],
        files={key: file.as_posix() for key, file in files.items()},
    )
