"""A distance that was recorded along the road: what was held until the next was known, whether it goes on as a drive does, and how fast."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.ndimage import median_filter

from ..errors import InputError
from . import sampling

JUMP, FASTER = 3.0, 0.2
"""m, and share of what the recorded speed drives, by which the distance may change otherwise from one sample to the next: the fix of a
receiver jumps by a metre or two."""

LONGEST_HOLD = 1.1
"""s for which a faster table usually holds a place until the next is known, at most: receivers tell one a second or more."""

AROUND = 9
"""Steps of a distance without a speed beside it, the median of which is what it goes on by."""


def unheld(arrays: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> tuple[dict, list[str]]:
    """Quantities, each (time in s, values), and what was done to them: a place that a faster table holds until the next is known, as that of a
    receiver, is linear between the values where it changes, which are those of their time; ``s`` goes from its first change to its last.

    Values that lie whole steps apart were rounded: where one changes it is half a step off.
    """
    result, done = dict(arrays), []
    for name in ("s", "e"):
        time, values = arrays.get(name, (np.empty(0), np.empty(0)))
        known = 1 + np.flatnonzero(np.diff(values))
        if len(known) < 3 or np.median(np.diff(known)) < 2 or (hold := np.median(np.diff(time[known]))) > LONGEST_HOLD:
            continue
        steps = (values[known] - values[0]) / np.median(np.abs(np.diff(values[known])))
        if np.allclose(steps, np.round(steps), rtol=0.0, atol=0.01):
            continue
        kept = slice(known[0], known[-1] + 1) if name == "s" else slice(None)
        result[name] = time[kept], np.interp(time[kept], time[known], values[known])
        done.append(f"{name}, held for {hold:.3g} s at a time, interpolated between its changes")
    return result, done


def speed_of(place: np.ndarray, time: np.ndarray, rate: float, within: tuple[float, float], *, file) -> tuple[np.ndarray, str]:
    """Speed (m/s, (time,)) that a distance rises by, and how it was made. Raises InputError where it is not ``within`` that of a vehicle on a road."""
    from .slow import smooth  # here: it takes a while, and the library of effects is read at every start

    speed, said = np.gradient(place, 1 / rate), "v_x differentiated from s"
    lower, upper = within
    if speed.min() < lower or speed.max() > upper:
        speed, said = np.gradient(smooth(place, rate), 1 / rate), f"{said}, low-passed"
    bad = np.flatnonzero((speed < lower) | (speed > upper))
    if bad.size:
        i = bad[0]
        raise InputError(
            f"changes by {speed[i]:.4g} m/s at {sampling.stamp(time[i])} s (expected {lower:g} to {upper:g}; are the units of s and of its time right?)",
            file=file, place="s",
        )  # fmt: skip
    return speed, said


def check_alone(time: np.ndarray, place: np.ndarray, *, file) -> None:
    """Raise InputError where a distance without a speed beside it falls, or jumps otherwise than it goes on around."""
    if place[-1] < place[0]:
        raise InputError(
            f"falls from {place[0]:.1f} to {place[-1]:.1f} m: driven against the reference line, which is not supported (expected s that rises)",
            file=file, place="s",
        )  # fmt: skip
    known = np.flatnonzero(np.concatenate([[True], np.diff(place) != 0.0]))
    if len(known) > AROUND:
        speed = median_filter(np.diff(place[known]) / np.diff(time[known]), AROUND)
        check_beside_speed(time, place, time[known], np.concatenate([speed[:1], speed]), is_recorded=False, file=file)


def check_beside_speed(time: np.ndarray, place: np.ndarray, clock: np.ndarray, speed: np.ndarray, *, is_recorded: bool = True, file) -> None:
    """Raise InputError where the distance jumps from one value to the next as no drive at the speed goes, recorded or that of the distance around.

    One that is held until the next is known, as that of a receiver in a faster table, changes at some samples only.
    """
    inside = (time >= clock[0]) & (time <= clock[-1])  # beyond, no speed is known
    if np.count_nonzero(inside) < 2:
        return
    before, time, place = int(np.argmax(inside)), time[inside], place[inside]
    driven = np.interp(time, clock, sampling.integral(speed, clock))
    known = np.flatnonzero(np.concatenate([[True], np.diff(place) != 0.0]))
    step, expected = np.diff(place[known]), np.diff(driven[known])
    if np.ptp(driven) > JUMP and (moves := expected > 0.0).any():
        expected = expected * np.median(step[moves] / expected[moves])  # v_x may be in another unit: alignment says so
    bad = np.flatnonzero(np.abs(step - expected) > JUMP + FASTER * np.abs(expected))
    if bad.size:
        i = known[bad[0] + 1]
        told, instead = ("v_x drives", ", or leave s out, which is then integrated from v_x") if is_recorded else ("it goes on by", "")
        raise InputError(
            f"sample {before + i + 1} ({sampling.stamp(time[i])} s) lies {step[bad[0]]:+.4g} m from the value before it, while {told} {expected[bad[0]]:.4g} m "
            f"(expected within {JUMP:g} m of that; cut the record there{instead})",
            file=file,
            place="s",
        )
