"""What an OpenCRG file may get wrong that the ASAM library lets pass."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pycrg

from ..errors import InputError

HEIGHT_LIMIT = 10_000.0
"""m; no road lies higher or lower."""

TURN_LIMIT = 1e4
"""rad; no road winds more than 1600 times around."""

STEP_LIMIT = 10.0
"""m that a height may lie above or below the median of its cross section."""

_UNITS = {"phi": "rad", "slope": "m/m", "banking": "m/m"}
"""Of the channels of the reference line that are not in m, as all others and the long sections are (OpenCRG 1.2)."""

_TEXT_FIELD = {"LRFI": (10, 8), "LDFI": (20, 4)}
"""Characters a value and values a line (OpenCRG 1.2, data formats)."""

_END_TOLERANCE = 1e-4
"""Of the length of a reference line, within which its ends lie where the header says."""

_SPACING_TOLERANCE = 0.03
"""Of the reference line's points; what the ASAM library grants where a file gives x and y (crgLoader.c)."""

_BINARY_VALUE = {"KRBI": 4, "KDBI": 8}
"""Bytes a value."""

_BINARY_BLOCK = 80
"""Bytes that binary data are padded to."""

_MAGNITUDES = 1e-30, 1e9
"""Between which numbers of a road lie that are not zero, of all channels."""

_CHANNEL = re.compile(r"long section|reference line (u|x|y|z|phi|slope|banking)\b", re.IGNORECASE)
"""The names of OpenCRG's data channels."""

_NOT_UNDERSTOOD = "Error parsing"
"""What the library says of a line of the header that it goes on without."""

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
"""What the library reads whole: of 2.0D-02 it takes 2.0, of 1_0 the 1."""

_FIELD = re.compile(rf"{_NUMBER}|[+-]?nan|\*.*".encode(), re.IGNORECASE)
"""What a text field may hold; without a value asterisks, a word that begins with one, or nan."""

_CUT_SHORT = re.compile(rf"{_NUMBER}([dD_][\d+-].*|\s+[\d.].*)")
"""A parameter of the header of which the library takes the beginning."""

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d.*")

_MODES = {"border_mode_u": 5, "border_mode_v": 5, "refline_continuation": 2, "grid_nan_mode": 3}
"""How many values those options and modifiers have that choose; they count from 0."""


def headers(path: Path) -> list[pycrg.CrgHeader]:
    """The headers of a file and of those it refers to; the last one is that of the data.

    References are looked for as the ASAM library does: from the working
    directory, then beside the file that names them. A missing one, a circle of
    them and a file that is no OpenCRG file raise InputError.
    """
    found: list[pycrg.CrgHeader] = []
    while True:
        if not path.is_file():
            if found:
                raise InputError(f"refers to {path}, which does not exist", file=found[-1].path, place="$ROAD_CRG_FILE")
            raise InputError("a folder, expected a file" if path.is_dir() else "no such file", file=path)
        if any(path.samefile(head.path) for head in found):
            raise InputError(f"refers back to {path}", file=found[-1].path, place="$ROAD_CRG_FILE")
        try:
            found.append(pycrg.read_header(path))
        except (OSError, ValueError) as problem:
            raise InputError(f"cannot be read ({problem})", file=path) from None
        if found[-1].data_format is not None:
            return found
        if found[-1].file_reference is None:
            raise InputError("not an OpenCRG file: neither $KD_DEFINITION nor $ROAD_CRG_FILE in it", file=path)
        reference = Path(_expand(found[-1].file_reference, path))
        path = reference if reference.is_absolute() or reference.is_file() else path.parent / reference


def _expand(reference: str, path: Path) -> str:
    """A file reference with its leading environment variable put in."""
    if not reference.startswith("$"):
        return reference
    name, _, rest = reference[1:].partition("/")
    if name not in os.environ:
        raise InputError(f"environment variable {name} is not set", file=path, place="$ROAD_CRG_FILE")
    return f"{os.environ[name]}/{rest}"


def numbers(found: list[pycrg.CrgHeader]) -> None:
    """InputError unless every parameter, option and modifier is a number, and one that is a choice is among its values.

    The library takes words for zero, 1,5 and 1.0D+01 for 1, and a choice that it does not know for its default.
    """
    for head in found:
        values = {**head.road, **(head.options or {}), **(head.modifiers or {})}
        for key, text in _entries(head):
            if key in values and _DECIMAL_COMMA.fullmatch(text):
                raise InputError(f"{text!r}, expected a number with a decimal point", file=head.path, place=key)
            if key in values and _CUT_SHORT.fullmatch(text):
                raise InputError(f"{text!r}, expected a number", file=head.path, place=key)
        for key, value in values.items():
            if isinstance(value, str):
                raise InputError(f"{value!r}, expected a number", file=head.path, place=key)
            if not np.isfinite(value):
                raise InputError(f"{value:g}, expected a finite number", file=head.path, place=key)
            if key in _MODES and value not in range(_MODES[key]):
                raise InputError(f"{value:g}, expected one of {', '.join(map(str, range(_MODES[key])))}", file=head.path, place=key)


def _entries(head: pycrg.CrgHeader) -> Iterator[tuple[str, str]]:
    """Key, in small letters, and value of all entries of a header, comments aside."""
    comment = False
    with open(head.path, encoding="latin-1") as lines:
        for line in lines:
            line = line.strip()
            if line.startswith("$$$$"):
                return
            if line.startswith("$"):
                comment = not comment and line.upper().startswith("$CT")
            elif not comment and "=" in line and not line.startswith("*"):
                key, _, value = line.partition("!")[0].partition("=")
                yield key.strip().lower(), value.strip()


def extent(head: pycrg.CrgHeader) -> None:
    """InputError for a length, width or spacing in the header that is not positive: some make the library crash."""
    road = head.road
    for key in ("reference_line_increment", "long_section_v_increment"):
        if road.get(key, 1.0) <= 0.0:
            raise InputError(f"{road[key]:g} m, expected positions that rise", file=head.path, place=key)
    for low, high in (("reference_line_start_u", "reference_line_end_u"), ("long_section_v_right", "long_section_v_left")):
        if high in road and road[high] <= road.get(low, 0.0 if low.endswith("u") else -np.inf):
            raise InputError(f"{road[high]:g} m, expected more than {road.get(low, 0.0):g} m", file=head.path, place=high)


def units(head: pycrg.CrgHeader) -> None:
    """InputError for a data channel that is not in the unit of the standard.

    The library takes mm for m and grad for rad, and goes on without a channel in deg or without a unit.
    """
    for channel in head.channels:
        if channel.kind == "D" and (match := _CHANNEL.match(channel.name)):
            wanted = _UNITS.get((match[1] or "").lower(), "m")
            if channel.unit.lower() != wanted:
                found = f"in {channel.unit!r}" if channel.unit else "without a unit"
                raise InputError(f"{channel.name!r} {found}, expected in {wanted}", file=head.path, place="$KD_DEFINITION")


def understood(head: pycrg.CrgHeader, warnings: list[str]) -> None:
    """InputError where the library warns of a line that it goes on without: a channel less, and all behind it are shifted by one."""
    if any(_NOT_UNDERSTOOD in warning for warning in warnings):
        raise InputError(
            f"{'; '.join(warnings).rstrip('.')}; expected lines that ASAM's library understands: without a channel it shifts those behind",
            file=head.path,
            place="header",
        )


def payload(head: pycrg.CrgHeader, cross_sections: int) -> None:
    """InputError unless the data of the file hold just that many whole cross sections."""
    channels = sum(channel.kind == "D" for channel in head.channels)
    if head.data_format in _TEXT_FIELD:
        _text(head, cross_sections, channels, *_TEXT_FIELD[head.data_format])
    elif head.data_format in _BINARY_VALUE:
        data = _data(head)
        size = len(data)
        wanted = cross_sections * channels * _BINARY_VALUE[head.data_format]
        if not wanted <= size < wanted + 2 * _BINARY_BLOCK:
            raise InputError(
                f"{size} bytes, expected {wanted} for {cross_sections} cross sections of {channels} channels",
                file=head.path,
                place="data",
            )
        _byte_order(head, np.frombuffer(data[:wanted], f">f{_BINARY_VALUE[head.data_format]}"))
    else:
        raise InputError(
            f"{head.data_format!r}, expected LRFI, LDFI, KRBI or KDBI", file=head.path, place="$KD_DEFINITION"
        )


def _byte_order(head: pycrg.CrgHeader, values: np.ndarray) -> None:
    """InputError for numbers that make sense only when their bytes are read the other way round."""

    def sensible(numbers: np.ndarray) -> bool:
        size = np.abs(numbers[np.isfinite(numbers) & (numbers != 0.0)], dtype=np.float64)
        return bool(((size > _MAGNITUDES[0]) & (size < _MAGNITUDES[1])).all())

    if not sensible(values) and sensible(values.byteswap()):
        raise InputError("numbers stored with their last byte first, expected the first byte first", file=head.path, place="data")


def _data(head: pycrg.CrgHeader) -> bytes:
    """What follows the line of dollar signs that ends the header."""
    whole = Path(head.path).read_bytes()
    start = re.search(rb"^ *\$\$\$\$[^\n]*\n", whole, re.MULTILINE)
    return whole[start.end() :] if start else b""


def _text(head: pycrg.CrgHeader, cross_sections: int, channels: int, width: int, per_line: int) -> None:
    """Every cross section begins on a line of its own; its values fill fields of equal width.

    The library counts characters on from one line of a cross section to its next: only its last line may have blanks behind its values.
    """
    lines = [line for line in _data(head).rstrip().splitlines() if line]
    lines_each = -(-channels // per_line)
    for number, whole in enumerate(lines):
        in_section, line = number % lines_each, whole.rstrip()
        wanted = per_line if in_section < lines_each - 1 else channels - per_line * (lines_each - 1)
        cut = number == len(lines) - 1 and len(line) < len(lines[in_section].rstrip())
        too_long = len(whole) - width * per_line if in_section < lines_each - 1 else 0
        if cut or too_long < 0 or -(-len(line) // width) != wanted:
            raise InputError(
                f"{len(line) / width:g} values, expected {wanted} ({channels} channels): cut off or misaligned",
                file=head.path,
                place=f"data line {number + 1} of {len(lines)}",
            )
        if too_long > 0:
            raise InputError(
                f"blanks at the end of the line: {len(whole)} characters, expected {width * per_line} before the next line of its"
                " cross section",
                file=head.path,
                place=f"data line {number + 1} of {len(lines)}",
            )
        _fields(head, line, width, number)
    if len(lines) != cross_sections * lines_each:
        raise InputError(
            f"lines for {len(lines) / lines_each:g} cross sections, of which {cross_sections} are whole:"
            " is the end of the last line missing?",
            file=head.path,
            place="data",
        )


def _fields(head: pycrg.CrgHeader, line: bytes, width: int, number: int) -> None:
    """Every field of a line of data holds a number or says that there is none; the library takes the rest for none, or for another one."""
    for start in range(0, len(line), width):
        field = line[start : start + width].strip()
        if not _FIELD.fullmatch(field):
            problem = f"{field.decode('latin-1')!r} in columns {start + 1} to {start + width}, expected a number"
            raise InputError(problem, file=head.path, place=f"data line {number + 1}")


def size(head: pycrg.CrgHeader, u: np.ndarray, v: np.ndarray) -> None:
    """InputError when the grid that was read has no extent, or contradicts the length or width in the header."""
    road = head.road
    names = [channel.name.lower() for channel in head.channels if channel.kind == "D"]
    if "reference_line_increment" not in road and not {"reference line x", "reference line u"} & set(names):
        raise InputError("missing, so that the length of the road is unknown", file=head.path, place="reference_line_increment")
    if not any(key.startswith("long_section_v") for key in road) and not positions(head):
        raise InputError("missing, so that the width of the road is unknown", file=head.path, place="long_section_v_increment")
    for axis, at, place in (("u", u, "reference_line_increment"), ("v", v, "long sections")):
        if not (np.isfinite(at).all() and (np.diff(at) > 0).all()):
            listed = ", ".join(f"{value:g}" for value in at[:3])
            raise InputError(f"{axis} = {listed}, ... m, expected positions that rise", file=head.path, place=place)
    if "reference_line_end_u" in road:
        start, end = road.get("reference_line_start_u", 0.0), road["reference_line_end_u"]
        wanted = (end - start) / (u[1] - u[0]) + 1
        if abs(wanted - len(u)) > 0.01:
            raise InputError(
                f"data of {len(u)} cross sections, but u from {start:g} to {end:g} m every {u[1] - u[0]:g} m"
                f" makes {wanted:.10g}",
                file=head.path,
                place="reference_line_end_u",
            )
    for key, value in (("long_section_v_right", v[0]), ("long_section_v_left", v[-1])):
        if key in road and abs(road[key] - value) > 1e-6 * max(1.0, abs(value)):
            raise InputError(
                f"{road[key]:g} m, but its long sections reach from {v[0]:g} to {v[-1]:g} m", file=head.path, place=key
            )
    if {"long_section_v_right", "long_section_v_left", "long_section_v_increment"} <= road.keys():
        width = road["long_section_v_left"] - road["long_section_v_right"]
        wanted = width / road["long_section_v_increment"] + 1
        if abs(wanted - len(v)) > 0.01 and not positions(head):
            raise InputError(
                f"data of {len(v)} long sections, but {width:g} m every {road['long_section_v_increment']:g} m"
                f" makes {wanted:.10g}",
                file=head.path,
                place="long_section_v_increment",
            )


def reference_line(grid: pycrg.CrgGrid, path) -> None:
    """InputError unless every point, slope and bank of the line is finite and its points lie as far apart as u says."""
    # The heading first: x and y that follow from a broken one are broken from the start.
    channels = (
        ("heading", grid.phi, TURN_LIMIT, "rad"), ("slope", np.append(0.0, grid.slope[1:]), np.inf, ""),
        ("height", grid.ref_z, HEIGHT_LIMIT, "m"), ("bank", grid.bank, np.inf, ""), ("x", grid.x, np.inf, "m"),
        ("y", grid.y, np.inf, "m"),
    )  # fmt: skip
    for name, values, limit, unit in channels:
        wrong = ~np.isfinite(values) | (np.abs(np.nan_to_num(values)) > limit)
        if wrong.any():
            i = int(wrong.argmax())
            raise InputError(
                f"{name} {f'{values[i]:.4g} {unit}'.strip()}, the first of {wrong.sum()} that are none, expected a finite number"
                f"{f' within {limit:g}' if np.isfinite(limit) else ''}; no option repairs a reference line: take another copy of the file",
                file=path,
                place=f"reference line, u = {grid.u[i]:g} m",
            )
    du = grid.u[1] - grid.u[0]
    step = np.hypot(np.diff(grid.x), np.diff(grid.y))
    worst = int(np.abs(step - du).argmax())
    if abs(step[worst] - du) > _SPACING_TOLERANCE * du:
        raise InputError(
            f"points {step[worst]:.4g} m apart at u = {grid.u[worst]:g} m, expected {du:g}: do its ends contradict its headings?",
            file=path,
            place="reference line",
        )


def ends(head: pycrg.CrgHeader, grid: pycrg.CrgGrid) -> None:
    """InputError when the line that was read, modifiers aside, starts or ends elsewhere than the header says."""
    du = grid.u[1] - grid.u[0]
    for side, verb, k in (("start", "starts", 0), ("end", "ends", -1)):
        wanted = [head.road.get(f"reference_line_{side}_{axis}") for axis in "xy"]
        if None not in wanted:
            off = np.hypot(wanted[0] - grid.x[k], wanted[1] - grid.y[k])
            if off > _SPACING_TOLERANCE * du + _END_TOLERANCE * (grid.u[-1] - grid.u[0]):
                raise InputError(
                    f"({wanted[0]:.10g}, {wanted[1]:.10g}) m, but the line {verb} at ({grid.x[k]:.10g}, {grid.y[k]:.10g}) m",
                    file=head.path,
                    place=f"reference_line_{side}_x",
                )


def positions(head: pycrg.CrgHeader) -> list[float]:
    """Lateral positions in m that the channels of the file name, in its order; empty if they name none."""
    at = []
    for channel in head.channels:
        if match := re.match(r"long section at v\s*=(.*)", channel.name, re.I):
            try:
                at.append(float(match[1]))
                if not np.isfinite(at[-1]):
                    raise ValueError
            except ValueError:
                problem = f"{channel.name!r}, expected a position in m"
                raise InputError(problem, file=head.path, place="$KD_DEFINITION") from None
    return at


def lateral_range(path: Path) -> tuple[float, float] | None:
    """Right and left end in m of the long sections of a file by its headers; None where these do not tell, or are wrong."""
    try:
        found = headers(path)
        numbers(found)
        at = positions(found[-1]) or [found[-1].road.get(f"long_section_v_{side}") for side in ("right", "left")]
    except InputError:
        return None  # reading it says why
    scaled = any("scale_width" in (head.modifiers or {}) for head in found)
    return None if scaled or None in at else (min(at), max(at))


def strange(head: pycrg.CrgHeader) -> list[str]:
    """Names of data channels that are neither of the reference line nor a long section: the library leaves them out."""
    names = [channel.name for channel in head.channels if channel.kind == "D"]
    return [name for name in names if not _CHANNEL.match(name)]


def order(head: pycrg.CrgHeader) -> None:
    """InputError unless the long sections stand from right to left, each at its own position."""
    at = positions(head)
    for right, left in zip(at, at[1:]):
        if not left > right:
            raise InputError(
                f"v = {left:g} m follows v = {right:g} m, expected positions that rise (or long_sections: sort)",
                file=head.path,
                place="$KD_DEFINITION",
            )


def unreasonable(elevation: np.ndarray, u: np.ndarray) -> np.ndarray:
    """True for heights (u, v) beyond HEIGHT_LIMIT, infinite ones too, or beyond STEP_LIMIT from their cross section.

    That is its median or, where most of a cross section is out of reason, the median of the nearest sound one.
    """
    known = np.isfinite(elevation)
    wild = known & (np.abs(np.where(known, elevation, 0.0)) > HEIGHT_LIMIT)
    usable = np.where(known & ~wild, elevation, np.nan)
    rows = np.flatnonzero(np.isfinite(usable).any(axis=1))
    median = np.zeros(len(elevation))
    if rows.size:
        known_median = np.nanmedian(usable[rows], axis=1)
        sound = _one_road(known_median, u[rows])
        median[rows] = known_median[sound][np.abs(u[rows, None] - u[rows[sound]]).argmin(axis=1)] if not sound.all() else known_median
    with np.errstate(over="ignore"):
        return wild | np.isinf(elevation) | (known & (np.abs(np.where(known, elevation, 0.0) - median[:, None]) > STEP_LIMIT))


def _one_road(level: np.ndarray, u: np.ndarray) -> np.ndarray:
    """True for cross sections that are one road with its longest stretch without a step, by their levels in m.

    From there on, either way, a stretch belongs to it that goes on at its level: no further from it than STEP_LIMIT,
    or than they lie apart along ``u``.
    """
    cut = np.flatnonzero(np.abs(np.diff(level)) > np.maximum(STEP_LIMIT, np.diff(u))) + 1
    stretches = np.split(np.arange(len(level)), cut)
    longest = int(np.argmax([len(stretch) for stretch in stretches]))
    sound = np.zeros(len(level), dtype=bool)
    sound[stretches[longest]] = True
    for onwards, end in ((stretches[longest + 1 :], -1), (stretches[:longest][::-1], 0)):
        last = stretches[longest][end]
        for stretch in onwards:
            first = stretch[-1 - end]
            if abs(level[first] - level[last]) <= max(STEP_LIMIT, abs(u[first] - u[last])):
                sound[stretch], last = True, stretch[end]
    return sound


def folds(heading: np.ndarray, du: float, v: np.ndarray, known: np.ndarray) -> np.ndarray:
    """True for cross sections whose centre of curvature lies on the road, so that it overlaps itself.

    ``heading`` (u) in rad is that of the segment that ends at each cross section,
    ``known`` (u, v) is True where the road has a height.
    """
    curvature = np.zeros(len(heading))
    curvature[1:-1] = np.sin(np.diff(heading[1:])) / du
    inner = curvature[:, None] * v >= 1.0
    return (inner & known).any(axis=1)
