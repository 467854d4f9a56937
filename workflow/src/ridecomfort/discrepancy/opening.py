"""From measured drives on one or several sites to the Experiment of a car: which are fitted, what may be fitted, and what may be missing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from .. import calibrate, pool
from .. import simulate as simulator
from ..calibrated import apply
from ..drive import pedals
from ..drive.paced import paced
from ..drive.record import completed, require_one_rate
from ..drive.replay import Replay, replay
from ..drive.sampling import rate_of
from ..drive.steered import steered
from ..effects import library
from ..effects.contract import COMPILED
from ..errors import InputError
from ..vehicle.parameters import PARAMETERS
from ..vocabulary import SIGNALS, VARIABLES
from .candidates import candidate
from .car import Car
from .experiment import Record, Size
from .explain import HIGHEST, INSTRUMENT, SENSOR, SHORTEST, Passage, joined
from .judged import LOWEST, LOWEST_OF_DRIVER

CALIBRATION_PROBE = 0.02
"""Share of the bounds' width that a calibrated parameter is probed with."""

WHOLE = 0.9
"""Share of the longest of drives that repeat one another from which on one may stand for all: one that was ended early is asked less."""

BLOCK = 1.0
"""s at the mean speed of the fastest drive on a site; white errors farther apart are independent."""

SETTLING, UNDER_WAY = (1.5, 4.0), 6.0
"""s after the run-in that are left out too, at least and at most, and s after the beginning of the drive that suffice: at rest on level
ground a vehicle with an effect stands otherwise, and a driver who has not yet found the measured path rolls it, which imitates a
cross-wind or bump steer."""

SPARED = 0.75
"""Share of what is compared that settling leaves of a short drive."""

LEAST = 6.0
"""s that are judged at least of all fitted drives together."""

STUB = 2.0
"""s below which no drive is fitted: half a segment of the spectra, of which the shortest drive of a condition sets the length for all; of one that
ends as it has settled nothing is left."""

RUN_OUT = 0.5
"""s at the end that are left out: low-pass filters of records and of simulations end there without knowing what comes."""

UNCERTAIN = {
    "roll_inertia": 0.1,
    "pitch_inertia": 0.1,
    "yaw_inertia": 0.1,
    "cg_height": 0.1,
    "damping_front": 0.15,
    "damping_rear": 0.15,
    "anti_roll_stiffness_front": 0.15,
    "anti_roll_stiffness_rear": 0.15,
    "cornering_stiffness": 0.15,
}
"""Parameters that no calibration fits but nobody knows better than to this share: they must not pass for an effect."""


@dataclass(frozen=True)
class Site:
    """A road with the aligned drives on it, ready to be driven on."""

    name: str
    course: object
    drives: Sequence[xr.Dataset]


def car(
    sites: Sequence[Site],
    vehicle,
    *,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    effects_folder=None,
    fitted_on: Sequence[str] | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    uncertain: Mapping[str, float] | None = None,
    library_names: Sequence[str] | None = None,
    held: Mapping[str, Mapping[str, float]] | None = None,
    simulate: Callable[..., xr.Dataset] = simulator.run,
    noise_density: Mapping[str, Mapping[str, Mapping[str, float]]] | None = None,
    options: Mapping | None = None,
    each_record: Callable = map,
) -> Car:
    """The experiment of these drives. ``vehicle`` and ``effects`` are the calibrated ones.

    Drives of role "fit" on the sites ``fitted_on`` (by default the first) are fitted, all others held out: where those sites tell the floor by
    drives that repeat one another, one of such on the other sites. One of less than SHORTEST is set aside.
    ``bounds``: of the parameters that are calibrated (default ``bounds_of``). ``uncertain``: share by which further
    parameters of the vehicle may be wrong (default UNCERTAIN). ``noise_density``: of the instruments by site and drive, as for
    ``explain.explain``. ``library_names``: the effects to look
    among, by default all of the library and of the user's folder but those of the model. ``held``: sizes of ``effects`` that
    are known. ``each_record``: a ``map`` over drives.
    """
    effects = {name: dict(sizes or {}) for name, sizes in (effects or {}).items()}
    fitted_on = list(fitted_on) if fitted_on else [sites[0].name]
    if any(len(_not_repeated(site.drives)) < len(site.drives) for site in sites if site.name in fitted_on):
        sites = [site if site.name in fitted_on else replace(site, drives=_not_repeated(site.drives)) for site in sites]
    options = {"effects_folder": effects_folder, **(options or {})}

    def tuned(job: tuple[Site, xr.Dataset]) -> Replay:
        site, drive = job
        return _settled(pedals.listening(replay(drive, site.course, simulate, options=options), vehicle, effects).replay)

    require_one_rate([drive for site in sites for drive in site.drives])
    replays = each_record(tuned, [(site, drive) for site in sites for drive in site.drives])
    sites, replays, set_aside = _long_enough(sites, replays, fitted_on)
    known = library.find(effects_folder)
    _known(library_names or (), known, "among")
    _known(uncertain or (), PARAMETERS, "uncertain")
    _known((name for name in bounds or () if "." not in name), PARAMETERS, "bounds")
    chosen = [entry.effect for entry, _ in library.choose(effects, effects_folder)]
    effects |= {effect.name: effect.values(effects[effect.name]) for effect in chosen}
    free = _parameters(vehicle, bounds_of(vehicle) if bounds is None else bounds, UNCERTAIN if uncertain is None else uncertain)
    for effect in chosen:
        sizes, known_sizes = effects[effect.name], (held or {}).get(effect.name) or ()
        own = ((size, size.key.partition(".")[2]) for size in candidate(effect).sizes)
        free += [replace(size, neutral=sizes[name]) for size, name in own if name not in known_sizes]
    wanted = [name for name in sorted(known if library_names is None else library_names) if name not in effects]
    candidates = tuple(candidate(known[name].effect) for name in wanted)
    # One without a size is not driven: no value of it is known to change nothing.
    quiet = {one.name: known[one.name].effect.neutral for one in candidates if one.sizes and one.port in COMPILED}
    answers = each_record(lambda again: [answer(again, vehicle, {**quiet, **effects}) for answer in (steered, paced)], replays)
    steering, pace = map(dict, map(enumerate, zip(*answers)))
    return Car(
        _records(sites, fitted_on, replays, noise_density or {}), replays, vehicle, effects, tuple(free),
        candidates, quiet, each_record=each_record, steered=steering, paced=pace, set_aside=set_aside,
    )  # fmt: skip


def opened(
    measured: Mapping[str, tuple], vehicle, *, calibration: xr.Dataset | None = None, effects=None, bounds=None, among=None, workers=None,
    **settings,
) -> Car:  # fmt: skip
    """The experiment of ``measured`` drives, mapping of site to (road, aligned drives), beside a vehicle and its ``calibration``.

    Sizes that ``effects`` tells are held, as in calibration. What was calibrated is fitted again, within ``bounds`` or those of the
    calibration; without one, the parameters of tab:constraints and of ``bounds`` are (``bounds_of``). ``among``: names of the effects to look
    among; ``workers``: cores for drives side by side, by default all; ``settings`` as for ``car``.
    """
    held, (vehicle, effects) = effects, apply(calibration, vehicle, effects)
    count = pool.workers() if workers is None else workers
    each = pool.side_by_side(count)
    limits = _calibrated_bounds(calibration, bounds or {}, vehicle)
    return car(sites_of(measured), vehicle, effects=effects, bounds=limits, library_names=among, held=held, each_record=each, **settings)


def bounds_of(vehicle, given: Mapping[str, Sequence[float]] = {}) -> dict[str, Sequence[float]]:
    """Bounds of the parameters of tab:constraints, and of those ``given``, for a vehicle that nobody calibrated: those given, else those of the paper, or,
    where these do not hold the value of the vehicle's file, half and twice that. Raises InputError where those given do not. A value of nil, as of a
    tyre without damping, is one that nobody knows: calibrated it would begin within the bounds, and uncalibrated it is held.

    A search begins at the file's value: moved into bounds that do not hold it, it would begin with another car, for which effects would make up.
    """
    given = {name: pair for name, pair in given.items() if name not in PARAMETERS or vehicle[name]}
    for name, (lower, upper) in given.items():
        if name in PARAMETERS and not lower <= vehicle[name] <= upper:
            raise InputError(f"{lower:g} to {upper:g}, expected bounds that hold the {vehicle[name]:g} of the vehicle's file", place=f"bounds: {name}")
    own = {name: pair if pair[0] <= vehicle[name] <= pair[1] else vehicle.about(name) for name, pair in calibrate.BOUNDS.items() if name not in given}
    return {**{name: (lower, upper) for name, (lower, upper) in own.items() if lower < upper}, **given}  # none of what a vehicle has not


def _calibrated_bounds(calibration: xr.Dataset | None, given: Mapping[str, Sequence[float]], vehicle) -> dict[str, Sequence[float]]:
    """Bounds of the parameters of the vehicle that are calibrated."""
    if calibration is None:
        return bounds_of(vehicle, given)
    names = map(str, calibration["parameter"].values)
    own = {name: pair for name, *pair in zip(names, calibration["lower"].values, calibration["upper"].values)}
    return {name: given.get(name, pair) for name, pair in own.items() if "." not in name}


def _long_enough(sites: Sequence[Site], replays: Iterable[Replay], fitted_on: Collection[str]) -> tuple[list[Site], list[Replay], tuple[str, ...]]:
    """Sites with those of their drives that are judged for SHORTEST, the replays of these, and words on the others. Where all that are fitted are
    shorter, these stay but a STUB; InputError is raised where all that stay hold less than LEAST."""
    rest = iter(replays)
    found = [(site, drive, next(rest)) for site in sites for drive in site.drives]
    lasts = [float(np.ptp(again.time[again.compared])) if again.compared.any() else 0.0 for *_, again in found]
    fitted = [site.name in fitted_on and _role(drive) == "fit" for site, drive, _ in found]
    of_fitted = [seconds for seconds, is_fitted in zip(lasts, fitted) if is_fitted and seconds >= STUB]
    if any(fitted) and sum(of_fitted) < LEAST:
        raise InputError(f"fitted drives are judged for {_at_least(sum(of_fitted))} s in all (expected {LEAST:g} s at least: a longer record, or road)", place="drives")
    are_short = bool(of_fitted) and max(of_fitted) < SHORTEST
    least = [STUB if is_fitted and are_short else SHORTEST for is_fitted in fitted]
    is_kept = [seconds >= own for seconds, own in zip(lasts, least)]
    said = [
        f"{site.name} {drive.attrs['name']} is judged for {_at_least(seconds)} s only: too short to be asked (less than {own:g} s)"
        for (site, drive, _), seconds, own, kept in zip(found, lasts, least, is_kept) if not kept
    ]  # fmt: skip
    if are_short:
        said.append(f"no fitted drive is judged for {SHORTEST:g} s: how errors of signals go together is hardly known, and what is found may be chance")
    kept = [one for one, is_one in zip(found, is_kept) if is_one]
    sites = [replace(site, drives=[drive for own, drive, _ in kept if own is site]) for site in sites]
    return sites, [again for *_, again in kept], tuple(said)


def _at_least(seconds: float) -> str:
    """A time in tenths of a second, rounded down: one that is too short is not told as one that would do."""
    return f"{np.floor(10.0 * seconds + 1e-6) / 10.0:.1f}"


def _role(drive: xr.Dataset) -> str:
    return drive.attrs.get("role", "fit")


def _known(names: Iterable[str], known: Collection[str], place: str) -> None:
    """Raise InputError for the first of these names that is not known."""
    for name in names:
        if name not in known:
            raise InputError(f"unknown {name!r} (expected of {', '.join(sorted(known))})", place=place)


def _not_repeated(drives: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """One of all drives that repeat one another: the first that is WHOLE."""
    passages: list[Passage] = []
    alike: dict[int, list[xr.Dataset]] = {}
    for drive in drives:
        number = joined(passages, drive["s"].values, drive["time"].values, drive["e"].values, _sensor(drive))
        alike.setdefault(number, []).append(drive)
    length = lambda drive: float(np.ptp(drive["s"].values))
    return [next(drive for drive in own if length(drive) >= WHOLE * max(map(length, own))) for own in alike.values()]


def _sensor(drive: xr.Dataset) -> list[float]:
    """Where the instrument of a drive was, in m from the centre of gravity."""
    return [float(drive.attrs.get(name, 0.0)) for name in SENSOR]


def sites_of(measured: Mapping[str, tuple]) -> list[Site]:
    """Sites from a mapping of name to (road, measured drives): roads are prepared, stacked drives taken apart."""
    return [
        Site(
            name,
            road if isinstance(road, simulator.Course) else simulator.prepare(road),
            completed(drives),
        )
        for name, (road, drives) in measured.items()
    ]


def start_values(experiment: Car) -> dict[str, float]:
    """The values that the calibrated model has."""
    return {size.key: float(np.clip(size.neutral, size.lower, size.upper)) for size in experiment.free}


def _settled(again: Replay) -> Replay:
    """The same without its first and last instants."""
    begins, ends = again.time[again.compared][[0, -1]]
    settled = np.clip(again.time[0] + UNDER_WAY - begins, *SETTLING)
    first, last = begins + min(settled, (1 - SPARED) * (ends - begins)), ends - RUN_OUT
    return replace(again, compared=again.compared & (again.time >= first) & (again.time <= last))


def _parameters(vehicle, calibrated: Mapping[str, Sequence[float]], uncertain: Mapping[str, float]) -> list[Size]:
    """Parameters of the vehicle that are fitted, within the bounds of calibration or, others, the share by which they may be wrong."""
    free = [_parameter(name, vehicle[name], pair) for name, pair in calibrated.items() if "." not in name]
    for name, share in uncertain.items():
        if name in calibrated:
            continue
        span = PARAMETERS[name]
        lower, upper = sorted(min(max(vehicle[name] * factor, span.lower), span.upper) for factor in (1 - share, 1 + share))
        if lower < upper:  # what a vehicle has not, as a bar, is no size of it
            free.append(replace(_parameter(name, vehicle[name], (lower, upper)), held=True))
    return free


def _parameter(name: str, value: float, bounds: Sequence[float]) -> Size:
    lower, upper = map(float, bounds)
    return Size(name, PARAMETERS[name].unit, float(value), lower, upper, CALIBRATION_PROBE * (upper - lower))


def _records(sites: Sequence[Site], fitted_on: Sequence[str], replays: Sequence[Replay], noise_density: Mapping) -> list[Record]:
    """A record for every replay, in their order, that of the sites and their drives."""
    records, rest = [], iter(replays)
    for site in sites:
        passages: list[Passage] = []
        own = []
        for drive in site.drives:
            role = "fit" if site.name in fitted_on and _role(drive) == "fit" else "check"
            density = noise_density.get(site.name, {}).get(str(drive.attrs["name"]), {})
            noise = tuple(density.get(INSTRUMENT[VARIABLES[name].unit], 0.0) for name in SIGNALS) if density else ()
            own.append(replace(_record(site.name, next(rest), role, passages, len(sites) > 1), noise=noise))
        records += _side_by_side(own)
    return _as_far_as_repeats(records)


def _side_by_side(records: Sequence[Record]) -> list[Record]:
    """Records of a site with one length of block, and those of a condition with one band: that of the least."""
    longest = max((record.block for record in records), default=0.0)  # errors of the road are those of one block at any speed
    upper: dict[str, float] = {}
    for record in records:
        upper[record.condition] = min(record.band[1], upper.get(record.condition, np.inf))
    # Above it one of two repeats holds nothing, and half of the other's error would pass for noise.
    return [replace(record, block=longest, band=(record.band[0], upper[record.condition])) for record in records]


def _as_far_as_repeats(records: Sequence[Record]) -> list[Record]:
    """Records with the band of those that repeat none no wider than that of some repeats: beyond it their floor is not known."""
    counts = Counter(record.condition for record in records)
    most = max((record.band[1] for record in records if counts[record.condition] > 1), default=np.inf)
    return [record if counts[record.condition] > 1 else replace(record, band=(record.band[0], min(record.band[1], most))) for record in records]


def _record(site: str, again: Replay, role: str, passages: list[Passage], several: bool) -> Record:
    place, time = again.place[again.compared], again.time[again.compared]
    number = joined(passages, place, time, again.drive["e"].values[again.compared], _sensor(again.drive))
    speed = passages[number].speed
    rate = rate_of(time)
    band = (LOWEST, min(HIGHEST * float(again.drive.attrs["cut_off"]), 0.45 * rate))
    name = str(again.drive.attrs["name"])
    return Record(
        f"{site} {name}" if several else name, role, site, f"{site}, passage {number + 1}, at {3.6 * speed:.0f} km/h", rate, band,
        place, BLOCK * speed, tuple(LOWEST_OF_DRIVER.get(name, LOWEST) for name in SIGNALS),
    )  # fmt: skip
