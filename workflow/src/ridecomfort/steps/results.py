"""The results of a study as the report reads them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from .. import store
from ..report.catalogue import calibrated_on, label, of_another_study, with_drives
from ..report.study import Compared, Diagnosis, Difference, Site, Study
from ..study import aligned_file, verdicts_on_less
from .models import FOLLOWED


def load(results: Path, config: dict, software: dict | None = None) -> Study:
    """Every dataset that tables and figures of the study are made from, read from the folder of results."""
    model = config["model"]
    calibrations = _calibration_files(results, config)
    assessment = results / "comfort" / model / "agreement.nc"
    return Study(
        sites=tuple(_site(results, name, model, settings) for name, settings in config["sites"].items()),
        calibrations={name: store.read(file) for name, file in calibrations.items()},
        calibration_files={name: file.as_posix() for name, file in calibrations.items()},
        standin_calibrations=config["standin_calibrations"],
        assessment=store.read(assessment),
        assessment_file=assessment.as_posix(),
        model=model,
        settings=config,
        software=software or {},
    )


def whole(results: Path, config: dict, software: dict, later: Sequence[Path] = ()) -> Study:
    """As ``load``, with the comparison with measured drives and the diagnosis; ``later`` as for that."""
    return replace(
        load(results, config, software),
        difference=difference(results, config) if with_drives(config["sites"]) else None,
        diagnosis=diagnosis(results, config, later),
    )


def difference(results: Path, config: dict) -> Difference:
    """Comparisons and aligned drives of the measured sites with the model of ``config``, its calibrations, and the error ladder."""
    model = config["model"]
    ladder = results / "ladder" / f"{model}.nc"
    calibrations = _calibration_files(results, config)
    return Difference(
        sites=tuple(compared(results, config, name) for name in with_drives(config["sites"])),
        ladder=store.read(ladder),
        ladder_file=ladder.as_posix(),
        model=model,
        calibrations={name: store.read(file) for name, file in calibrations.items()},
        calibration_files={name: file.as_posix() for name, file in calibrations.items()},
        standin_calibrations=config["standin_calibrations"],
    )


def compared(results: Path, config: dict, name: str) -> Compared:
    """Comparison and aligned drives of a measured site with the model of ``config``."""
    model, calibrated = config["model"], config["sites"][name]["calibrated_on"]
    files = {"measured": results / aligned_file(name, model, calibrated), "comparison": results / name / model / "comparison.nc"}
    loaded = {key: store.read(file) for key, file in files.items()}
    return Compared(
        name,
        **loaded,
        standin=config["sites"][name]["standin"],
        files={key: file.as_posix() for key, file in files.items()},
        standin_calibrations=[site for site in config["standin_calibrations"] if site == calibrated],
    )


def diagnosis(results: Path, config: dict, later: Sequence[Path] = ()) -> Diagnosis | None:
    """The verdict on the model of ``config`` with its evidence, None where ``config`` does not ask for it (``diagnosed``); ``later``: files of the
    verdicts on what comes of that model by it, one after another."""
    if not config.get("diagnosed"):
        return None
    folder = results / "diagnosis" / config["model"]
    files = {"verdict": folder / "verdict.json", "ranking": folder / "ranking.nc", "score": folder / "score.json"}
    if not config["scored"]:
        del files["score"]
    verdict = json.loads(files["verdict"].read_text(encoding="utf-8"))
    return Diagnosis(
        verdict,
        store.read(files["ranking"]),
        files={key: file.as_posix() for key, file in files.items()},
        model=config["model"],
        switched_on=tuple(config["switched_on"]),
        held=config["held"],
        sites=tuple(config["diagnosed"]),
        standin=tuple(label(site) for site, is_standin in config["diagnosed"].items() if is_standin),
        score=json.loads(files["score"].read_text(encoding="utf-8")) if "score" in files else None,
        told_before=_told_before(results, config["switched_on"], verdict),
        later={file.parent.name: json.loads(file.read_text(encoding="utf-8")) for file in later},
    )


def _told_before(results: Path, switched_on: Sequence[str], verdict: Mapping) -> dict[str, dict]:
    """What verdicts on models with fewer effects, fitted to the same drives of the same vehicle as this one, said of those that are ``switched_on`` by now, by name,
    each with the ``model``; of several the one on the most effects."""
    found: dict[str, dict] = {}
    fitted = lambda said: said["digests"][said["sites"][0]] if "digests" in said else None
    for file in verdicts_on_less(results, switched_on):
        said = json.loads(file.read_text(encoding="utf-8"))
        if said["verdict"] in FOLLOWED and fitted(said) == fitted(verdict):
            found |= {effect["name"]: {**effect, "model": file.parent.name} for effect in said["effects"] if effect["name"] in switched_on}
    return found


def drop_others(folder: Path, sites: dict) -> None:
    """Delete the tables or figures that an earlier study of other sites left in the folder."""
    drop(folder, lambda name: of_another_study(name, sites))


def drop(folder: Path, is_old: Callable[[str], bool]) -> None:
    """Delete the tables or figures of a folder whose names are those of an earlier study."""
    for path in folder.glob("*.*"):
        if is_old(path.name.split(".")[0]):
            path.unlink()


def _calibration_files(results: Path, config: dict) -> dict[str, Path]:
    return {name: results / name / config["model"] / "calibration.nc" for name in calibrated_on(config["sites"])}


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
