"""The profiles that the wheels of a car roll along."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..errors import InputError
from .surface import smoothed_ends

WHEEL_TRACKS = (-0.75, 0.75)
"""m to the left of the reference line; 1.5 m apart as the wheels of a passenger car."""


def tracks(road: xr.Dataset, offsets: Sequence[float] = WHEEL_TRACKS) -> np.ndarray:
    """Profiles (track, u) in m of a road at lateral positions in m to the left of its reference line.

    Raises InputError where a track leaves the road or runs over a hole.
    """
    v, heights = road["v"].values, road["elevation"].transpose("u", "v").values
    answer = []
    for offset in offsets:
        if not v[0] <= offset <= v[-1]:
            raise InputError(f"wheel track at {offset:g} m lies outside the road, {v[0]:g} to {v[-1]:g} m")
        left = min(max(int(np.searchsorted(v, offset, side="right")) - 1, 0), len(v) - 2)
        share = (offset - v[left]) / (v[left + 1] - v[left])
        on_line = share in (0.0, 1.0)  # what lies beside it may be a hole
        profile = heights[:, left + int(share)] if on_line else (1 - share) * heights[:, left] + share * heights[:, left + 1]
        if not np.isfinite(profile).all():
            where = float(road["u"][int(np.argmin(np.isfinite(profile)))])
            raise InputError(f"wheel track at {offset:g} m leaves the road at u = {where:g} m")
        answer.append(smoothed_ends(road, profile))
    return np.array(answer)
