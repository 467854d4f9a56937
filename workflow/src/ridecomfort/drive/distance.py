"""A distance that was recorded along the road, and what else is told slowly: what was held until the next was known, whether it goes on as a drive
does, and how fast."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.ndimage import median_filter

from ..errors import InputError
from . import sampling

JUMP, FASTER = 3.0, 0.2
"""m, and share of what the recorded speed drives, by which the distance may change otherwise from one sample to the next: the fix of a
receiver jumps by a metre or two."""

LONGEST_HOLD, LONGEST_STAND = 1.1, 2.1
"""s for which a faster table usually holds a value until the next is known, at most: receivers tell one a second or more; and for which a distance
may stand still once while the vehicle drives on, as where one of these is lost: over it, 0.5 m/s2 bends a line of place by 0.3 m."""

AGAIN = 3
"""Usual holds of a speed or a path beyond which one was told again as it was, and none lost."""

STANDS, OFTEN = 1.0, 2.0
"""m that the vehicle drives on at least while a distance stands still, and times what it usually does: one that is rounded stands for a step."""

ROUNDED, ROUNDED_SPEED = 0.01, 0.05
"""Steps within which places that lie whole steps apart do so, and changes of a speed do: what is rounded may have been converted and rounded again."""

JITTER, DIFFERENTIATED = 1.0, "v_x differentiated from s"
"""m/s by which the slope of a distance may jitter (rms) and be a speed as it is: a centimetre of noise at 100 Hz; and what is said of this speed."""

AROUND = 9
"""Steps of a distance without a speed beside it, the median of which is what it goes on by."""


def unheld(arrays: Mapping[str, tuple[np.ndarray, np.ndarray]], *, file=None) -> tuple[dict, list[str]]:
    """Quantities, each (time in s, values), and what was done to them: a place or a speed that a faster table holds until the next is known, as that
    of a receiver, is linear between the values where it changes, which are those of their time; ``s`` and ``v_x`` go from the first of these to the last.
    A distance that stands still now and then while the vehicle drives on is linear from there to where it goes on, and cut at its ends.

    Values that lie whole steps apart were rounded: where one changes it is half a step off. Raises InputError where a distance stands, or is held,
    for too long.
    """
    result, done = dict(arrays), []
    for name in ("s", "e", "v_x"):
        time, values = arrays.get(name, (np.empty(0), np.empty(0)))
        known = 1 + np.flatnonzero(np.diff(values))
        if len(known) < 3:
            continue
        stands = _stands(time, values, known, arrays.get("v_x"), file=file) if name == "s" else []
        hold = _hold(name, time, values, known)
        if hold > LONGEST_HOLD and name == "s":
            raise InputError(
                f"is held for {hold:.3g} s at a time until the next value (expected {LONGEST_HOLD:g} s at most"
                f"{'' if 'v_x' not in arrays else '; or leave s out, which is then integrated from v_x'})",
                file=file, place="s",
            )  # fmt: skip
        if 0.0 < hold <= LONGEST_HOLD:
            rows = known if name == "s" else _told(known, len(time))
            kept = slice(None) if name == "e" else slice(rows[0], rows[-1] + 1)
            done.append(f"{name}, held for {hold:.3g} s at a time, interpolated between its changes")
        elif stands:
            rows = np.setdiff1d(np.arange(len(time)), np.concatenate([np.arange(first + (first > 0), last + 1) for first, last in stands]))
            kept = slice(rows[0], rows[-1] + 1)
            longest, begin = max(time[last] - time[first] for first, last in stands), time[stands[0][0]]
            done.append(
                "s, which stands still while the vehicle drives on, interpolated there, or cut at an end "
                f"(places: {len(stands)}, the first at {sampling.stamp(begin)} s, for up to {longest:.3g} s)"
            )
        else:
            continue
        result[name] = time[kept], np.interp(time[kept], time[rows], values[rows])
    return result, done


def _hold(name: str, time: np.ndarray, values: np.ndarray, known: np.ndarray) -> float:
    """For how many seconds values that change in the rows ``known`` are usually held in between until the next is known; nil where they are not, or
    were rounded."""
    if np.median(np.diff(known)) < 2:
        return 0.0
    changes = np.diff(values[known])
    steps = (changes if name == "v_x" else values[known] - values[0]) / np.median(np.abs(changes))
    is_rounded = np.allclose(steps, np.round(steps), rtol=0.0, atol=ROUNDED_SPEED if name == "v_x" else ROUNDED)
    return 0.0 if is_rounded else float(np.median(np.diff(time[known])))


def _told(known: np.ndarray, count: int) -> np.ndarray:
    """The rows of ``count`` at which values that change in the rows ``known`` are known: there, and where one that stays for long is told again."""
    hold, first, behind = int(np.median(np.diff(known))), np.concatenate([[0], known]), np.concatenate([known, [count]])
    stays = behind - first > AGAIN * hold
    return np.unique(np.concatenate([known, first[stays], (behind - hold)[stays]]))


def _stands(time: np.ndarray, place: np.ndarray, known: np.ndarray, speed: tuple[np.ndarray, np.ndarray] | None, *, file) -> list[tuple[int, int]]:
    """First and last rows between which a distance that changes in the rows ``known`` stands still longer than it usually does while the vehicle
    drives on, by its speed (time in s, m/s), if recorded, else as by the distance. Raises InputError where it goes on after more than LONGEST_STAND."""
    if speed is not None:
        driven = np.interp(time, speed[0], sampling.integral(speed[1], speed[0]))
    else:
        pace = np.median(np.diff(place[known]) / np.diff(time[known]))
        beyond = np.minimum(time - time[known[0]], 0.0) + np.maximum(time - time[known[-1]], 0.0)
        driven = np.interp(time, time[known], place[known]) + pace * beyond
    first, last = np.concatenate([[0], known]), np.concatenate([known, [len(time)]]) - 1
    while_standing = driven[last] - driven[first]
    far = while_standing > max(STANDS, OFTEN * np.median(while_standing))
    for i in 1 + np.flatnonzero(far[1:-1]):
        if time[last[i]] - time[first[i]] > LONGEST_STAND:
            raise InputError(
                f"stands at {place[first[i]]:.1f} m from {sampling.stamp(time[first[i]])} to {sampling.stamp(time[last[i]])} s while "
                f"{'it' if speed is None else 'v_x'} drives {while_standing[i]:.3g} m (expected {LONGEST_STAND:g} s at most; cut the record there"
                f"{'' if speed is None else ', or leave s out, which is then integrated from v_x'})",
                file=file, place="s",
            )  # fmt: skip
    return list(zip(first[far], last[far]))


def speed_of(place: np.ndarray, time: np.ndarray, rate: float, within: tuple[float, float], *, file) -> tuple[np.ndarray, str]:
    """Speed (m/s, (time,)) that a distance rises by, and how it was made. Raises InputError where it is not ``within`` that of a vehicle on a road."""
    from .slow import LEAST, smooth  # here: it takes a while, and the library of effects is read at every start

    speed, said = np.gradient(place, 1 / rate), DIFFERENTIATED
    lower, upper = within
    jitter = float(np.std(speed - np.gradient(smooth(place, rate), 1 / rate)))
    if jitter > JITTER or speed.min() < lower or speed.max() > upper:
        speed, said = np.gradient(smooth(place, rate, LEAST), 1 / rate), f"{said}, low-passed at {LEAST:g} Hz (it jitters by {jitter:.2g} m/s)"
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
