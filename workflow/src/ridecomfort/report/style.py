"""Colours, sizes and fonts of all figures.

A class of severity has one colour everywhere, and so have measured drives, reference, calibrated model and error wherever
they are compared. Other lines take theirs from the same few colours (``LINES``): there a colour means what the legend says.
Colours are those of Okabe and Ito (2008), which colour-blind readers tell apart; severity
runs from light to dark so that it also reads in grey.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from ..vocabulary import SIGNALS, VARIABLES
from . import notation

SINGLE, DOUBLE = 3.5, 7.2
"""Width of one and of two columns in inches (88 mm and 183 mm)."""

MEASURED = "#3A3A3A"
REFERENCE = "#E69F00"
CALIBRATED = "#0072B2"
EFFECTS = "#009E73"
SIGNAL = "#0072B2"
ROAD = "#5B4636"
PAPER = "#CC79A7"
OURS = "#0072B2"
FAINT = "#9AA0A6"
GRID = "#DDDDDD"

SEVERITY = {
    "PT": "#F3C64E",
    "ND": "#DD7D1F",
    "AG": "#8C1C13",
    "NU": "#DCE6EC",
    "LU": "#F7DD8F",
    "FU": "#F0B13C",
    "U": "#DD7D1F",
    "VU": "#B6421A",
    "EU": "#6B0F12",
    "VG": "#DCE6EC",
    "G": "#F7DD8F",
    "F": "#F0B13C",
    "M": "#CF5F1C",
    "P": "#6B0F12",
}
"""Classes of the three methods, from mild (light) to severe (dark)."""

LINES = (
    ("#0072B2", "o"),
    ("#E69F00", "s"),
    ("#009E73", "^"),
    ("#CC79A7", "D"),
    ("#56B4E9", "v"),
    ("#D55E00", "P"),
    ("#000000", "X"),
)
"""Colour and marker of lines that are only told apart, such as parameters."""

SIGNAL_LINES = dict(zip(SIGNALS, LINES))
"""Colour and marker of each signal where several stand in one panel."""

FLOOR = "#8A8A8A"
ERROR = "#D55E00"
"""The noise floor, and the error of the model."""

SETTINGS: Mapping = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlelocation": "left",
    "axes.grid": False,
    "grid.color": GRID,
    "grid.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "mathtext.default": "it",
    "pdf.fonttype": 42,
    "path.simplify_threshold": 0.4,
    "svg.hashsalt": "ridecomfort",
}

RESOLUTION = 200
"""Dots per inch of the PNG files."""

METADATA = {
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
"""What is not written into the files, which are the same for the same data at any time."""


PER_ROW = 4
"""Panels beside each other at most in a figure of as many as there are sites."""

LETTER = 0.0085
"""Inches of width that a letter takes by the point of its size, on average of mixed text."""


BETWEEN = 3000.0
"""Ratio of its ends from which on a logarithmic axis has numbers at decades alone."""


def figure(width: float, height: float, **options) -> Figure:
    """An empty figure of a size in inches with the study's style, laid out so that nothing overlaps."""
    options.setdefault("layout", "constrained")
    return Figure(figsize=(width, height), **options)


def styled():
    """A context in which figures are drawn and saved with the study's style."""
    defaults = {key: value for key, value in matplotlib.rcParamsDefault.items() if "backend" not in key}
    return matplotlib.rc_context({**defaults, **SETTINGS})


def panels(count: int, width: float, height: float, *, margin: float) -> tuple[Figure, list[Axes]]:
    """A figure of ``count`` equal panels in rows as even as can be, and these panels from the upper left to the lower right.

    ``width`` of one and ``height`` of a row in inches, ``margin`` the width that the labels left of a row take. All share their axes.
    """
    rows = -(-count // PER_ROW)
    columns = -(-count // rows)
    drawn = figure(max(SINGLE, min(DOUBLE, margin + width * columns)), height * rows)
    every = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for axes in every[:count]:
        axes.tick_params(labelbottom=True)
    for axes in every[count:]:
        axes.set_axis_off()
    return drawn, list(every[:count])


def panel_title(axes: Axes, text: str, *, margin: float = 0.0) -> None:
    """A title over as many lines as a panel is wide for; ``margin`` in inches is what a figure needs beside its panels."""
    columns = axes.get_subplotspec().get_gridspec().ncols
    room = (axes.figure.get_size_inches()[0] - margin) / columns
    axes.set_title(textwrap.fill(text, int(room / (LETTER * SETTINGS["axes.titlesize"]))))


def legend_columns(handles, width: float) -> int:
    """How many entries of a legend fit beside each other in a width in inches."""
    size = SETTINGS["legend.fontsize"]
    # Handle, gap to its text and gap to the next entry are 4.8 times as wide as the print is high.
    longest = (4.8 / 72 + LETTER * max(len(handle.get_label()) for handle in handles)) * size
    return max(1, min(len(handles), int(width / longest)))


def axis_label(name: str) -> str:
    """Symbol and unit of a variable for an axis."""
    return f"{notation.symbol(name)} [{notation.unit(VARIABLES[name].unit)}]"


def number_decades(axis: Axis, between: tuple[int, ...]) -> None:
    """Plain numbers at the decades of a logarithmic axis whose limits are known and, where it spans less than BETWEEN, at these multiples.

    Left to itself matplotlib leaves out decades where there are many, and with them every number that is not at one.
    """
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=between if high < BETWEEN * low else (1,), numticks=12))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())


def note(axes: Axes, text: str, place: tuple[float, float]) -> None:
    """A small note above and to the right of a point."""
    axes.annotate(text, place, xytext=(3, 4), textcoords="offset points", fontsize=6)


CHARACTERS_PER_INCH = 22
"""Of the smallest print of a figure."""


def marked(drawn: Figure, words: str | None) -> Figure:
    """The figure with words in its lower right corner; as it is without any."""
    if words:
        room = int(CHARACTERS_PER_INCH * drawn.get_size_inches()[0])
        drawn.supxlabel(textwrap.fill(words, room), x=0.995, ha="right", fontsize=6, color=FLOOR)
    return drawn


def save(drawn: Figure, path) -> None:
    """Write a figure as PNG or PDF, by the ending of its path, without time stamps: equal data, equal bytes."""
    with styled():
        drawn.savefig(path, dpi=RESOLUTION, metadata=METADATA[Path(path).suffix], facecolor="white")
        # What is laid out once is laid out: the next format looks the same and takes less.
        drawn.set_layout_engine(None)
