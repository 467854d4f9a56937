"""OpenCRG files made for a test, or spoilt for it."""

from __future__ import annotations

import re

import numpy as np
import pycrg


def small(path, **changes):
    """A file of 30 x 5 cells, 0.1 m along and 1 m across, written by pycrg."""
    z = np.random.default_rng(3).normal(0, 0.01, (30, 5))
    arguments = {"z": z, "du": 0.1, "v": np.linspace(-2, 2, 5), "mods": {}} | changes
    pycrg.write(path, **arguments)
    return path


def edited(source, target, *replacements):
    """A copy of a text file in which each pattern was replaced, and was there to be replaced."""
    text = source.read_text(encoding="latin-1")
    for pattern, new in replacements:
        text, count = re.subn(pattern, new, text)
        assert count, pattern
    target.write_text(text, encoding="latin-1")
    return target
