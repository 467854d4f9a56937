"""A whole stand-in road: reference line, random surface and defects, as rough as the paper's road was."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

from ..vehicle.driver import speed_profile
from . import defects, geometry, level, texture

SIGNAL_SPACING = 0.5
"""m between the places at which the shares of the classes are counted."""


def generators(seed: int, site: str, *subjects: str) -> list[np.random.Generator]:
    """One independent stream of random numbers per subject; other sites and subjects leave it as it is."""
    return [
        np.random.default_rng([seed, zlib.crc32(site.encode()), zlib.crc32(subject.encode())]) for subject in subjects
    ]


def make_road(site: str, settings: Mapping, iri: Callable, edges: Callable) -> tuple[xr.Dataset, dict]:
    """The road of a stand-in site and the truth about how it was made.

    ``settings`` is ``config/standin.yaml``. The road is judged by two functions that are handed in,
    because comfort lies above this layer: ``iri(profiles, spacing, segment)`` gives the IRI in m/km of
    profiles (track, u) per segment, ``edges(speed)`` the upper edges (4, ...) in m/km of VG, G, F and M
    at speeds in m/s (``comfort.iri.iri`` and ``comfort.iriclass.Edges().at``).

    The road is a Dataset of dims u and v: ``elevation`` (u, v) in m, total height; on u ``x``, ``y``,
    ``heading``, ``curvature``, ``slope``, ``bank``. The truth is a plain dict: ``segment_iri`` in m/km,
    the ``gain`` of the random surface and its ``waviness``, each at the ``segment_middle`` in m, the
    class ``shares`` in percent, and the ``defects``. Raises InputError for targets that cannot be met.
    """
    target = settings["sites"][site]
    grid, surface = settings["grid"], settings["texture"]
    geometry_rng, level_rng, texture_rng, defect_rng = generators(
        settings["seed"], site, "geometry", "level", "texture", "defects"
    )
    line = geometry.reference_line(
        geometry_rng,
        length=target["length"],
        spacing=grid["spacing"],
        plan=target["plan"],
        profile=target["profile"],
        bank=settings["bank"],
    )
    half = round(0.5 * grid["width"] / grid["spacing"])
    v = grid["spacing"] * np.arange(-half, half + 1)
    segment = settings["level"]["segment"]

    def survey(elevation: np.ndarray) -> np.ndarray:
        return iri(wheel_tracks(elevation, v), grid["spacing"], segment).mean(axis=0)

    middle = segment * (0.5 + np.arange(int(target["length"] / segment)))
    judged = evaluation(line, settings["judged"], target["speed"], edges)
    wanted = np.array([target["classes"][name] for name in level.CLASSES]) / 100.0
    drawing = {name: value for name, value in settings["level"].items() if name != "segment"}
    levels = level.draw_levels(level_rng, middle, judged, wanted, **drawing)

    smooth = line.height[:, None] + line.bank[:, None] * v
    placed, base = level.place_defects(
        defect_rng, smooth, line.u, v, middle, levels, survey,
        per_km=target["defects_per_km"], allowance=settings["defects"]["allowance"],
    )  # fmt: skip
    random, share = random_surface(texture_rng, line.u, v, surface)
    gain = level.solve_gain(random, base, line.u, middle, levels, survey)
    elevation = base + texture.modulate(random, gain)

    found = survey(elevation)
    signal = np.interp(judged.s, middle, found)
    low, high = surface["waviness"]
    truth = {
        "site": site,
        "seed": settings["seed"],
        "segment_middle": middle.tolist(),
        "segment_iri": found.round(4).tolist(),
        "gain": np.interp(middle, line.u, gain).round(4).tolist(),
        "waviness": (low + (high - low) * np.interp(middle, line.u, share)).round(3).tolist(),
        "shares": dict(zip(level.CLASSES, (100.0 * level.shares(signal, judged)).round(3).tolist(), strict=True)),
        "defects": [defect.record() for defect in placed],
    }
    return dataset(line, v, elevation), truth


def random_surface(rng: np.random.Generator, u: np.ndarray, v: np.ndarray, surface: Mapping):
    """Random surface (u, v) in m of unit gain, and the share (u) that its wavier part has along the road.

    Two surfaces of the lowest and the highest waviness, made of the same random numbers, are mixed
    in a share that wanders with the correlation length ``waviness_length``.
    """
    low, high = surface["waviness"]
    least, most = surface["wavenumber"]
    spacing = u[1] - u[0]
    flat, wavy = texture.fields(
        rng, len(u), spacing, v, wavinesses=(low, high), wavenumber_minimum=least, wavenumber_maximum=most
    )
    share = np.clip(0.5 + 0.3 * texture.smooth_noise(rng, len(u), spacing, surface["waviness_length"]), 0.0, 1.0)
    return texture.modulate(flat, 1.0 - share) + texture.modulate(wavy, share), share


def wheel_tracks(elevation: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Heights (2, u) in m along the right and the left wheel track, linear between the columns of the grid."""
    tracks = []
    for place in (-defects.WHEEL_TRACK, defects.WHEEL_TRACK):
        column = int(np.searchsorted(v, place)) - 1
        weight = (place - v[column]) / (v[column + 1] - v[column])
        tracks.append((1.0 - weight) * elevation[:, column] + weight * elevation[:, column + 1])
    return np.stack(tracks)


def evaluation(line: geometry.ReferenceLine, judged: Mapping, speed: Mapping, edges: Callable) -> level.Evaluation:
    """Where the road is judged, and the edges of the IRI classes there at the speed that is driven.

    ``judged`` and ``speed`` are blocks of ``config/standin.yaml``, ``edges`` as in ``make_road``.
    """
    s, per_window = judged_places(line.u[-1], judged)
    driven = np.interp(s, line.u, usual_speed(line.u, line.curvature, speed))
    return level.Evaluation(s, per_window, edges(driven))


def usual_speed(u: np.ndarray, curvature: np.ndarray, speed: Mapping) -> np.ndarray:
    """Speed in m/s over u that a site is usually driven at: its profile and the deviation from it."""
    plan = xr.Dataset({"curvature": ("u", curvature)}, coords={"u": u})
    profile = speed_profile(
        plan,
        limit=speed["limit_km_h"] / 3.6,
        lateral_acceleration=speed["lateral_acceleration"],
        acceleration=speed["acceleration"],
        deceleration=speed["deceleration"],
    )
    return profile.values + speed["deviation"]


def judged_places(length: float, judged: Mapping) -> tuple[np.ndarray, int]:
    """Places in m at which a road is judged, whole windows of them, and how many lie in a window."""
    per_window = round(judged["window"] / SIGNAL_SPACING)
    windows = int((length - judged["run_in"] - judged["run_out"]) / judged["window"] + 1e-9)
    return judged["run_in"] + SIGNAL_SPACING * np.arange(windows * per_window), per_window


def dataset(line: geometry.ReferenceLine, v: np.ndarray, elevation: np.ndarray) -> xr.Dataset:
    """The road as the study knows it (dims u, v)."""
    along = {name: ("u", getattr(line, name)) for name in ("x", "y", "heading", "curvature", "slope", "bank")}
    return xr.Dataset({"elevation": (("u", "v"), elevation), **along}, coords={"u": line.u, "v": v})
