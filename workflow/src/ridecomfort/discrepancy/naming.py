"""Which physical effect is missing: every effect of the library against the measured drives, and a verdict."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from .. import pool
from ..drive import pedals
from . import floor, one_signal, opening, suspect, turns
from .amended import with_remainder
from .balance import CONFIRMED, ENOUGH, is_slow, may_share, total_shares, worth_explaining
from .car import Car
from .judge import judge, standing
from .ranking import dataset
from .rung import Rung, begin
from .select import EFFECTS, search
from .selection import Selection
from .verdict import Verdict

PEDALS = "drive"
"""Port of effects that act between the driver's pedals, which no record holds, and the wheels."""


def rank(
    measured: Mapping[str, tuple],
    vehicle,
    *,
    calibration: xr.Dataset | None = None,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    effects_folder=None,
    fitted_on: Sequence[str] | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    uncertain: Mapping[str, float] | None = None,
    among: Sequence[str] | None = None,
    most: int = EFFECTS,
    seed: int = 0,
    noise_density: Mapping[str, Mapping[str, Mapping[str, float]]] | None = None,
    workers: int | None = None,
    options: Mapping | None = None,
    say: Callable[[str], None] = lambda words: None,
) -> tuple[xr.Dataset, Verdict]:
    """Rank the effects that the model may lack, and judge what the evidence carries.

    ``measured``: mapping of site to (road, aligned drives); drives of role "fit" on the sites ``fitted_on`` (by
    default the first) are fitted, all others decide (``opening.car``). ``calibration`` and
    ``effects`` are those of the model; ``uncertain``: share by which parameters that are not calibrated may be wrong
    (default ``opening.UNCERTAIN``). ``among`` narrows the library to these names. ``most``: effects to look for. ``workers``: processes, by
    default one for each core. ``noise_density``: of instruments by site and drive, the floor where no drive
    was repeated.

    Returns the Dataset of ranking.nc and a Verdict. Over ``effect``: p_value over the whole library, gain (fall of twice
    the negative log-likelihood) by the score test, absorbed (share that calibration had taken up); over ``trial``: the refits with
    their gains, shares and objections; over ``model``: the mean squares of its states; and ``smoothness`` of the road (``suspect.smoothness``). In the attributes ``road`` what speaks for another road than that of the file, if that may be all that
    repeats share, ``suspected`` whether the "data" are, by the "fit" of the model alone, or the "road" alone, and ``turns`` what comes back with the
    way or the time (``turns.line``). Raises InputError.
    """
    experiment = opening.opened(
        measured, vehicle, calibration=calibration, effects=effects, effects_folder=effects_folder, fitted_on=fitted_on,
        bounds=bounds, uncertain=uncertain, among=among, noise_density=noise_density, workers=workers, options=options,
    )  # fmt: skip
    each = pool.mapped(pool.workers() if workers is None else workers)
    rung = begin(experiment, opening.start_values(experiment), each)
    return ranked(experiment, rung, most=most, seed=seed, each=each, say=say)[:2]


def ranked(
    experiment: Car, rung: Rung, *, most: int = EFFECTS, seed: int = 0, each=map, say: Callable[[str], None] = lambda words: None
) -> tuple[xr.Dataset, Verdict, Selection]:  # fmt: skip
    """``rank`` from an ``experiment`` as its drives came and the ``rung`` of its calibrated model, with the selection behind it."""
    selection = search(rung, most=most, seed=seed, each=each, say=say)
    stands = bool(standing(selection, experiment.candidates))
    smoothness = suspect.smoothness(experiment, selection.frame, selection.states[-1].fit.residuals)
    measured = {index: selection.frame.experiment.measured(index) for index in selection.frame.indices}
    mattered, matters, left = worth_explaining(selection, measured)
    of_road = suspect.of_road(experiment, selection.frame, smoothness)
    is_explained = stands and total_shares(selection)[0] >= ENOUGH
    is_left = matters and (may_share(selection) or not selection.has_repeats)
    of_fit = suspicions_of_fit(experiment, selection, is_explained, is_left)
    of_data, of_noise = suspicions(experiment, selection), suspicions_of_road(experiment, selection)
    of_data += one_signal.of_repeats(experiment, selection.frame, selection.states[-1].fit.residuals)
    if is_left and selection.has_repeats and not is_explained:
        of_data += one_signal.of_all(experiment, rung.frame, rung.fit.residuals, [rung.raw[size.key] for size in rung.experiment.free])
    doubts = [*of_data, *of_fit, *of_noise]
    said_of_road = "; ".join(of_road)
    if smoothness > suspect.SMOOTHER and not stands and _best_share(selection) < CONFIRMED and not is_slow(selection):
        of_road, doubts = [], [*of_road, *doubts]
    verdict = judge(selection, experiment.candidates, doubts, of_road, matters, mattered, left)
    verdict = with_remainder(verdict, *_left_by(selection, measured, (-1, 0)), selection.kept)
    verdict = replace(verdict, reasons=(*verdict.reasons, *_of_foot(experiment), *experiment.set_aside))
    table = dataset(experiment, selection).assign(smoothness=((), smoothness, {"units": "1"}))
    table.attrs["road"] = "" if is_slow(selection) else said_of_road
    line = turns.left_by(selection)
    table.attrs["turns"] = "" if line is None else line.words(float(experiment.vehicle["tyre_radius"]))
    has_decoys = any(turn.decoy_ranks for turn in selection.rounds)
    table.attrs["suspected"] = "data" if of_data or has_decoys else "fit" if of_fit else "road" if doubts else ""
    return table, verdict, selection


def _of_foot(experiment: Car) -> list[str]:
    """What is said where the drivers' feet are heard: which of the library that hides."""
    said = pedals.words(again.by_foot for again in experiment.replays)
    hidden = [candidate.name for candidate in experiment.candidates if candidate.port == PEDALS]
    return [said + (f": {' and '.join(hidden)} cannot be told from it" if hidden else "")] if said else []


def _left_by(selection: Selection, measured: Mapping[int, np.ndarray], numbers: Sequence[int]) -> list[dict[str, float]]:
    """Share of the ``measured`` power of every signal that each of the models of these numbers leaves above the floor, of what is judged."""
    frame = selection.frame
    power = floor.squares(frame.experiment, measured).mean(axis=0)
    floor_power = selection.floor_squares.mean(axis=0)
    left = (np.maximum(selection.states[number].squares.mean(axis=0) - floor_power, 0.0) for number in numbers)
    shares_left = (own / np.where(power > 0, power, np.inf) for own in left)
    return [dict(zip(frame.experiment.channels, own.tolist())) for own in shares_left]


def _best_share(selection: Selection) -> float:
    """Largest share of the explainable error that any refit took on the fitted drives."""
    return max((trial.share for turn in selection.rounds for trial in turn.trials if np.isfinite(trial.share)), default=0.0)


def suspicions_of_fit(experiment: Car, selection: Selection, is_explained: bool, is_left: bool) -> list[str]:
    """Reasons to doubt the clocks and gains of drives by what the model makes of them; ``is_explained``: whether effects explain most of the error,
    ``is_left``: whether repeats share one still, or drives that were not repeated leave one."""
    # Without repeats clock and gains of what an effect does to every signal pass for those of the record.
    is_asked = selection.has_repeats or selection.floor_squares.any() and not selection.accepted
    if not is_asked or is_explained or is_left:
        return []
    return suspect.of_fit(experiment, selection.frame, selection.states[-1].fit.residuals)


def suspicions(experiment: Car, selection: Selection) -> list[str]:
    """Reasons to doubt the drives whatever the model fits: faults of any, signals, clocks that jump."""
    reasons = suspect.of_drives(experiment)
    first = selection.states[0]
    reasons += suspect.of_signals(experiment, {**first.fit.residuals, **selection.check})  # those held out decide as much
    return reasons + suspect.of_clocks(experiment, selection.frame)


def suspicions_of_road(experiment: Car, selection: Selection) -> list[str]:
    """Reasons to doubt the roads of the fitted drives: noise between their points, where that could cause the error."""
    reasons, first = [], selection.states[0]
    sites = {experiment.records[index].site: index for index in reversed(selection.frame.indices)}
    for index in sites.values():
        row = selection.frame.indices.index(index)
        explainable = np.maximum(first.squares[row] - selection.floor_squares[row], 0.0)
        deviation = suspect.road_noise(experiment.replays[index].road.road)
        share = suspect.noise_share(experiment, index, first.fit.values, deviation, explainable) if deviation > 0 else 0.0
        if share > suspect.CAUSED:
            reasons.append(
                f"the road holds noise of {1e3 * deviation:.2f} mm between its points, which alone makes "
                f"{100 * share:.0f} % of the error that could be explained"
            )
    return reasons
