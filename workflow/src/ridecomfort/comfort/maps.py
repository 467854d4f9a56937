"""Critical sections as GeoJSON on the reference line: what a planner or a digital map can read."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import xarray as xr

from ..errors import InputError
from . import bands

SEVERITY = {"thresholds": "style", "iso2631": "band", "iri": "quality"}
"""By method, the dimension of its classes."""

MILD = {"iso2631": ("NU",), "iri": ("VG",)}
"""Classes that are no news to a planner."""


COORDINATES = "x and y of the road file in m, not longitude and latitude: the road has no geo-reference"
"""What a map says of its coordinates where there is no projection."""


def geojson(
    comfort: xr.Dataset,
    road: xr.Dataset,
    *,
    probability: float = 0.5,
    bound: str = "exceedance_probability",
    rule: str = "middle",
    speed: xr.DataArray | None = None,
    project: Callable[[np.ndarray, np.ndarray], tuple] | None = None,
    site: str | None = None,
) -> dict:
    """A GeoJSON FeatureCollection (RFC 7946) of the sections of a comfort dataset, as plain data for ``json.dump``.

    A feature is a section and a class that is critical for the mean run, or with at
    least the ``probability`` that a planner does not accept; ``bound`` names what is held against
    it, "exceedance_lower" where a section must be critical beyond doubt. It is a
    LineString along the reference line, with its method, class (and axis), probability with
    interval, whether it is critical for the mean run, start and end in m along the road, and speed
    in m/s (``speed`` over s, or ``v_x`` of the dataset). The mildest class of a method is left out.

    A section in two overlapping bands of ISO 2631 is one feature: ``bands`` names both, ``class``
    the one that ``rule`` of ``bands.label`` gives, of those that are likely if any is. Sliding
    sections that overlap in a class are one feature, with the figures of the likeliest of them.

    ``project``: function of easting and northing in m that gives longitude and
    latitude in degrees. Without it coordinates are the road's own x and y in m,
    and the member ``coordinates_in`` says so.

    Raises InputError where the sections leave the road.
    """
    method = comfort.attrs["method"]
    if rule not in bands.RULES:
        raise InputError(f"{rule!r} is unknown; expected one of {', '.join(bands.RULES)}", place="rule")
    speed = comfort["v_x"] if speed is None and "v_x" in comfort else speed
    length, start = float(comfort.attrs["critical_length"]), comfort["window_start"].values
    u = road["u"].values
    if len(start) and (start[0] < u[0] - 1e-6 or start[-1] + length > u[-1] + 1e-6):
        raise InputError(
            f"sections from {start[0]:g} to {start[-1] + length:g} m leave the road, {u[0]:g} to {u[-1]:g} m",
            place="window_start",
        )
    features = []
    for begin, end, place, classes in _found(comfort, probability, bound, rule):
        properties = {
            "method": method,
            **classes,
            "critical": bool(comfort["critical"].values[place]),
            "probability": round(float(comfort["exceedance_probability"].values[place]), 4),
            "probability_lower": round(float(comfort["exceedance_lower"].values[place]), 4),
            "probability_upper": round(float(comfort["exceedance_upper"].values[place]), 4),
            "start_m": round(begin, 3),
            "end_m": round(end, 3),
        }
        if speed is not None:
            middle = 0.5 * (begin + end)
            properties["speed_m_per_s"] = round(float(np.interp(middle, speed["s"].values, speed.values)), 2)
        geometry = {"type": "LineString", "coordinates": _line(road, begin, end, project)}
        features.append({"type": "Feature", "geometry": geometry, "properties": properties})
    answer = {"type": "FeatureCollection", "features": features}
    if site is not None:
        answer["name"] = f"{site} {method}"
    if project is None:
        answer["coordinates_in"] = COORDINATES
    return answer


def _found(comfort: xr.Dataset, probability: float, bound: str, rule: str) -> Iterable[tuple]:
    """What is to be on the map: start and end in m, index into the variables (..., window), names of its classes."""
    severity = SEVERITY[comfort.attrs["method"]]
    *dims, _ = comfort["critical"].dims
    length, start = float(comfort.attrs["critical_length"]), comfort["window_start"].values
    likely = comfort[bound].values >= max(probability, np.finfo(float).tiny)
    news = ~comfort[severity].isin(MILD.get(comfort.attrs["method"], ()))
    shown = (comfort["critical"].astype(bool).values | likely) & news.broadcast_like(comfort["critical"]).values
    names = [comfort[dim].values.astype(str) for dim in dims]
    alike: dict[tuple, list[int]] = {}
    if "band" in dims:
        # Where the runs agree on a band, it counts, not that of their mean.
        label = _label(comfort, np.where((shown & likely).any(axis=0), shown & likely, shown), rule)
        for window in np.flatnonzero(shown.any(axis=0)):
            key = (label[window],), (("class", names[0][label[window]]), ("bands", tuple(names[0][shown[:, window]])))
            alike.setdefault(key, []).append(window)
    else:
        for *place, window in zip(*np.nonzero(shown)):
            classes = {dim: name[index] for dim, name, index in zip(dims, names, place)}
            key = tuple(place), (("class", classes.pop(severity)), *classes.items())
            alike.setdefault(key, []).append(window)
    overlap = len(start) > 1 and start[1] - start[0] < (1.0 - 1e-6) * length
    for (place, classes), found in alike.items():
        found = np.array(found)
        # Sections side by side stay apart, those that overlap become one.
        cuts = np.flatnonzero(np.diff(start[found]) > (length if overlap else 0.0)) + 1
        for group in np.split(found, cuts):
            likeliest = group[np.argmax(comfort["exceedance_probability"].values[place][group])]
            plain = {name: list(map(str, each)) if isinstance(each, tuple) else str(each) for name, each in classes}
            yield float(start[group[0]]), float(start[group[-1]] + length), (*place, likeliest), plain


def _label(comfort: xr.Dataset, shown: np.ndarray, rule: str) -> np.ndarray:
    """Index of the one band (window,) of each section among those that it is ``shown`` (band, window) for."""
    order = np.arange(len(shown))[:, None]
    if rule != "middle":
        return np.where(shown, order, -1).max(axis=0) if rule == "severe" else np.where(shown, order, len(shown)).min(axis=0)
    s, start = comfort["s"].values, comfort["window_start"].values
    limits = {
        str(name): (float(low), float(high))
        for name, low, high in zip(comfort["band"].values, comfort["band_lower"].values, comfort["band_upper"].values)
    }
    end = start + float(comfort.attrs["critical_length"])
    total = np.concatenate([[0.0], np.cumsum(comfort["a_v"].values)])
    first, behind = (np.searchsorted(s, edge - 1e-6) for edge in (start, end))
    label = bands.label((total[behind] - total[first]) / (behind - first), rule, limits)
    return np.where(shown, np.abs(order - label), len(shown)).argmin(axis=0)


def _line(road: xr.Dataset, begin: float, end: float, project) -> list[list[float]]:
    u = road["u"].values
    inside = u[(u > begin) & (u < end)]
    # One vertex a metre: a section is short and the line smooth.
    inside = inside[np.flatnonzero(np.diff(np.floor(inside - begin), prepend=0.0))]
    at = np.concatenate([[begin], inside, [end]])
    x, y = (np.interp(at, u, road[name].values) for name in ("x", "y"))
    digits = 3
    if project is not None:
        (x, y), digits = project(x, y), 8
    return [[round(float(a), digits), round(float(b), digits)] for a, b in zip(x, y)]
