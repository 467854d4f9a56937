"""The classes of the three methods as tables and figures list them, mildest first; those that are critical."""

from __future__ import annotations

from ..comfort.bands import BANDS
from ..comfort.iriclass import QUALITIES
from ..comfort.limits import STYLES

__all__ = ["CRITICAL_BANDS", "CRITICAL_QUALITIES", "QUALITIES", "STYLES"]

CRITICAL_BANDS = tuple(BANDS)[1:]

CRITICAL_QUALITIES = QUALITIES[1:]
