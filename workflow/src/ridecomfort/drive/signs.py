"""Whether signals of an instrument have the wrong sign: axes that point to the right, backward or down, rates that turn the other way.

It is asked before clock and path are looked for: what runs against the model hides both, and agrees by chance elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from ..vocabulary import SIGNALS
from . import axes, path, record
from .place import FARTHEST, SHAKEN, as_shaken, correlations
from .replay import Replay, Simulated, replay

AGAINST = 0.5
"""Correlation below minus which a signal has the wrong sign. At the place and on the path that it was driven on, a signal with the right one has 0.75 to
1.0 (yaw rate on a road without a bend 0.35 or more), half a metre and more aside down to -0.15; one with the wrong sign has the same with a minus."""

SURE = 0.5
"""Correlation (rms over SHAKEN, whatever their signs) from which a drive is where and on the path that was tried: 0.75 to 0.98 with a nominal
vehicle, at a wrong place up to 0.3 (``align.LOWEST``)."""

TURNED = 0.8
"""Share of the agreement with signs put right that an instrument turned by some angle has at least where it is turned: it has all of it then, and
0.7 at most where one sign or more is wrong and none of these signals is weak."""

SLOW = ("a_x", "a_y")
"""Signals that a bank or a grade which the road's file has not, or a sensor at another height, turns round where they are slow: what is fast in them must
not agree with the model either."""

SIDEWAYS = {"a_y", "roll_rate", "yaw_rate"}
"""Signals that a road whose left and right are exchanged makes run against the model, in every drive."""

POINTS = {"a_x": "the x axis points backward", "a_y": "the y axis points to the right", "a_z": "the z axis points down"}
"""What an acceleration of the wrong sign tells of its instrument."""


def against(work: xr.Dataset, road, vehicle, simulate, options: Mapping) -> dict[str, float]:
    """Signals of a levelled drive (``mounting.level``) that run against the model where it was driven, with their correlations; none where that is
    not sure, nor those of an instrument that is turned in yaw.

    Looked for at all lags between the inertial signals and the place up to FARTHEST, on the path that was recorded or told, and where nothing
    agrees there, or none was, on all that the road allows.
    """
    short = path.part(work)
    right, left = path.free(short, road)
    aside = path.COARSE * np.arange(np.ceil((right - path.TIE) / path.COARSE), np.floor((left + path.TIE) / path.COARSE) + 1)
    tries = ([0.0], aside) if path.is_known(work) else (aside if aside.size else [0.0],)
    best, found = 0.0, None
    for tried in tries:
        for lateral in map(float, tried):
            again = replay(short, road, simulate, lateral_correction=lateral, options=options)
            lags, each, fast = _correlations(again, again(vehicle))
            agreement = np.sqrt(np.mean(each[[SIGNALS.index(name) for name in SHAKEN]] ** 2, axis=0))
            at = int(np.argmax(agreement))
            if agreement[at] > best:
                best, found = float(agreement[at]), (again, float(lags[at]), each[:, at], fast[:, at])
        if best >= SURE:
            break
    if best < SURE:
        return {}
    again, lag, each, fast = found
    is_against = [own < -AGAINST and (name not in SLOW or shaken < 0.0) for name, own, shaken in zip(SIGNALS, each, fast)]
    wrong = {name: float(own) for name, own, is_wrong in zip(SIGNALS, each, is_against) if is_wrong}
    horizontal = {name for pair in axes.PAIRS for name in pair}
    if horizontal & set(wrong):
        put_right, turned = axes.put_right(again, again(vehicle, clock=lag))
        if turned > TURNED * put_right:
            wrong = {name: own for name, own in wrong.items() if name not in horizontal}
    return wrong


def _correlations(again: Replay, simulated: Simulated) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lags (s) of the record behind the model, up to FARTHEST and half the record, and the correlation of every signal at each, (6, lag): of SHAKEN in
    SHAKEN_BAND, of the others of all that moves them; and of all in that band. Accelerations hold gravity where those of the record do."""
    interval, kept = again.time[1] - again.time[0], again.compared
    measured, model = again.measured()[:, kept], simulated.signals[:, kept]
    if again.drive.attrs["gravity"]:
        model[:3] = record.specific_force(model[:3], simulated.roll[kept], simulated.pitch[kept])
        measured[:3] = record.felt(again.drive)[:, kept]
    reach = min(int(round(FARTHEST / interval)), measured.shape[1] // 2)
    fast = correlations(as_shaken(measured, interval), as_shaken(model, interval), reach)
    is_shaken = np.array([name in SHAKEN for name in SIGNALS])[:, None]
    return interval * np.arange(-reach, reach + 1), np.where(is_shaken, fast, correlations(measured, model, reach)), fast


def reversed_in(drive: xr.Dataset, names: Sequence[str]) -> xr.Dataset:
    """The drive with the signals of these names reversed, and what is told of their bias with them."""
    turned = drive.assign({name: drive[name].copy(data=-drive[name].values) for name in names})
    biases = {name: -float(drive.attrs[name]) for name in (f"{one}_bias" for one in names) if name in drive.attrs}
    return turned.assign_attrs(biases)


def words(wrong: Mapping[str, float]) -> str:
    """Words on signals that run ``against`` the model, with what to change; empty where none does."""
    if not wrong:
        return ""
    how_far = ", ".join(f"{own:.2f}" for own in wrong.values())
    points = " and ".join(said for name, said in POINTS.items() if name in wrong) or "turning is counted the other way round"
    run, signs = ("run", "are their signs") if len(wrong) > 1 else ("runs", "is its sign")
    # An axis of another direction turns rates round as well.
    instead = "" if set(wrong) - set(SLOW) else ", or is the place of the sensor wrong"
    instead += "" if set(wrong) - SIDEWAYS else "; if all drives say so, are left and right of the road's file exchanged"
    return (
        f"{', '.join(wrong)} {run} against the model (correlation {how_far}): {signs} wrong, as where {points} "
        f"(if so, change the sign of `factor` under `columns`){instead}?"
    )
