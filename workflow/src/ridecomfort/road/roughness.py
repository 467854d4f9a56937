"""Roughness of a road by its displacement spectrum (ISO 8608:2016)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy import signal

from ..vocabulary import describe
from . import wheeltracks

REFERENCE_WAVENUMBER = 0.1
"""cycles/m at which the class of a road is read (ISO 8608, 5.1.2)."""

FITTED = (0.011, 2.83)
"""cycles/m between which the straight line is fitted (ISO 8608, annex B)."""

CLASS_B_UPPER = 128e-6
"""m3; upper limit of class B at the reference wavenumber. The limits of the classes lie a factor 4 apart
(ISO 8608, annex C)."""

CLASSES = "ABCDEFGH"

SEGMENT = 200.0
"""m; length of the segments that spectra are averaged over. Resolves 0.005 cycles/m."""


def spectrum(profile: np.ndarray, spacing: float, *, segment: float = SEGMENT) -> tuple[np.ndarray, np.ndarray]:
    """Wavenumbers in cycles/m and one-sided displacement spectral density in m3 of profiles (..., u).

    Welch's method: half-overlapping segments of ``segment`` m (all of a shorter
    profile), Hann window, straight trend of each segment removed. Its integral
    over the wavenumber is the variance of the profile.
    """
    profile = np.asarray(profile, dtype=float)
    length = _samples(profile, spacing, segment)
    return signal.welch(profile, 1 / spacing, "hann", length, detrend="linear")


def coherence(
    left: np.ndarray, right: np.ndarray, spacing: float, *, segment: float = SEGMENT
) -> tuple[np.ndarray, np.ndarray]:
    """Wavenumbers in cycles/m and the magnitude-squared coherence (0 to 1) of two profiles (ISO 8608, annex D).

    An estimate from K independent segments has a bias of about 1/K where there is none.
    """
    length = _samples(np.asarray(left), spacing, segment)
    return signal.coherence(left, right, 1 / spacing, "hann", length, detrend="linear")


def _samples(profile: np.ndarray, spacing: float, segment: float) -> int:
    return min(profile.shape[-1], max(8, round(segment / spacing)))


def bands(lowest: float, highest: float) -> np.ndarray:
    """Limits in cycles/m (band, 2) of the bands that spectra are smoothed in (ISO 8608, table 2).

    Octaves up to the centre 2^-5, third octaves up to 2^-2, twelfth octaves above;
    only those that lie whole between ``lowest`` and ``highest``.
    """
    octaves = 2.0 ** np.arange(-12, -4)
    thirds = 2.0 ** np.arange(-5 + 2 / 3, -2 + 1e-9, 1 / 3)
    twelfths = 2.0 ** np.arange(-2 + 5 / 24, 8, 1 / 12)
    limits = np.concatenate(
        [np.stack([centres / half, centres * half], axis=1) for centres, half in
         ((octaves, 2 ** (1 / 2)), (thirds, 2 ** (1 / 6)), (twelfths, 2 ** (1 / 24)))]
    )  # fmt: skip
    return limits[(limits[:, 0] >= lowest) & (limits[:, 1] <= highest)]


def smooth(wavenumber: np.ndarray, density: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres in cycles/m of the bands and mean spectral density (..., band) in m3 within each (ISO 8608, 5.1.1).

    ``density`` (..., wavenumber) is taken as constant within half a line of each wavenumber.
    """
    step = wavenumber[1] - wavenumber[0]
    limits = bands(1.5 * step, wavenumber[-1] - step)
    edges = np.append(wavenumber - step / 2, wavenumber[-1] + step / 2)
    power = np.concatenate([np.zeros((*density.shape[:-1], 1)), np.cumsum(density * step, axis=-1)], axis=-1)
    within = np.apply_along_axis(lambda line: np.diff(np.interp(limits, edges, line)).ravel(), -1, power)
    return np.sqrt(limits.prod(axis=1)), within / np.diff(limits).ravel()


def fit(centre: np.ndarray, density: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unevenness Gd(n0) in m3 and waviness w of smoothed spectra (..., band): Gd(n) = Gd(n0) (n / n0)^-w.

    Least squares on logarithmic axes within `FITTED` (ISO 8608, annex B). Raises
    ValueError for a profile too short to know its spectrum at n0.
    """
    used = (centre >= FITTED[0]) & (centre <= FITTED[1])
    if not (used.any() and centre[used][0] <= REFERENCE_WAVENUMBER):
        raise ValueError(f"no band reaches down to {REFERENCE_WAVENUMBER} cycles/m: the profile is too short")
    logarithms = np.log(np.maximum(density[..., used], np.finfo(float).tiny))
    slope, level = np.polyfit(
        np.log(centre[used] / REFERENCE_WAVENUMBER), logarithms.reshape(-1, used.sum()).T, 1
    ).reshape(2, *density.shape[:-1])
    return np.exp(level), -slope


def road_class(unevenness: float) -> str:
    """Class A (smooth) to H of a road by its spectral density in m3 at 0.1 cycles/m (ISO 8608, annex C)."""
    steps = np.ceil(np.log(unevenness / CLASS_B_UPPER) / np.log(4)) + 1
    return CLASSES[int(np.clip(steps, 0, len(CLASSES) - 1))]


def analyse(road: xr.Dataset, *, tracks: Sequence[float] = wheeltracks.WHEEL_TRACKS, segment: float = SEGMENT) -> xr.Dataset:
    """Spectra, class and coherence of the wheel tracks of a road.

    Returns a dataset with ``displacement_psd`` (v, wavenumber), ``smoothed_psd``
    (v, band), ``unevenness`` (v), ``waviness`` (v), ``class`` (v) and ``coherence``
    (wavenumber) of the first and the last track. Raises InputError where a track
    leaves the road or runs over a hole, ValueError where the road is too short.
    """
    u = road.u.values
    spacing = (u[-1] - u[0]) / (len(u) - 1)
    profiles = wheeltracks.tracks(road, tracks)
    wavenumber, density = spectrum(profiles, spacing, segment=segment)
    centre, smoothed = smooth(wavenumber, density)
    unevenness, waviness = fit(centre, smoothed)
    _, common = coherence(profiles[0], profiles[-1], spacing, segment=segment)
    return describe(
        xr.Dataset(
            {
                "displacement_psd": (("v", "wavenumber"), density[:, 1:]),
                "smoothed_psd": (("v", "band"), smoothed),
                "unevenness": ("v", unevenness),
                "waviness": ("v", waviness),
                "class": ("v", [road_class(value) for value in unevenness]),
                "coherence": ("wavenumber", common[1:]),
            },
            coords={"v": np.asarray(tracks, dtype=float), "wavenumber": wavenumber[1:], "band": centre},
            attrs={"standard": "ISO 8608:2016", "segment": segment},
        )
    )
