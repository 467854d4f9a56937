"""Comfort of one recording or profile of your own: ISO 2631-1, thresholds or IRI.

Files are CSV with one row of column names. A recording has a column time and any of a_x, a_y, a_z; a
profile has a column s, the distance, and one or more of left, right (the wheel tracks) and elevation, the
heights. Units stand in brackets behind the names, as in a_z [g] or elevation [mm]; without, they are s, m/s2 and m.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..comfort import alone
from ..comfort.seat import Seat
from ..errors import InputError
from ..report import recording as drawing
from ..store import replacing


def arguments(parser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--iso2631", type=Path, metavar="CSV", help="comfort, health and sickness by ISO 2631-1 (time; a_x, a_y, a_z)")
    what.add_argument("--thresholds", type=Path, metavar="CSV", help="acceleration and jerk against driving styles (the same columns)")
    what.add_argument("--iri", type=Path, metavar="CSV", help="IRI of a profile, per segment (s; left, right or elevation)")
    parser.add_argument("--unit", help="of the accelerations: m/s2 or g (default that of the header, else m/s2)")
    parser.add_argument(
        "--column", action="append", default=[], metavar="NAME=COLUMN", help="which column is which of those named above"
    )
    parser.add_argument("--exposure", type=float, metavar="MINUTES", help="of a trip made of nothing else")
    parser.add_argument(
        "--seat", type=float, nargs=2, metavar=("HZ", "DAMPING"), help="recorded on the floor: a_z through such a seat"
    )
    parser.add_argument("--segment", type=float, metavar="M", help="of the IRI (default 100)")
    parser.add_argument("--local", type=float, metavar="M/KM", help="name the stretches of local roughness above this IRI")
    parser.add_argument("--smoothed", action="store_true", help="the profile is averaged over 250 mm already")
    parser.add_argument("--output", type=Path, metavar="FOLDER", help="for table and plot (default beside the CSV)")


SEGMENT = 100.0
"""m over which the IRI is told."""

USED = {
    "iso2631": ("unit", "column", "exposure", "seat"),
    "thresholds": ("unit", "column"),
    "iri": ("column", "segment", "local", "smoothed"),
}
"""Options that each method has a use for."""


def run(options) -> None:
    method = next(name for name in ("iso2631", "thresholds", "iri") if getattr(options, name))
    file = getattr(options, method)
    for name in {name for names in USED.values() for name in names} - set(USED[method]):
        if getattr(options, name) not in (None, [], False):
            used = ", ".join(f"--{other}" for other in USED[method])
            raise InputError(f"means nothing to --{method} (expected of {used})", place=f"--{name}")
    if method == "iri":
        columns = _columns(options, ("s", *alone.HEIGHTS))
        segment = SEGMENT if options.segment is None else options.segment
        result = alone.roughness(file, segment, smoothed=options.smoothed, local=options.local, columns=columns)
    else:
        recording = alone.recording(file, {"columns": _columns(options, ("time", *alone.AXES)), "unit": options.unit})
        if method == "iso2631":
            exposure = None if options.exposure is None else 60.0 * options.exposure
            result = alone.ride(recording, exposure, Seat(*options.seat) if options.seat else None)
        else:
            result = alone.styles(recording)
    print(result.text())
    table, plot = ((options.output or file.parent) / f"{file.stem}_{method}{suffix}" for suffix in (".csv", ".png"))
    with replacing(table) as table_part, replacing(plot) as plot_part:
        result.table.to_csv(table_part, index=False)
        drawing.draw(result, plot_part)
    print(f"\nwritten: {table} and {plot}")


def _columns(options, known: Sequence[str]) -> dict:
    """The columns that are named, by quantity of those that are ``known``."""
    columns = {}
    for entry in options.column:
        name, equals, column = entry.partition("=")
        if not equals or name not in known:
            raise InputError(f"{entry!r} is not NAME=COLUMN with a NAME of {', '.join(known)}", place="--column")
        columns[name] = {"column": column}
    return columns
