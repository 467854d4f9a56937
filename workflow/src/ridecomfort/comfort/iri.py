"""International Roughness Index of a profile: segments, sliding, wheel tracks, survey."""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from .quartercar import MOVING_AVERAGE, SPEED, respond

LEAST_SHARE = 0.5
"""A last segment counts when the profile covers at least this share of it."""

WIDEST = 0.3
"""m between samples; farther apart they miss waves that the quarter-car answers to (ASTM E1926)."""

__all__ = ["coarse", "iri", "half_car", "local_roughness", "mean_of_tracks", "sliding", "survey"]


def iri(
    profile,
    spacing,
    segment: float | None = None,
    *,
    moving_average: float | None = MOVING_AVERAGE,
    speed: float = SPEED,
    state=None,
) -> np.ndarray:
    """IRI in m/km per segment, shape (..., segments), or (...) of the whole profile without ``segment``.

    ``profile``: heights in m, last axis along the road (wheel tracks before it).
    ``spacing``: metres between samples, or the ascending positions of all samples.
    ``segment``: length in m of the segments, counted from the first sample; a rest
    shorter than half a segment is left out. The quarter-car runs on from segment
    to segment. ``moving_average``: base length in m (250 mm as in the standard),
    None for a profile that is smoothed already. ``state``: the quarter-car's at
    the first sample (``Response.state``), else that of the first 11 m.

    Raises InputError for gaps, samples out of order or a profile shorter than half a segment.
    Source: sec:IRI_concept, put right (docs/method.md); Sayers (1995), TRR 1501; ASTM E1926-08.
    """
    response = respond(profile, spacing, moving_average=moving_average, speed=speed, state=state)
    first, last = response.position[0], response.position[-1]
    if segment is None:
        return response.between(first, last)
    start, stop = segments(first, last, segment)
    return response.between(start, stop)


def segments(first: float, last: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends in m of the segments of a stretch; the last one may be shorter (``LEAST_SHARE``)."""
    if not length > 0.0:
        raise InputError(f"{length!r} is not a length; expected more than 0 m", place="segment")
    count = int((last - first) / length + 1.0 - LEAST_SHARE + 1e-9)
    if count == 0:
        raise InputError(f"is more than twice as long as the profile of {last - first:g} m", place=f"segment of {length:g} m")
    start = first + length * np.arange(count)
    return start, np.minimum(start + length, last)


def mean_of_tracks(left, right, spacing, segment: float | None = None, **settings) -> np.ndarray:
    """MRI in m/km: the mean of the IRI of both wheel tracks (ASTM E1926-08, AASHTO R 43)."""
    return iri(np.stack([left, right]), spacing, segment, **settings).mean(axis=0)


def half_car(left, right, spacing, segment: float | None = None, **settings) -> np.ndarray:
    """HRI in m/km: the IRI of the mean profile of both wheel tracks; never above the MRI (Sayers 1989)."""
    return iri(0.5 * (np.asarray(left, float) + np.asarray(right, float)), spacing, segment, **settings)


def sliding(profile, spacing, at, length: float, **settings) -> np.ndarray:
    """Continuous IRI in m/km over ``length`` metres around every position ``at`` (m), shape (..., at).

    Where the profile ends within the length, over what there is of it.
    """
    response = respond(profile, spacing, **settings)
    at, first, last = np.asarray(at, float), response.position[0], response.position[-1]
    start, stop = np.maximum(at - 0.5 * length, first), np.minimum(at + 0.5 * length, last)
    outside = (at < first) | (at > last) | (stop <= start)
    return response.between(np.where(outside, np.nan, start), np.where(outside, np.nan, stop))


def survey(profile, spacing, at, resolution: float = 50.0, **settings) -> np.ndarray:
    """The measured IRI of the paper in m/km: of segments of ``resolution`` metres, linear between their middles.

    Before the first and behind the last middle the value is held (sec:ride_comfort_results).
    """
    response = respond(profile, spacing, **settings)
    start, stop = segments(response.position[0], response.position[-1], resolution)
    rough = response.between(start, stop)
    flat = rough.reshape(-1, rough.shape[-1])
    at = np.asarray(at, float)
    return np.array([np.interp(at, 0.5 * (start + stop), row) for row in flat]).reshape(rough.shape[:-1] + at.shape)


def coarse(spacing: float) -> str:
    """A sentence about the IRI of samples ``spacing`` m apart, or "" where they are no farther apart than ``WIDEST``."""
    if spacing <= WIDEST * (1 + 1e-6):
        return ""
    return f"samples up to {spacing:.4g} m apart, expected {WIDEST:g} m or less (ASTM E1926): waves between them are missed, and the IRI is too low"


def local_roughness(profile, spacing, threshold: float, length: float = 7.62, **settings) -> list[dict]:
    """Stretches whose continuous IRI over ``length`` (25 ft, AASHTO R 54) lies above ``threshold`` m/km.

    One profile (n,). Each stretch: ``start`` and ``stop`` in m, ``peak`` in m/km and where, ``place`` in m.
    """
    response = respond(profile, spacing, **settings)
    position = response.position
    half = 0.5 * length
    start, stop = np.maximum(position - half, position[0]), np.minimum(position + half, position[-1])
    rough = response.between(start, stop)
    if rough.ndim != 1:
        raise InputError("expected the profile of one wheel track", place="profile")
    above = np.concatenate([[False], rough > threshold, [False]])
    edges = np.flatnonzero(np.diff(above.astype(np.int8)))
    answer = []
    for first, behind in zip(edges[::2], edges[1::2]):
        peak = first + int(np.argmax(rough[first:behind]))
        answer.append(
            {
                "start": float(position[first]),
                "stop": float(position[behind - 1]),
                "peak": float(rough[peak]),
                "place": float(position[peak]),
            }
        )
    return answer
