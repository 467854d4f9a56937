"""The cross slope of a road surface, found from its heights."""

from __future__ import annotations

import warnings

import numpy as np
import xarray as xr

LENGTH = 5.0
"""m along the road that a cross slope is the median over; shorter it shows the texture."""


def cross_slope(road: xr.Dataset, length: float = LENGTH) -> np.ndarray:
    """Cross slope (u) of the surface, positive with the left side up; NaN where nothing opposite is known.

    Of every cross section the median slope between heights half the grid apart, then the median over
    ``length`` m along. Ruts, curbs and holes in less than a quarter of the width leave it as it is.
    Heights are total ones, so the bank that a file stores them against is in it, whatever that is.

    Source: Theil (1950), A rank-invariant method of linear and polynomial regression analysis (incomplete method).
    """
    u, v, heights = road["u"].values, road["v"].values, road["elevation"].values
    half = (len(v) + 1) // 2
    slopes = (heights[:, half:] - heights[:, : len(v) - half]) / (v[half:] - v[: len(v) - half])
    reach = round(0.5 * length / (u[1] - u[0]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of cross sections without a height, which stay NaN
        each = np.nanmedian(slopes, axis=1)
        padded = np.pad(each, reach, constant_values=np.nan)
        return np.nanmedian(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1), axis=1)
