"""The study as configured: read, checked against the schemas and among itself, defaults filled in."""

from __future__ import annotations

import filecmp
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from statistics import NormalDist

import yaml

from .comfort import bands, limits
from .comfort.iriedges import Edges
from .drive import readers, units
from .effects import library
from .errors import InputError, hint
from .road import checks
from .schema import as_written, read_yaml, validate
from .study import DATA, NO_CALIBRATION, VEHICLES, Study, has_fit
from .vehicle import parameters
from .vocabulary import CALIBRATED

STUDY = Path("config/study.yaml")
SITES = Path("config/sites")
STANDIN = Path("config/standin.yaml")
RESULTS = Path("results")
COMMAND_LINE = "--config"

TAKEN = frozenset(
    "all compare diagnose report blind survey road inspect measured realigned calibrate sample simulate handed_in space thresholds "
    "iso2631 iri comparison agreement maps comfort tables figures diagnosis critical ladder compared diagnosed score logs "
    "benchmarks bench recovery none located standin_score paper pooled".split()
)
"""Names of targets, of rules, of folders in results/ and of what stands beside sites in tables, which no site may have."""


def load(settings: Mapping, folder: Path | str = ".", given: Iterable[str] = ()) -> Study:
    """The study of these settings (the content of config/study.yaml) in this project folder.

    ``given`` are the keys that were set on the command line, so that a mistake in them is
    not looked for in the file. Raises InputError on the first mistake found, in the study,
    its sites or its vehicles.
    """
    given = list(given)
    try:
        return _load(settings, Path(folder), given)
    except InputError as problem:
        if str(problem).startswith(COMMAND_LINE):
            _load_own(settings, Path(folder), given, problem)
        raise


def _load_own(settings: Mapping, folder: Path, given: list[str], problem: InputError) -> None:
    """Raise the ``problem`` that seems to be one of the command line as one of the file, if it stands there as well: Snakemake merges a block
    of the command line into that of the file."""
    file = read_yaml(folder / STUDY) if (folder / STUDY).is_file() else {}
    own = {key: file[key] for key in given if key in file and key != "sites"}
    try:
        _load({**settings, **own}, folder, [key for key in given if key not in own])
    except InputError as of_file:
        if str(of_file) == str(problem).replace(COMMAND_LINE, str(STUDY), 1):
            raise of_file from None


def _load(settings: Mapping, folder: Path, given: list[str]) -> Study:
    settings = _study({**settings, **{key: _typed(settings[key]) for key in given}}, given)
    standin = _standin(folder)
    known = sorted(path.stem for path in (folder / SITES).glob("*.yaml"))
    sites: dict[str, Mapping] = {}
    waiting = [(name, _source("sites", given), "sites") for name in settings["sites"]]
    while waiting:
        name, source, place = waiting.pop(0)
        if name in sites:
            continue
        if name in TAKEN:
            raise InputError(f"{name!r} is the name of something else; call the site otherwise", file=source, place=place)
        if name not in known:
            raise InputError(f"unknown site {name!r}; known sites: {', '.join(known)}", file=source, place=place)
        sites[name] = _site(name, folder, standin)
        other = sites[name].get("calibrated_on", NO_CALIBRATION)
        if other != NO_CALIBRATION:
            waiting.append((other, SITES / f"{name}.yaml", "calibrated_on"))
    study = Study(settings, sites, standin, folder)
    _check_effects(study, given)
    _check_parameters(settings["calibration"], _source("calibration", given))
    _check_uncertain(settings["diagnosis"]["uncertain"], settings["calibration"]["parameters"], _source("diagnosis", given))
    _check_vehicles(study, given)
    _check_bounds(study, given)
    _check_width(study, given)
    _check_calibrations(study)
    _check_handed_in(study)
    _check_columns(study)
    return study


def _typed(value):
    """A value of the command line, whose inner numbers arrive as text."""
    if isinstance(value, Mapping):
        return {key: _typed(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_typed(part) for part in value]
    try:
        return yaml.safe_load(value) if isinstance(value, str) else value
    except yaml.YAMLError:
        raise InputError(f"{value!r} is not valid YAML (expected a value as in {STUDY.as_posix()}; is a bracket or a quote not closed?)", file=COMMAND_LINE) from None


def _source(key: str, given: Iterable[str]):
    return COMMAND_LINE if key in given else STUDY


def _study(settings: Mapping, given: list[str]) -> dict:
    own = {key: value for key, value in settings.items() if key not in given}
    if given:
        validate({"sites": ["any"], **{key: settings[key] for key in given}}, "study", COMMAND_LINE)
        if "sites" in given:
            own["sites"] = settings["sites"]
    validate(own, "study", STUDY)
    settings = validate(settings, "study", STUDY)
    simulation = settings["simulation"]
    per_record = 1.0 / (simulation["rate"] * simulation["step"])
    if abs(per_record - round(per_record)) > 1e-6 or per_record < 1:
        raise InputError(
            f"{simulation['rate']!r}, expected a rate that a step of {simulation['step']!r} s divides",
            file=_source("simulation", given),
            place="simulation: rate",
        )
    comfort = settings["comfort"]
    iri = comfort["iri"]
    try:
        limits.bands(comfort["thresholds"])
        limits.jerk_bands(comfort["jerk"])
        bands.edges(comfort["iso2631"]["bands"])
        Edges(iri["speed_km_h"], iri["thresholds"])
    except InputError as problem:
        raise InputError(str(problem), file=_source("comfort", given), place="comfort") from None
    return settings


def _standin(folder: Path) -> dict:
    if not (folder / STANDIN).is_file():
        return {}
    return validate(read_yaml(folder / STANDIN), "standin", STANDIN)


def _site(name: str, folder: Path, standin: Mapping) -> dict:
    file = SITES / f"{name}.yaml"
    told = read_yaml(folder / file)
    if isinstance(told.get("road"), str):
        told["road"] = {"file": told["road"]}
    site = {"title": name, **validate(told, "site", file)}
    if site["standin"] and name not in standin.get("sites", {}):
        raise InputError(
            f"{STANDIN} makes no data for {name!r}; remove `standin` from the site file if its road and drives are yours",
            file=file,
            place="standin",
        )
    if ("file" in site["road"]) == ("scan" in site["road"]):
        raise InputError("expected either a file or a scan", file=file, place="road")
    for place, needed in _files(site):
        if site["standin"]:
            if DATA / name not in Path(needed).parents:
                raise InputError(f"{needed!r}, expected a file in {DATA / name}/ for a stand-in", file=file, place=place)
        elif not (folder / needed).is_file():
            raise InputError(f"no such file {needed!r}", file=file, place=place)
    for number, drive in enumerate(site["drives"], start=1):
        _check_drive(drive, file, f"drives: entry {number}")
    names = [drive.setdefault("name", Path(drive["file"]).stem) for drive in site["drives"]]
    for twice in sorted({drive for drive in names if names.count(drive) > 1}):
        raise InputError(f"two drives are named {twice!r}", file=file, place="drives")
    for number, drive in enumerate(site["drives"], start=1):
        for entry, earlier in enumerate(site["drives"][: number - 1], start=1):
            if said := _same_record(drive, earlier, folder):
                problem = f"{drive['file']!r} {said} entry {entry} already, expected a record once, either fitted or held out"
                raise InputError(problem, file=file, place=f"drives: entry {number}: file")
    return site


def _same_record(drive: Mapping, other: Mapping, folder: Path) -> str:
    """How a drive is the record of the other, by file or as a copy of it, in words that come before the other's name; empty where it is not.

    A file may hold records of several instruments: the columns that are read tell them apart. Contents are read of files of equal size only,
    up to the first difference, which two records show in their first lines. ``drive.copies`` knows those that are not equal
    byte by byte.
    """
    if drive.get("columns") != other.get("columns"):
        return ""
    files = [folder / each["file"] for each in (drive, other)]
    if files[0].resolve() == files[1].resolve():
        return "is"
    # Those of a stand-in are made later; one that is empty is no record, which is said where it is read.
    if all(file.is_file() and file.stat().st_size for file in files) and filecmp.cmp(*files, shallow=False):
        return f"holds the same as {other['file']!r}, which is"
    return ""


def _check_drive(drive: Mapping, file, place: str) -> None:
    """Units and columns of a measured drive, each for one quantity, none missing, and the suffix of its file."""
    taken: dict[str, str] = {}
    for quantity, entry in drive.get("columns", {}).items():
        units.of_column(quantity, entry, file=file, place=f"{place}: columns: {quantity}")
        other = taken.setdefault(entry["column"], quantity)
        if other != quantity:
            raise InputError(f"column {entry['column']!r} stands for {other} already", file=file, place=f"{place}: columns: {quantity}")
    for key, quantity in (("distance_start", "s"), ("lateral_position", "e")):
        if quantity in drive.get("columns", {}) and drive.get(key):
            said = f"{drive[key]!r} beside a column for {quantity}, which says so itself, expected one of them"
            raise InputError(said, file=file, place=f"{place}: {key}")
    try:
        readers.reader_of(drive["file"])
    except InputError as problem:
        raise InputError(str(problem), file=file, place=f"{place}: file") from None
    # A NetCDF file may name its variables as the study does; columns are for the others.
    if "columns" in drive and Path(drive["file"]).suffix.lower() == ".csv" and readers.missing(drive["columns"]):
        raise InputError(readers.missing(drive["columns"]), file=file, place=f"{place}: columns")


def _files(site: Mapping) -> list[tuple[str, str]]:
    drives = [(f"drives: entry {i + 1}: file", drive["file"]) for i, drive in enumerate(site["drives"])]
    scan = site["road"].get("scan")
    road = {"road: file": site["road"].get("file")} if scan is None else {
        f"road: scan: {key}": scan[key] for key in ("profiles", "trajectory")
    }
    return [*road.items(), *drives]


def _check_effects(study: Study, given: list[str]) -> None:
    folder = study.effects_folder
    if folder is not None and not folder.is_dir():
        raise InputError(f"no such folder {str(folder)!r}", file=_source("effects_folder", given), place="effects_folder")
    if folder is not None and folder.resolve().is_relative_to((study.folder / RESULTS).resolve()):  # a diagnosis deletes the forms of the one before it
        problem = f"{str(folder)!r} is in {RESULTS}/, expected a folder of your own, into which files are copied from there"
        raise InputError(problem, file=_source("effects_folder", given), place="effects_folder")
    if folder is not None:
        library.find(folder)  # a file there that is no effect would end the diagnosis only
    named = [name for entry in study.settings["effects"] for name in ([entry] if isinstance(entry, str) else entry)]
    for twice in sorted({name for name in named if named.count(name) > 1}):
        raise InputError(f"{twice!r} stands twice, expected each effect once", file=_source("effects", given), place="effects")
    _check_profiles(study.settings["calibration"]["profiles"], folder, _source("calibration", given))
    if study.effects():
        try:
            library.check_plausible(library.choose(study.effects(), folder))
        except InputError as problem:
            raise InputError(str(problem), file=_source("effects", given), place="effects") from None


def _check_profiles(profiles: Sequence[str], folder: Path | None, source) -> None:
    """Sizes of effects whose profile is asked for are those of effects that there are, if not of every model."""
    known = library.find(folder)
    for name in profiles:
        effect, dot, size = name.partition(".")
        if not dot:
            continue
        sizes = [parameter.name for parameter in known[effect].effect.parameters] if effect in known else []
        if size not in sizes:
            what = f"effect {effect!r} has no parameter {size!r}; {hint(size, sizes, 'it has')}" if sizes else f"unknown effect {effect!r}"
            raise InputError(f"{name!r}: {what}", file=source, place="calibration: profiles")


def _check_parameters(calibration: Mapping, source) -> None:
    chosen = calibration["parameters"]
    for key, known in (("parameters", parameters.PARAMETERS), ("bounds", sorted({*chosen, *CALIBRATED}))):
        for name in calibration[key]:
            if name not in known:
                what = f"is not calibrated; expected of {', '.join(known)}" if name in parameters.PARAMETERS else _no_parameter(name)
                raise InputError(f"{name!r} {what}", file=source, place=f"calibration: {key}")
    for name, (lower, upper) in calibration["bounds"].items():
        span = parameters.PARAMETERS[name]
        if not span.lower <= lower < upper <= span.upper:
            unit = "" if span.unit == "1" else f" {span.unit}"
            what = f"{lower:g} to {upper:g}{unit}, expected an interval within {span.lower:g} to {span.upper:g}{unit}"
            raise InputError(what, file=source, place=f"calibration: bounds: {name}")
    for name in calibration["profiles"]:
        if "." not in name and name not in chosen:
            what = f"{name!r} is not calibrated; expected of {', '.join(chosen)}, or a size of an effect as effect.parameter"
            raise InputError(what, file=source, place="calibration: profiles")
    for name, value in (pair for start in calibration["start"] for pair in start.items()):
        if name not in chosen:
            what = f"{name!r} is not calibrated; expected of {', '.join(chosen)}"
            raise InputError(what, file=source, place="calibration: start")
        lower, upper = calibration["bounds"].get(name, (value, value))  # else ``_check_own_bounds``
        if not lower <= value <= upper:
            what = f"{value:g}, expected within the bounds {lower:g} to {upper:g}"
            raise InputError(what, file=source, place=f"calibration: start: {name}")


def _check_uncertain(uncertain: Mapping[str, float], calibrated: Sequence[str], source) -> None:
    fitted = {*CALIBRATED} & {*calibrated}  # others may stand among what is uncertain by default and be calibrated all the same
    for name in uncertain:
        if name not in parameters.PARAMETERS or name in fitted:
            known = ", ".join(key for key in parameters.PARAMETERS if key not in fitted)
            what = f"is calibrated; expected of {known}" if name in fitted else _no_parameter(name)
            raise InputError(f"{name!r} {what}", file=source, place="diagnosis: uncertain")


def _no_parameter(name: str) -> str:
    return f"is no parameter of a vehicle; {hint(name, parameters.PARAMETERS)}"


def _check_vehicles(study: Study, given: list[str]) -> None:
    for name, site in study.sites.items():
        file = study.folder / study.vehicle(name)
        if not file.is_file():
            known = ", ".join(sorted(path.stem for path in (study.folder / VEHICLES).glob("*.yaml")))
            source = SITES / f"{name}.yaml" if "vehicle" in site else _source("vehicle", given)
            named = site.get("vehicle", study.settings["vehicle"])
            raise InputError(f"unknown vehicle {named!r}; known vehicles: {known}", file=source, place="vehicle")
        parameters.read(file)


def _check_bounds(study: Study, given: list[str]) -> None:
    """Every vehicle that is calibrated lies within the bounds: one beyond them would be another car, for which effects would make up."""
    block = study.settings["calibration"]
    for name, site in study.sites.items():
        if not has_fit(site):
            continue
        vehicle = parameters.read(study.folder / study.vehicle(name))
        known = {key: block["bounds"][key] for key in block["parameters"] if key in block["bounds"]}
        # A value of nil, as of a tyre without damping, is one that nobody knows.
        beyond = [key for key, (lower, upper) in known.items() if vehicle[key] and not lower <= vehicle[key] <= upper]
        if beyond:
            values = ", ".join(f"{key} {vehicle[key]:g}" for key in beyond)
            wanted = ", ".join("{}: [{}, {}]".format(key, *map(as_written, vehicle.about(key))) for key in beyond)
            raise InputError(
                f"{study.vehicle(name)} has {values}, outside of these, expected bounds that hold them, such as {wanted}",
                file=_source("calibration", given),
                place="calibration: bounds",
            )
        _check_own_bounds(vehicle, study.vehicle(name), block, _source("calibration", given))


def _check_own_bounds(vehicle, file, block: Mapping, source) -> None:
    """Bounds that no one wrote, which a vehicle's own values give, are intervals and hold the starting values."""
    own = {name: vehicle.about(name) for name in block["parameters"] if name not in block["bounds"]}
    for name, (lower, upper) in own.items():
        if not lower < upper:
            span = parameters.PARAMETERS[name]
            what = (
                f"{file} has {name} {vehicle[name]:g}, half and twice which are no bounds, "
                f"expected some within {span.lower:g} to {span.upper:g}, or {name} not among parameters"
            )
            raise InputError(what, file=source, place="calibration: bounds")
    for name, value in (pair for start in block["start"] for pair in start.items()):
        lower, upper = own.get(name, (value, value))
        if not lower <= value <= upper:
            what = f"{value:g}, expected within {lower:g} to {upper:g}, half and twice the value of {file}, or bounds that hold it"
            raise InputError(what, file=source, place=f"calibration: start: {name}")


def _check_width(study: Study, given: list[str]) -> None:
    """Wheel tracks of the IRI and of the simulated drives lie on every road whose width is known before it is read."""
    for name, site in study.sites.items():
        known = _lateral_range(study, name)
        if known is None:
            continue
        right, left = known
        road = f"the road of {name}, {right:g} to {left:g} m"
        for track in study.settings["comfort"]["iri"]["wheel_tracks"]:
            if not right <= track <= left:
                problem = f"{track:g} m, expected a place on {road}"
                raise InputError(problem, file=_source("comfort", given), place="comfort: iri: wheel_tracks")
        vehicle = parameters.read(study.folder / study.vehicle(name))
        half = max(vehicle["track_front"], vehicle["track_rear"]) / 2
        drawn = _extremes(site["sampling"]["lateral_position"], study.settings["runs"])
        if "simulated" not in site and not right <= drawn[0] - half <= drawn[1] + half <= left:
            raise InputError(
                f"{study.settings['runs']} runs from {drawn[0]:.4g} to {drawn[1]:.4g} m, with wheels {half:.4g} m to either side, "
                f"expected on {road}",
                file=SITES / f"{name}.yaml",
                place="sampling: lateral_position",
            )


def _lateral_range(study: Study, name: str) -> tuple[float, float] | None:
    """Right and left end of a site's road in m as far as they are known before it is read or made, else None."""
    scan = study.scan(name)
    if scan is None and not study.sites[name]["standin"]:
        return checks.lateral_range(study.folder / study.road(name))
    width = study.standin["grid"]["width"] if scan is None else scan["width"]
    return -width / 2, width / 2


def _extremes(distribution: Mapping, runs: int) -> tuple[float, float]:
    """Between which so many draws lie but for chance: the ends, of a normal distribution the middles of its outermost parts, beyond which the
    outermost draws may still lie."""
    ((kind, (first, second)),) = distribution.items()
    reach = second * NormalDist().inv_cdf(1.0 - 0.5 / runs)
    return (first - reach, first + reach) if kind == "normal" else (first, second)


def _check_handed_in(study: Study) -> None:
    for name, site in study.sites.items():
        if "simulated" not in site:
            continue
        file, place, folder = SITES / f"{name}.yaml", "simulated", site["simulated"]
        if not (study.folder / folder).is_dir():
            raise InputError(f"no such folder {folder!r}", file=file, place=place)
        count, runs = len(study.handed_in(name)), study.settings["runs"]
        if count != runs:
            raise InputError(f"{count} drives in {folder!r}, expected one for each of the {runs} runs", file=file, place=place)


def _check_columns(study: Study) -> None:
    for name, site in study.sites.items():
        for number, drive in enumerate(() if site["standin"] else site["drives"], start=1):
            try:
                readers.check(study.folder / drive["file"], drive.get("columns"))
            except InputError as problem:
                raise InputError(str(problem), file=SITES / f"{name}.yaml", place=f"drives: entry {number}") from None


def _check_calibrations(study: Study) -> None:
    for name in study.sites:
        other = study.calibrated_on(name)
        if other is None:
            continue
        file, place = SITES / f"{name}.yaml", "calibrated_on"
        if not has_fit(study.sites[other]):
            raise InputError(f"site {other!r} has no measured drives to fit", file=file, place=place)
        if study.vehicle(other) != study.vehicle(name):
            raise InputError(f"site {other!r} has another vehicle", file=file, place=place)
        _check_circle(study, name, file, place)
        fitted = [drive for drive in study.sites[other]["drives"] if drive["role"] == "fit"]
        for number, drive in enumerate(study.sites[name]["drives"] if other != name else (), start=1):
            if said := next(filter(None, (_same_record(drive, one, study.folder) for one in fitted)), ""):
                problem = f"{drive['file']!r} {said} fitted on {other!r}, on which this site is calibrated, expected a drive that is held out here"
                raise InputError(problem, file=file, place=f"drives: entry {number}: file")


def _check_circle(study: Study, name: str, file, place: str) -> None:
    """A site is compared with what was found on the one it is calibrated on, which must not wait for it in turn."""
    passed = [name]
    while (other := study.calibrated_elsewhere(passed[-1])) is not None:
        if other in passed:
            circle = " on ".join([*passed[passed.index(other):], other])
            raise InputError(f"{circle} is a circle, expected a site that is calibrated on its own drives", file=file, place=place)
        passed.append(other)
