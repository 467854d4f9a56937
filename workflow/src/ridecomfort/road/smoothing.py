"""Smoothing splines whose stiffness is found by cross-validation (sec:road_surf: lambda_x, lambda_y, lambda_z)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.linalg import solveh_banded

FOLDS = 5
"""Parts of the points, taken in turn, of which each is held out once."""

STEPS = 24
"""Cut-off wavelengths that are tried, from two spacings to a quarter of the length or a thousand spacings."""


@dataclass(frozen=True)
class Choice:
    """A cut-off wavelength found by cross-validation.

    ``errors`` are the rms errors against held-out points for each of
    ``wavelengths``; ``wavelength`` is that of the smallest error. ``spacing``
    is that of the points, all in one unit.
    """

    wavelength: float
    spacing: float
    wavelengths: np.ndarray
    errors: np.ndarray

    @property
    def penalty(self) -> float:
        """The paper's lambda, in the fourth power of the unit of the wavelength."""
        return penalty(self.wavelength, self.spacing)


def penalty(wavelength: float, spacing: float) -> float:
    """Weight lambda of the squared second derivative that halves waves of that length, in the fourth power of its unit.

    Of points ``spacing`` apart the second difference stands for the derivative: of a wave h it is 4 sin(pi spacing / wavelength)^2 h
    / spacing^2, which falls short of (2 pi / wavelength)^2 h where few points make up a wave. Waves shorter than two spacings, which
    the points do not hold, count as two.
    """
    return (spacing / (2 * np.sin(np.pi * min(spacing / wavelength, 0.5)))) ** 4


def smooth(values: np.ndarray, spacing: float, wavelength: float) -> np.ndarray:
    """Equidistant values (n, columns) smoothed along their first axis; waves of ``wavelength`` keep half their height.

    Minimises ``sum((f - y)^2) + lambda sum(f''^2)``: the cubic smoothing spline on
    a grid, f'' by second differences (Eilers 2003, Anal. Chem. 75, 3631). NaN counts for nothing: the spline
    is carried on over gaps and `FOLDS` values beyond the ends, further out NaN stays.
    A single value is its own spline.
    """
    known = np.isfinite(values)
    weight = penalty(wavelength, spacing) / spacing**4
    fitted = np.full(values.shape, np.nan)
    for columns in _alike(known):
        places = np.flatnonzero(known[:, columns[0]])
        if not places.size:
            continue
        span = slice(max(places[0] - FOLDS, 0), places[-1] + 1 + FOLDS)
        if places.size == 1:
            fitted[span, columns] = values[places[0], columns]
        else:
            fitted[span, columns] = _spline(values[span, columns], known[span, columns[0]], weight)
    return fitted


def cross_validate(values: np.ndarray, spacing: float, wavelengths: Sequence[float] | None = None) -> Choice:
    """The cut-off wavelength whose spline through four fifths of the points comes closest to the held-out fifth.

    ``values`` (n, columns) are equidistant; the columns share one cut-off. Valid
    for errors that are independent from point to point.
    """
    count = len(values)
    if wavelengths is None:
        wavelengths = spacing * np.geomspace(2, np.clip(count / 4, 4, 1000), STEPS)
    wavelengths = np.asarray(wavelengths, dtype=float)
    errors = np.empty(len(wavelengths))
    for k, wavelength in enumerate(wavelengths):
        squares, number = 0.0, 0
        for fold in range(FOLDS):
            held_out = np.zeros(count, dtype=bool)
            held_out[fold::FOLDS] = True
            fitted = smooth(np.where(held_out[:, None], np.nan, values), spacing, wavelength)
            miss = (fitted - values)[held_out]
            squares, number = squares + np.nansum(miss**2), number + np.isfinite(miss).sum()
        errors[k] = np.sqrt(squares / number)
    return Choice(float(wavelengths[errors.argmin()]), spacing, wavelengths, errors)


def smooth_surface(
    road: xr.Dataset, *, along: float | None = None, across: float | None = None
) -> tuple[xr.Dataset, dict[str, Choice]]:
    """The road with heights smoothed along u and then across v, and the cut-offs found where none was given.

    ``along`` and ``across`` in m; 0 leaves that direction as it is. Smoothing
    lowers roughness, and with it comfort values and IRI: judge it by both
    (`comfort.iri` on the road before and after). Cells without a height stay so.
    """
    u, v = road.u.values, road.v.values
    base = road.bank.values[:, None] * v
    heights = road.elevation.values - base
    choices: dict[str, Choice] = {}
    said = [road.attrs["treatment"]] if "treatment" in road.attrs else []
    for name, given, positions, turned in (("along", along, u, False), ("across", across, v, True)):
        values = heights.T if turned else heights
        spacing = (positions[-1] - positions[0]) / (len(positions) - 1)
        if given is None:
            choices[name] = cross_validate(values, spacing)
            given = choices[name].wavelength
        if given > 0:
            values = np.where(np.isfinite(values), smooth(values, spacing, given), np.nan)
            heights = values.T if turned else values
            origin = "found by cross-validation" if name in choices else "given"
            said.append(f"heights smoothed {name} the road, waves of {given:.3g} m to half their height ({origin})")
    smoothed = road.copy()
    smoothed["elevation"] = (("u", "v"), heights + base, road.elevation.attrs)
    smoothed.attrs["treatment"] = "\n".join(said)
    return smoothed, choices


def _alike(known: np.ndarray) -> list[np.ndarray]:
    """Columns of an array of truth values that are equal, in groups: one spline does for all of a group."""
    if not known.size:
        return []
    patterns = np.ascontiguousarray(known.T).view(f"V{len(known)}")[:, 0]
    group = np.unique(patterns, return_inverse=True)[1]
    return np.split(np.argsort(group, kind="stable"), np.cumsum(np.bincount(group))[:-1])


def _stiffness(count: int, weight: float) -> np.ndarray:
    """Upper bands (3, count) of the squared second difference times ``weight``."""
    bands = np.zeros((3, count))
    stencil = np.array([1.0, -2.0, 1.0])
    for offset in range(3):
        for k in range(3 - offset):
            bands[2 - offset, k + offset : count - 2 + k + offset] += stencil[k] * stencil[k + offset]
    return weight * bands


def _spline(values: np.ndarray, known: np.ndarray, weight: float) -> np.ndarray:
    """The smoothing spline through the known values (n, columns), of which there are two or more."""
    system = _stiffness(len(values), weight)
    system[2] += known
    return solveh_banded(system, np.where(known[:, None], values, 0.0), overwrite_ab=True, check_finite=False)
