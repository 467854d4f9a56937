"""Units that signals are printed in: rates in deg/s, as the paper's, everything else as in the files."""

from __future__ import annotations

import numpy as np

from ..vocabulary import VARIABLES
from .notation import unit


def printed(signal: str) -> tuple[float, str]:
    """Factor from the files' unit of a signal to the printed one, and that unit."""
    if VARIABLES[signal].unit == "rad/s":
        return 180.0 / np.pi, "deg/s"
    return 1.0, unit(VARIABLES[signal].unit)
