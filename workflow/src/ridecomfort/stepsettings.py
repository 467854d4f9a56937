"""Exactly the settings that each step uses: when they change, and only then, the step runs again."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

from .study import Study, digest, verdicts_on_less
from .vocabulary import STANDARD_GRAVITY


def of_step(study: Study, step: str, site: str | None = None, model: str | None = None) -> dict:
    """The settings of a step, on a site and with a model where it has one, as plain data. Raises KeyError for no step."""
    chosen = study.settings
    own = {} if site is None else study.sites[site]
    at = {} if site is None else {"site": site}
    simulation = {key: chosen["simulation"][key] for key in ("step", "rate")}
    simulated = {
        **at,
        "effects": study.effects(model),
        "effects_folder": chosen["effects_folder"] if study.has_own_effects(model) else None,
        "simulation": simulation,
    }
    comfort, calibration = chosen["comfort"], chosen["calibration"]
    sections = {**at, **{key: comfort[key] for key in ("critical_length", "sections")}}
    match step:
        case "standin_road":
            surface = {key: value for key, value in study.standin.items() if key not in ("measurement", "scanner")}
            return {**surface, **at, "sites": {site: study.standin["sites"][site]}}
        case "standin_drives":
            speed = {site: {"speed": study.standin["sites"][site]["speed"]}}
            keys = ("file", "columns", "sensor", "role")
            drives = [{key: drive[key] for key in keys if key in drive} for drive in own["drives"]]
            return {**at, **{key: study.standin[key] for key in ("seed", "measurement")}, "sites": speed, "drives": drives}
        case "standin_scan":
            return {**at, "seed": study.standin["seed"], "scanner": study.standin["scanner"]}
        case "survey":
            grid = {key: own["road"]["scan"][key] for key in ("spacing", "width")}
            return {**at, **grid}
        case "road":
            return {**at, "standin": own["standin"], "options": own["road"]["options"]}
        case "inspect":
            return {
                **at,
                "options": own["road"]["options"],
                "wheel_tracks": comfort["iri"]["wheel_tracks"],
                "speed": own["speed"],
                "lateral_position": _mean(own["sampling"]["lateral_position"]),
                "simulation": simulation,
            }
        case "measured":
            return {**_aligned(study, site), **at, "simulation": simulation}
        case "realigned":
            roughly = {key: calibration[key] for key in ("parameters", "bounds", "signals", "start")}
            return {**_aligned(study, site), **simulated, "calibration": roughly if study.is_fitted(site) else None}
        case "calibrate":
            return {**simulated, "calibration": calibration}
        case "compare":
            return {**simulated, "noise_density": _noise_densities(own["drives"])}
        case "critical":
            weighted = {key: value for key, value in comfort["iso2631"].items() if key != "label"}
            return {
                **at,
                "spacing": chosen["space"]["spacing"],
                "critical_length": comfort["critical_length"],
                "thresholds": comfort["thresholds"],
                "iso2631": weighted,
            }
        case "located":
            return {"model": model, **_shown(study, [site])}
        case "compared":
            return {"model": model, **_shown(study, study.measured)}
        case "diagnosed":
            return {"model": model, "diagnosed": _diagnosed(study), "scored": False, **_switched_on(study)}
        case "standin_score":
            known = {"effects": list(study.effects(model)), "effects_folder": chosen["effects_folder"]}
            return {"model": model, "sites": study.diagnosed, **known}
        case "diagnose":
            return {
                **simulated,
                "effects_folder": chosen["effects_folder"],
                "sites": study.diagnosed,
                "fitted_on": study.diagnosed[:1],
                "bounds": {name: pair for name, pair in calibration["bounds"].items() if name in calibration["parameters"]},
                "uncertain": chosen["diagnosis"]["uncertain"],
                "noise_density": {name: _noise_densities(study.sites[name]["drives"]) for name in study.diagnosed},
                "seed": chosen["seed"],
                "among": None,
            }
        case "sample":
            return {
                **at,
                "runs": chosen["runs"],
                "seed": chosen["seed"],
                "method": chosen["sampling_method"],
                "sampling": own["sampling"],
            }
        case "simulate":
            return {**simulated, "speed": own["speed"], "space": chosen["space"]}
        case "handed_in":
            return {**at, "rate": chosen["simulation"]["rate"]}
        case "space":
            weighted = {key: value for key, value in comfort["iso2631"].items() if key not in ("bands", "label")}
            return {**at, "space": chosen["space"], "iso2631": weighted}
        case "thresholds":
            return {**sections, **{key: comfort[key] for key in ("thresholds", "jerk")}}
        case "iso2631":
            banded = {key: value for key, value in comfort["iso2631"].items() if key != "label"}
            return {**sections, "iso2631": banded}
        case "iri":
            return {**sections, "iri": comfort["iri"]}
        case "agreement":
            return {"sites": study.names, "seed": chosen["seed"], "label": comfort["iso2631"]["label"]}
        case "maps":
            place = {"geo_reference": own["road"]["geo_reference"]}
            return {**at, **comfort["maps"], "label": comfort["iso2631"]["label"], **place}
        case "tables" | "figures" | "report":
            keys = ("runs", "seed", "sampling_method", "space", "calibration")
            unread = {"tables": ("maps",), "figures": ("maps", "exposure"), "report": ()}[step]
            told = {**simulated, **_sites(study, study.names), "model": model, **{key: chosen[key] for key in keys}}
            told["comfort"] = {key: value for key, value in comfort.items() if key not in unread}
            return told | _of_page(study) if step == "report" else told
    raise KeyError(step)


def as_json(study: Study, step: str, site: str | None = None, model: str | None = None) -> str:
    """The settings of a step as the JSON that it is called with."""
    return json.dumps(of_step(study, step, site, model))


def summaries(study: Study) -> dict[str, dict]:
    """What tables and figures say of each configured site."""
    return {site: _summary(study, site) for site in study.names}


def _summary(study: Study, site: str) -> dict:
    """What tables and figures say of a site."""
    own = study.sites[site]
    return {
        "title": own["title"],
        "standin": own["standin"],
        "has_drives": bool(own["drives"]),
        "calibrated_on": study.calibrated_on(site),
        "speed": own["speed"],
        "sampling": own["sampling"],
        "vehicle": study.vehicle(site),
    }


def _of_page(study: Study) -> dict:
    """What the page says beside what tables and figures do: the loop, and what else its results were made with."""
    sites = {site: {**summary, "road": study.sites[site]["road"]["options"]} for site, summary in summaries(study).items()}
    loop = {"diagnosed": _diagnosed(study) if study.forward else {}, "scored": study.scored, **_switched_on(study)}
    return {"sites": sites, **{key: study.settings[key] for key in ("alignment", "diagnosis")}, **loop}


def _diagnosed(study: Study) -> dict[str, bool]:
    """The sites that are diagnosed, which may be others than those of the call, and whether each is a stand-in."""
    return {site: study.sites[site]["standin"] for site in study.diagnosed}


def _switched_on(study: Study) -> dict:
    """The effects of the model in their order, the sizes that are held of them, and digests of what verdicts on models with fewer of them said."""
    before = {file.parent.name: digest(file) for file in verdicts_on_less(Path("results"), study.switched_on)}
    held = {name: sizes for name, sizes in study.effects().items() if sizes}
    return {"switched_on": study.switched_on, "held": held, "told_before": before}


def _sites(study: Study, names: Iterable[str]) -> dict:
    """What tables and figures say of these sites, and the stand-ins that their vehicles are calibrated on, which may be others."""
    sites = {site: _summary(study, site) for site in names}
    found = dict.fromkeys(each["calibrated_on"] for each in sites.values())
    return {"sites": sites, "standin_calibrations": [site for site in found if site and study.sites[site]["standin"]]}


def _shown(study: Study, names: Iterable[str]) -> dict:
    """The same of measured drives."""
    told = _sites(study, names)
    keys = ("title", "standin", "has_drives", "calibrated_on")
    return {**told, "sites": {site: {key: each[key] for key in keys} for site, each in told["sites"].items()}}


def _aligned(study: Study, site: str) -> dict:
    """What the alignment of a site's drives depends on."""
    drives = [{key: value for key, value in drive.items() if key != "noise_density"} for drive in study.sites[site]["drives"]]
    return {"drives": drives, "alignment": study.settings["alignment"]}


def _mean(distribution: Mapping) -> float:
    """Mean of a configured distribution such as ``{"normal": [0, 0.2]}``."""
    ((kind, (first, second)),) = distribution.items()
    return float(first) if kind == "normal" else 0.5 * (first + second)


def _noise_densities(drives: Iterable[Mapping]) -> dict[str, dict[str, float]]:
    """Noise densities of the instruments in SI units by name of the drive, of those that have any."""
    given = {drive["name"]: drive["noise_density"] for drive in drives if "noise_density" in drive}
    return {
        name: {
            "accelerometer": 1e-6 * STANDARD_GRAVITY * each["accelerometer_ug"],
            "gyroscope": math.radians(each["gyroscope_deg_s"]),
        }
        for name, each in given.items()
    }
