"""The error ladder: how far the error falls with each effect that is added, down to the floor, and what comfort makes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from scipy.stats import wilcoxon

from ..fitrecord import AGREE
from . import critical
from .explain import REPEATS

UNCALIBRATED, CALIBRATED = "uncalibrated", "calibrated"
"""The first rungs: the nominal vehicle, and the base model with its calibration."""

FITTED, HELD_OUT = "fitted", "held out"
"""Drives that the model was fitted to, and those that nothing was fitted to."""

VISIBLE = 0.05
"""Share of the mean square error above the floor below which a signal has nothing left to explain."""

LEVEL, WORTHWHILE = 0.05, 0.005
"""p-value up to which an error is said to fall, and share of what the reference leaves below which its fall is said to be little."""

FEWEST = 5
"""Stretches from which on it can be told whether an error falls: of four, all four fall by chance in one of sixteen cases."""

RISEN = 0.01
"""By how much more of what the reference leaves a model may leave on fitted drives than the one before it until that is said."""

WORSE = 0.25
"""By how much more of what the reference leaves of a signal, and of its floor, a model may leave than the one before it, while all signals together fall,
until that is said: a quarter, several times what chance makes of a signal near its floor."""


MAY_STAND_IN = "what was {what} may stand in for something that is missing"
"""What is said of a model that makes some signal worse, where something was "fitted", or of the nominal vehicle, for which nothing was, "switched on"."""


@dataclass(frozen=True)
class Measured:
    """A site's comparisons and graded sections (``critical.critical``) by model, and whether its own drives were fitted."""

    comparisons: Mapping[str, xr.Dataset]
    sections: Mapping[str, xr.Dataset]
    fitted: bool

    def in_common(self) -> Measured:
        """The same with the stretches, and of every drive the sections, that it has of all models: aligned for each, drives end millimetres
        apart."""
        number = lambda each: np.rint(each["window_start"] / each.attrs["critical_length"]).astype(int)
        sections = _alike({model: each.assign_coords(window=number(each)) for model, each in self.sections.items()}, "window")
        grades = [each["grade"].sel(source="measured", drop=True) for each in sections.values()]
        driven = np.logical_and.reduce([(grade != critical.NOT_DRIVEN).values for grade in grades])
        sections = {
            model: each.assign(grade=each["grade"].where(grades[0].copy(data=driven), critical.NOT_DRIVEN)) for model, each in sections.items()
        }
        return replace(self, comparisons=_alike(self.comparisons, "stretch_of_road"), sections=sections)


def ladder(sites: Mapping[str, Measured], models: Sequence[str], titles: Sequence[str]) -> xr.Dataset:
    """The ladder of ``models`` (the first without effects) over sites, their later rungs called ``titles``.

    Returns over ``rung`` (uncalibrated, calibrated, then the models with effects), ``site``, ``group`` (fitted, held out) and
    ``signal``: ``nrmse`` of the whole error; of what is judged (``judged.judged``) ``rmse`` and ``floor_rmse``, the least
    that is known from any rung (mean over drives of the square, as root), and ``left``, the mean square above the floor
    over that of the reference rung (attribute ``reference``), nan where the signal had nothing above the floor;
    ``left_overall`` weighs each of these signals by what was explainable of its own error; against the rung before, it falls in a share
    ``falling`` of the stretches of road, and ``fall_p_value`` is how likely chance alone makes it fall so (Wilcoxon's signed ranks of the
    stretches: of rough ones, which hold most of the error, there are few; of less than FEWEST both are nan). Over ``method`` in place of
    signal: numbers of sections ``compared``, ``critical_simulated``, ``critical_measured``, ``agreeing`` (same grade as measured),
    ``changed`` (other grade than on the rung before) and ``changed_in_all`` (than on the reference rung); ``repeats_agreeing``, the share of
    sections that repeats grade alike.
    Nan where there is no such drive, rung or repeat. ``starts`` (rung, site): what calibration says of its starts, where a site's own
    drives were fitted.
    """
    first = next(iter(sites.values())).comparisons[models[0]]
    signals = [str(name) for name in first["signal"].values]
    rungs = [UNCALIBRATED, CALIBRATED, *titles]
    sizes = len(rungs), len(sites), 2
    squares, relative = np.full((2, *sizes, len(signals)), np.nan)
    floor_squares = np.full((len(sites), 2, len(signals)), np.nan)
    starts = np.full(sizes[:2], "", dtype=object)
    counts = {name: np.full((*sizes, len(critical.METHODS)), np.nan) for name in COUNTS}
    repeated = np.full((len(sites), 2, len(critical.METHODS)), np.nan)
    falls: dict[tuple[int, int, int], np.ndarray] = {}
    for k, site in enumerate(each.in_common() for each in sites.values()):
        for r, (model, state) in enumerate(_rungs(site, models)):
            if r and state is not None and site.fitted:
                starts[r, k] = site.comparisons[model].attrs.get("starts", "")
        for g, drives in enumerate(_groups(site, models[0])):
            if not drives.any():
                continue
            floor_squares[k, g] = _floor_squares(site, drives)
            grades, stretches = {}, None
            for r, (model, state) in enumerate(_rungs(site, models)):
                if state is None:
                    continue
                rows = site.comparisons[model].sel(state=state).isel(drive=drives)
                stretches, higher = rows["square_by_stretch"].transpose("drive", "signal", ...).values, stretches
                if higher is not None:
                    falls[r, k, g] = _mean_of_drives(higher - stretches)
                squares[r, k, g] = (rows["explainable_rmse"] ** 2 + rows["floor_rmse"] ** 2).mean("drive").values
                relative[r, k, g] = (rows["nrmse"] ** 2).mean("drive").values
                grades[r] = _count(site.sections[model].isel(drive=drives), state, grades, counts, (r, k, g))
            repeated[k, g] = _repeats(site.sections[models[0]].isel(drive=drives))
    floor_squares = np.fmin(floor_squares, np.fmin.reduce(squares, axis=0))
    reference = 1 if np.isfinite(squares[1]).any() else 0
    above = squares - floor_squares
    start = np.where(np.isfinite(above[reference]), above[reference], above[0])
    visible = start > VISIBLE * (start + floor_squares)
    share = start / (start + floor_squares)
    left = np.where(visible, above / np.where(visible, start, 1.0), np.nan)
    weight = np.where(visible, share, 0.0)
    total = weight.sum(axis=-1)
    overall = np.sum(np.where(visible, weight * left, 0.0), axis=-1) / np.where(total > 0, total, np.nan)
    over = ("rung", "site", "group")
    falling, chance = np.full((2, *sizes), np.nan)
    per_square = weight / np.where(visible, start, 1.0)
    for at, fall in falls.items():
        of_all = per_square[at[1:]] @ fall
        if total[at[1:]] > 0 and of_all.size >= FEWEST:
            falling[at] = np.mean(of_all > 0)
            chance[at] = wilcoxon(of_all, alternative="greater").pvalue if of_all.any() else 1.0
    return xr.Dataset(
        {
            "rmse": ((*over, "signal"), np.sqrt(squares)),
            "nrmse": ((*over, "signal"), np.sqrt(relative)),
            "floor_rmse": (("site", "group", "signal"), np.sqrt(floor_squares)),
            "left": ((*over, "signal"), left),
            "left_overall": (over, overall),
            "falling": (over, falling),
            "fall_p_value": (over, chance),
            **{name: ((*over, "method"), values) for name, values in counts.items()},
            "repeats_agreeing": (("site", "group", "method"), repeated),
            "starts": (("rung", "site"), starts.astype(str)),
            "floor_known": ("site", np.array([_floor_known(site, models) for site in sites.values()])),
        },
        {
            "rung": rungs,
            "site": list(sites),
            "group": [FITTED, HELD_OUT],
            "signal": signals,
            "method": list(critical.METHODS),
        },
        {"reference": rungs[reference], "models": " ".join(models)},
    )


def helps(fall: float, p_value: float) -> str:
    """Whether a model helps against the one before it, in a word: ``fall`` of ``left_overall``, and how likely chance makes it fall so."""
    if not np.isfinite(p_value):
        return ""
    if p_value > LEVEL or fall <= 0.0:
        return "no"
    return "yes" if fall >= WORTHWHILE else "little"


def risen(found: xr.Dataset) -> list[tuple[str, str]]:
    """Site and words for every model of a ladder that leaves more on the fitted drives than the one before it."""
    said = []
    for site in found["site"].values:
        left = 100 * found["left_overall"].sel(site=site, group=FITTED).values
        for rung, before, now in zip(found["rung"].values[2:], left[1:], left[2:]):
            if now > before + 100 * RISEN:
                said.append((str(site), f"{rung} leaves {now:.0f} % on the fitted drives, more than the {before:.0f} % without it"))
    return said


def worsened(found: xr.Dataset) -> list[tuple[str, str]]:
    """Site and words for every model of a ladder with which all signals together fall but some rise by more than WORSE, or with which one rises
    that had nothing above the floor, of which no share tells; on drives held out where there are any."""
    said = []
    for site in found["site"].values:
        groups = [group for group in (HELD_OUT, FITTED) if found["rmse"].sel(site=site, group=group).notnull().any()]
        chosen = found.sel(site=site, group=groups[0])
        known = chosen["rung"].values[chosen["rmse"].notnull().any("signal").values]  # the nominal vehicle has no rung "calibrated"
        may_stand_in = MAY_STAND_IN.format(what="fitted" if CALIBRATED in known else "switched on")
        for before, now in zip(known, known[1:]):
            square = chosen["rmse"].sel(rung=now).values ** 2 - chosen["rmse"].sel(rung=before).values ** 2
            is_much = square > WORSE * np.nan_to_num(chosen["floor_rmse"].values) ** 2
            lower, higher = (chosen["left"].sel(rung=rung).values for rung in (before, now))
            rises = np.flatnonzero((higher > lower + WORSE) & is_much)
            if rises.size and chosen["left_overall"].sel(rung=now) < chosen["left_overall"].sel(rung=before):
                signals = (f"{chosen['signal'].values[k]} ({100 * higher[k]:.0f} % left after {100 * lower[k]:.0f} %)" for k in rises)
                told = f"{now}: on drives {groups[0]} the error grows in {', '.join(signals)}, though it falls over all signals"
                said.append((str(site), f"{told}: {may_stand_in}"))
            lower, higher = (chosen["rmse"].sel(rung=rung).values for rung in (before, now))
            rises = np.flatnonzero(np.isnan(chosen["left"].sel(rung=now).values) & (higher**2 > (1.0 + WORSE) * lower**2))
            if rises.size:
                signals = (f"{chosen['signal'].values[k]} ({higher[k] / lower[k]:.2g} times as large)" for k in rises)
                told = f"{now}: on drives {groups[0]} the error grows in {', '.join(signals)}, of which nothing was left above the floor"
                said.append((str(site), f"{told}: {may_stand_in}"))
    return said


def disagreeing(found: xr.Dataset) -> list[tuple[str, str]]:
    """Site and words for every model of a ladder whose calibration has something to say of its starts."""
    said = found["starts"].stack(model=("site", "rung"))
    texts = zip(said["model"].values, said.values.tolist())
    return [(site, f"{rung}: {words}") for (site, rung), words in texts if words not in ("", AGREE)]


COUNTS = ("compared", "critical_simulated", "critical_measured", "agreeing", "changed", "changed_in_all")


def _alike(datasets: Mapping[str, xr.Dataset], dimension: str) -> dict[str, xr.Dataset]:
    """The datasets where they have the same places along a dimension."""
    others = {name for each in datasets.values() for name in each.dims} - {dimension}
    return dict(zip(datasets, xr.align(*datasets.values(), join="inner", exclude=others)))


def _rungs(site: Measured, models: Sequence[str]) -> list[tuple[str, str | None]]:
    """Model and state of every rung; no state where the site has no such rung."""
    states = {model: [str(state) for state in site.comparisons[model]["state"].values] for model in models}
    base = states[models[0]]
    later = [(model, states[model][-1] if len(states[model]) > 1 else None) for model in models[1:]]
    return [(models[0], base[0]), (models[0], base[1] if len(base) > 1 else None), *later]


def _groups(site: Measured, model: str) -> tuple[np.ndarray, np.ndarray]:
    """Which drives were fitted, and which were not, (drive,)."""
    fitted = (site.comparisons[model]["role"].values == "fit") & site.fitted
    return fitted, ~fitted


def _mean_of_drives(values: np.ndarray) -> np.ndarray:
    """Mean over drives (drive, signal, stretch) of the stretches that any of them has: repeats meet the same road, so that they tell no more of it
    than one."""
    known = np.isfinite(values).all(axis=1)
    counted = known.any(axis=0)
    return np.where(known[:, None], values, 0.0).sum(axis=0)[:, counted] / known.sum(axis=0)[counted]


def _floor_squares(site: Measured, drives: np.ndarray) -> np.ndarray:
    """Mean square (signal,) of the floor: the least that any model shows, of those that know it from repeats if any do: paths are aligned for each model,
    and what are repeats by a hair beside one are none beside another."""
    known = [each for each in site.comparisons.values() if each.attrs["floor"] == REPEATS] or list(site.comparisons.values())
    floors = [(each["floor_rmse"].isel(drive=drives) ** 2).mean("drive").values for each in known]
    return np.fmin.reduce(floors, axis=0)


def _floor_known(site: Measured, models: Sequence[str]) -> str:
    """What the floor of a site is known from: repeats, if any of the models has these, else as of the first."""
    said = [str(site.comparisons[model].attrs["floor"]) for model in models]
    return REPEATS if REPEATS in said else said[0]


def _count(sections: xr.Dataset, state: str, grades: Mapping[int, np.ndarray], counts, at) -> np.ndarray:
    """Count the sections of a state into ``counts`` at this rung, and return their grades (method, drive, window); ``grades``: those of the rungs
    before, of which the calibrated one is the reference, or else the first."""
    measured = sections["grade"].sel(source="measured").transpose("method", "drive", "window").values
    grade = sections["grade"].sel(source=state).transpose("method", "drive", "window").values
    there = measured != critical.NOT_DRIVEN
    total = lambda what: (what & there).sum(axis=(1, 2))
    counts["compared"][at] = there.sum(axis=(1, 2))
    counts["critical_simulated"][at] = total(grade > 0)
    counts["critical_measured"][at] = total(measured > 0)
    counts["agreeing"][at] = total(grade == measured)
    if grades:
        counts["changed"][at] = total(grade != grades[max(grades)])
        counts["changed_in_all"][at] = total(grade != grades.get(1, grades[0])) if at[0] > 1 else np.nan
    return grade


def _repeats(sections: xr.Dataset) -> np.ndarray:
    """Share (method,) of the sections that two repeats grade alike, mean over all pairs; nan without repeats."""
    grade = sections["grade"].sel(source="measured").transpose("method", "drive", "window").values
    groups = sections["repeat_group"].values
    alike, both = np.zeros((2, grade.shape[0]))
    for i in range(len(groups)):
        for j in range(i):
            if groups[i] == groups[j]:
                there = (grade[:, i] != critical.NOT_DRIVEN) & (grade[:, j] != critical.NOT_DRIVEN)
                alike += ((grade[:, i] == grade[:, j]) & there).sum(axis=1)
                both += there.sum(axis=1)
    return np.where(both > 0, alike / np.maximum(both, 1), np.nan)
