"""Roads from and to OpenCRG files, by ASAM's library as the package pycrg binds it."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pycrg
import xarray as xr

from ..errors import InputError
from ..store import replacing
from ..vocabulary import describe
from . import checks, edges
from .surface import BORDER_MODES

log = logging.getLogger(__name__)

CHOICES = {
    "modifiers": ("standard", "explicit", "ignore"),
    "interpolation": ("linear", "cubic"),
    "holes": ("refuse", "keep"),
    "heights": ("refuse", "blank"),
    "lateral_grid": ("exact", "resample"),
    "long_sections": ("refuse", "sort"),
    "folds": ("refuse", "keep"),
}
"""The options of `read`; the first value of each is its default."""

FORMATS = ("KRBI", "KDBI", "LRFI", "LDFI")

HEIGHT_STEP = 1e-4
"""m that written heights are rounded to: the accuracy of the paper's scanner (sec:road_surf)."""

_CHANNEL_STEP = 1e-7
"""What slope and bank are rounded to on writing; nine characters hold it."""

_CURVATURE_LENGTH = 0.5
"""m to either side over which OpenCRG takes the curvature of the reference line."""

_MOST_COLUMNS = 1024
"""Of an equidistant lateral grid that passes through every long section, where these are not equidistant themselves."""


def read(path, **options: str) -> xr.Dataset:
    """The road of an OpenCRG file, with every choice made on the way in its attribute ``treatment``.

    Returns a dataset with ``elevation`` (u, v), total heights in m with slope and
    bank included, NaN outside the edges of the road; and along ``u`` the
    reference line: ``x`` and ``y`` in m, ``heading`` in rad (unwrapped; that of
    the segment beginning there, as crgEvaluv2pk gives it), ``curvature`` in 1/m,
    ``slope`` and ``bank``. ``u`` and ``v`` are equidistant. Attributes say how the
    file asks to be evaluated (see `surface.height`).

    Options name a choice (`CHOICES`); the first of each is the default.

    modifiers
        ``standard`` applies those of the file or, where it has no such block,
        those of OpenCRG (start of the reference line to the origin, last height
        kept beyond the edges); ``explicit`` only what the file states; ``ignore``
        none.
    interpolation
        ``linear``, as OpenCRG defines the surface, or ``cubic`` (sec:road_surf), which
        the study uses unless the site says otherwise (`surface.INTERPOLATION`).
    holes
        cells without a height inside the road: ``refuse``, or ``keep`` them for
        `clean.fill` and cut off the ends that have none at all.
    heights
        out of reason (`checks.unreasonable`): ``refuse``, or ``blank`` them.
    lateral_grid
        ``exact``: an equidistant grid that passes through every long section, or
        refuse; ``resample``: an equidistant grid of about the smallest spacing.
    long_sections
        that do not stand from right to left: ``refuse``, or ``sort``.
    folds
        a bend narrower than the road: ``refuse``, or ``keep``.

    Raises InputError, one line, for a file that is missing, cut off, contradicts
    itself or needs a choice that was not made.
    """
    path = Path(path)
    chosen = _choose(options)
    headers = checks.headers(path)
    checks.numbers(headers)
    head = headers[-1]
    checks.extent(head)
    checks.units(head)
    stated = any(found.modifiers is not None for found in headers)
    names = " by way of ".join(Path(found.path).name for found in headers[::-1])
    treatment = [f"read from {names} ({head.data_format})"]
    if strange := checks.strange(head):
        treatment.append(f"channels that are none of OpenCRG's, left out: {', '.join(map(repr, strange))}")
    if chosen["long_sections"] == "refuse":
        checks.order(head)
    elif (at := checks.positions(head)) != sorted(at):
        treatment.append("long sections sorted from right to left")
    try:
        with _warnings() as warnings, pycrg.DataSet.open(path, apply_modifiers=False) as data:
            checks.understood(head, warnings)
            stored = data.grid()
            checks.payload(head, len(stored.u))
            checks.size(head, stored.u, stored.v)
            wild = _wild(path, stored, chosen["heights"], treatment)
            checks.reference_line(stored, path)
            checks.ends(head, stored)
            _apply(data, stated, chosen["modifiers"], treatment)
            grid = data.grid()
            attributes = _evaluation(data, treatment)
            if checks.positions(head):
                # The library folds v for the heights of sections named by their position, but not for their bank.
                attributes["border_bank"] = "held"
                if not {"long_section_v_right", "long_section_v_left"} <= head.road.keys():
                    treatment.append("borders at the outermost long sections: the header, where ASAM's library looks, has none")
    except (pycrg.OpenCRGError, OSError) as problem:
        raise InputError(str(problem).replace("\n", " "), file=path) from None
    if warnings:
        treatment.append(f"ASAM's library warns: {'; '.join(warnings)}")
    measured = np.isfinite(stored.z) & ~wild
    if not (np.abs(np.where(measured, grid.elevation, 0.0)) <= checks.HEIGHT_LIMIT).all():
        problem = "take heights out of reason: does their reference point lie on the road? (or modifiers: ignore)"
        raise InputError(problem, file=path, place="modifiers")
    elevation = _edges(path, grid, measured, wild, chosen["holes"], attributes, treatment)
    _folds(path, grid, elevation, chosen["folds"], treatment)
    v, elevation = _equidistant(path, grid, elevation, chosen["lateral_grid"], treatment)
    part = _extent(path, grid, measured, attributes, treatment)
    for line in treatment:
        log.info(line)
    attributes.update(interpolation=chosen["interpolation"], treatment="\n".join(treatment))
    slope, bank = (np.where(np.isnan(values), np.roll(values, -1), values) for values in (grid.slope, grid.bank))
    return describe(
        xr.Dataset(
            {
                "elevation": (("u", "v"), elevation),
                "x": ("u", grid.x),
                "y": ("u", grid.y),
                "heading": ("u", np.unwrap(np.append(grid.phi[1:], grid.phi[-1]))),
                "curvature": ("u", curvature(grid.x, grid.y, grid.u[1] - grid.u[0])),
                "slope": ("u", slope),
                "bank": ("u", bank),
            },
            coords={"u": grid.u, "v": v},
            attrs=attributes,
        ).isel(u=part)
    )


def curvature(x: np.ndarray, y: np.ndarray, du: float) -> np.ndarray:
    """Curvature in 1/m of a line through points ``du`` apart, by crossing the chords of 0.5 m to either side.

    The formula of OpenCRG (crgEvaluv2pk), which however gives zero within 0.5 m of
    the ends, where the nearest value is held here. Lines too short for it are
    taken as straight.
    """
    n = max(1, int(_CURVATURE_LENGTH / du * (1 + 1e-9)))
    bent = np.zeros(len(x))
    if len(x) > 2 * n:
        dx, dy = x[n:] - x[:-n], y[n:] - y[:-n]
        bent[n:-n] = (dx[:-n] * dy[n:] - dy[:-n] * dx[n:]) / (n * du) ** 3
        bent[:n], bent[-n:] = bent[n], bent[-n - 1]
    return bent


def write(path, road: xr.Dataset, *, format: str = "KRBI", comment: str = "") -> None:
    """Write a road as an OpenCRG file that stays where it is: its modifier block moves nothing.

    Heights are rounded to 0.1 mm (`HEIGHT_STEP`) against a reference line that
    carries slope and bank, so that long climbs cost no precision. The heading
    channel leads through ``x`` and ``y``, which must be du apart along the
    line. What the attributes say of borders and edges becomes options and
    modifiers (``border_bank`` has none). NaN is allowed outside the edges of the road only. Nothing is left
    behind when writing fails. Raises InputError where the format cannot hold the
    road.
    """
    u, v = road.u.values, road.v.values
    du = (u[-1] - u[0]) / (len(u) - 1)
    slope, bank = (np.round(road[name].values / _CHANNEL_STEP) * _CHANNEL_STEP for name in ("slope", "bank"))
    climb = np.concatenate([[0.0], np.cumsum(du * slope[1:])])
    relative = road.elevation.transpose("u", "v").values - climb[:, None] - bank[:, None] * v
    start = road.attrs.get("reference_height_start", float(np.round(np.nanmean(relative), 3)))
    relative = np.round((relative - start) / HEIGHT_STEP) * HEIGHT_STEP
    x, y = road.x.values, road.y.values
    chord = np.hypot(np.diff(x), np.diff(y))
    if np.abs(chord / du - 1).max() > 1e-2:
        worst = int(np.abs(chord - du).argmax())
        raise InputError(
            f"points {chord[worst]:.4g} m apart at u = {u[worst]:g} m, expected {du:g} m", file=path, place="x, y"
        )
    phi = np.unwrap(np.arctan2(np.diff(y), np.diff(x)))
    straight = np.ptp(phi) < 1e-12
    try:
        with replacing(path) as part:
            pycrg.write(
                part, relative, du, v, float(phi[0]) if straight else phi, u0=float(u[0]), x0=float(x[0]),
                y0=float(y[0]), z0=start, slope=slope, banking=bank, fmt=format, comment=comment,
                mods={"grid_nan_mode": pycrg.GRID_NAN_KEEP_LAST} if road.attrs.get("edges", "keep") == "keep" else {},
                opts=_options(road.attrs),
            )  # fmt: skip
    except ValueError as problem:
        raise InputError(str(problem).replace("\n", " "), file=path) from None


@contextmanager
def _warnings() -> Iterator[list[str]]:
    """The warnings of the library while the block runs, which otherwise would go to the log one by one."""
    found: list[str] = []

    def keep(level: int, text: str) -> None:
        if level <= pycrg.MSG_LEVEL_WARN:
            found.append(" ".join(text.split()))

    pycrg.set_message_callback(keep)
    try:
        yield found
    finally:
        pycrg.clear_message_callback()


def _choose(options: dict) -> dict:
    for name, value in options.items():
        if name not in CHOICES:
            raise InputError(f"unknown option, expected one of {', '.join(CHOICES)}", place=f"road.{name}")
        if value not in CHOICES[name]:
            raise InputError(f"{value!r}, expected one of {', '.join(CHOICES[name])}", place=f"road.{name}")
    return {name: options.get(name, values[0]) for name, values in CHOICES.items()}


def _wild(path, stored: pycrg.CrgGrid, choice: str, treatment: list[str]) -> np.ndarray:
    """True for cells (u, v) whose height in the file is out of reason, where these are to be blanked."""
    wild = checks.unreasonable(stored.elevation, stored.u)
    if wild.any():
        i, j = np.argwhere(wild)[0]
        found = f"{wild.sum()} heights out of reason, the first {stored.elevation[i, j]:.4g} m"
        if choice == "refuse":
            raise InputError(
                f"{found}, expected within {checks.HEIGHT_LIMIT:g} m and {checks.STEP_LIMIT:g} m of the median height of"
                " its cross section, and of those beside it (or heights: blank)",
                file=path,
                place=f"u = {stored.u[i]:g} m, v = {stored.v[j]:g} m",
            )
        treatment.append(f"{found} at u = {stored.u[i]:g} m, v = {stored.v[j]:g} m: blanked")
    return wild


def _apply(data: pycrg.DataSet, stated: bool, choice: str, treatment: list[str]) -> None:
    """Apply the modifiers of a file, or those of OpenCRG where it states none."""
    if choice == "ignore" or (choice == "explicit" and not stated):
        data.modifier_remove_all()
        treatment.append("modifiers not applied: heights and reference line as stored")
        return
    values = {}
    for keyword, number in pycrg.writer.MODIFIER_KEYWORDS.items():
        get = data.modifier_get_int if keyword == "grid_nan_mode" else data.modifier_get_double
        if (value := get(number)) is not None:
            values[keyword] = value
    data.modifiers_apply()
    listed = ", ".join(f"{keyword} {value:g}" for keyword, value in values.items())
    if not stated:
        treatment.append(
            "no modifier block in the file: by OpenCRG's defaults the start of the reference line was moved to the"
            f" origin with heading 0, and heights are kept beyond the edges of the road ({listed})"
        )
    elif values:
        treatment.append(f"modifiers of the file applied: {listed}")
    else:
        treatment.append("modifier block of the file is empty: heights and reference line as stored")


def _evaluation(data: pycrg.DataSet, treatment: list[str]) -> dict:
    """How the file asks to be evaluated beyond its borders, as attributes."""
    with data.create_contact_point() as point:

        def option(name, default):
            number, get = getattr(pycrg, f"CP_OPTION_{name}"), point.option_get_double
            value = (point.option_get_int if isinstance(default, int) else get)(number)
            return default if value is None else value

        wanted = {
            "border_mode_u": BORDER_MODES[option("BORDER_MODE_U", 0)],
            "border_mode_v": BORDER_MODES[option("BORDER_MODE_V", 2)],
            "border_offset_u": option("BORDER_OFFSET_U", 0.0),
            "border_offset_v": option("BORDER_OFFSET_V", 0.0),
        }
        smooth_start, smooth_end = option("SMOOTH_U_BEGIN", 0.0), option("SMOOTH_U_END", 0.0)
        closes = option("REF_LINE_CONTINUE", 0) == pycrg.REF_LINE_CLOSE_TRACK
    treatment.append(
        "beyond the borders of the grid: {border_mode_u} along u (offset {border_offset_u:g} m),"
        " {border_mode_v} along v (offset {border_offset_v:g} m)".format(**wanted)
    )
    ends = data.grid().ref_z[[0, -1]]
    wanted.update(reference_height_start=float(ends[0]), reference_height_end=float(ends[1]))
    if smooth_start or smooth_end:
        wanted.update(smooth_start=smooth_start, smooth_end=smooth_end)
        treatment.append(f"smoothed over the first {smooth_start:g} m and the last {smooth_end:g} m")
    _, closed, first, last = data.closed_track_data()
    if closes and closed:
        wanted.update(closed_from=first, closed_to=last)
        treatment.append(f"closed track: u repeats from {first:g} to {last:g} m")
    return wanted


def _options(attrs) -> dict[str, float] | None:
    """The option block of a file whose road is to be evaluated as the attributes say."""
    options: dict[str, float] = {}
    for axis in "uv":
        if f"border_mode_{axis}" in attrs:
            options[f"border_mode_{axis}"] = BORDER_MODES.index(attrs[f"border_mode_{axis}"])
            options[f"border_offset_{axis}"] = attrs.get(f"border_offset_{axis}", 0.0)
    for name, keyword in (("smooth_start", "border_smooth_ubeg"), ("smooth_end", "border_smooth_uend")):
        if attrs.get(name):
            options[keyword] = attrs[name]
    if "closed_from" in attrs:
        options["refline_continuation"] = pycrg.REF_LINE_CLOSE_TRACK
    return options or None


def _edges(path, grid, measured, wild, choice, attributes, treatment) -> np.ndarray:
    """Heights (u, v) without those that the library put into holes and beyond the edges."""
    known = np.where(measured, 1.0, np.nan)
    beyond, hole = edges.outside(known), edges.holes(known)
    empty = beyond.all(axis=1)
    if choice == "refuse" and (empty.any() or hole.any()):
        i, j = np.argwhere(hole | empty[:, None])[0]
        raise InputError(
            f"no height inside the road ({hole.sum()} such cells, {empty.sum()} empty cross sections;"
            " or holes: fill, which closes those up to 1 m long)",
            file=path,
            place=f"u = {grid.u[i]:g} m, v = {grid.v[j]:g} m",
        )
    elevation = np.array(grid.elevation)
    # Beyond a blanked edge the library holds the height that was blanked.
    spoilt = beyond & wild.any(axis=1)[:, None]
    elevation[hole | spoilt] = np.nan
    unset = beyond & ~spoilt & ~np.isfinite(elevation)
    attributes["edges"] = "none" if unset.any() else "keep"
    if hole.any():
        treatment.append(f"{hole.sum()} cells of holes inside the road kept")
    if not beyond.any():
        return elevation
    share = f"{beyond.mean():.2%} of the grid lies outside the edges of the road"
    set_by_file = beyond & ~spoilt & ~unset
    if set_by_file.any():
        relative = elevation - grid.ref_z[:, None] - grid.bank[:, None] * grid.v
        held = edges.extend(np.where(measured, relative, np.nan), grid.v, np.zeros(len(grid.u)))
        if not np.allclose(relative[set_by_file], held[set_by_file], rtol=0, atol=1e-7):
            treatment.append(f"{share}: heights there as the file's grid_nan_mode asks")
            return elevation
    elevation[beyond] = np.nan
    treatment.append(f"{share}: no heights there")
    return elevation


def _extent(path, grid, measured, attributes, treatment) -> slice:
    """The cross sections from the first to the last one with a height; the road ends there."""
    known = np.flatnonzero(measured.any(axis=1))
    if not known.size or (known[0] == 0 and known[-1] == len(grid.u) - 1):
        return slice(None)
    start, end = grid.u[known[0]], grid.u[known[-1]]
    found = f"heights from u = {start:g} to {end:g} m only, of {grid.u[0]:g} to {grid.u[-1]:g} m"
    if "closed_from" in attributes:
        raise InputError(f"{found}, expected some all along a closed track", file=path, place="data")
    attributes.update(reference_height_start=float(grid.ref_z[known[0]]), reference_height_end=float(grid.ref_z[known[-1]]))
    treatment.append(f"{found}: cut there")
    return slice(known[0], known[-1] + 1)


def _folds(path, grid, elevation, choice, treatment) -> None:
    bent = checks.folds(grid.phi, grid.u[1] - grid.u[0], grid.v, np.isfinite(elevation))
    if bent.any():
        where = f"at u = {grid.u[bent.argmax()]:g} m ({bent.sum()} cross sections)"
        if choice == "refuse":
            raise InputError(
                f"bends more sharply than the road is wide {where}, so that the road folds onto itself"
                " (or folds: keep)",
                file=path,
                place="reference line",
            )
        treatment.append(f"the road folds onto itself {where}: kept")


def _equidistant(path, grid, elevation, choice, treatment) -> tuple[np.ndarray, np.ndarray]:
    """Lateral positions in equal steps, and the heights there by linear interpolation across."""
    v = grid.v
    width, columns = v[-1] - v[0], None
    for intervals in range(len(v) - 1, max(_MOST_COLUMNS, len(v))):
        place = (v - v[0]) * (intervals / width)
        if np.abs(place - np.round(place)).max() * width / intervals < (1e-6 if intervals == len(v) - 1 else 1e-8):
            columns = intervals + 1
            break
    if columns is None:
        if choice != "resample":
            raise InputError(
                "no equidistant grid passes through every long section (or lateral_grid: resample)",
                file=path,
                place="long sections",
            )
        columns = int(np.ceil(width / np.diff(v).min() - 1e-6)) + 1
        treatment.append(f"{len(v)} long sections resampled to {columns} equidistant ones, not exactly")
    elif columns > len(v):
        treatment.append(f"{len(v)} long sections resampled to {columns} equidistant ones, exact for linear")
    even = np.linspace(v[0], v[-1], columns)
    if columns == len(v):
        return even, elevation
    right = np.clip(np.searchsorted(v, even + 1e-6, side="right") - 1, 0, len(v) - 2)
    part = np.clip((even - v[right]) / np.diff(v)[right], 0.0, 1.0)
    part = np.where(np.abs(part - np.round(part)) < 1e-6, np.round(part), part)
    relative = elevation - grid.bank[:, None] * v
    between = relative[:, right] * (1 - part) + relative[:, right + 1] * part
    between[:, part == 0] = relative[:, right[part == 0]]
    between[:, part == 1] = relative[:, right[part == 1] + 1]
    return even, between + grid.bank[:, None] * even
