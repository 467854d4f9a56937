"""The ladder starts with all of the explainable error and ends at the floor."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy.ladder import ladder, table


def test_shares_left_fall_from_one_to_nought():
    squares = np.array([[[5.0]], [[3.0]], [[1.0]]])
    rungs = ladder(
        xr.Dataset(
            {
                "mean_square": (("model", "drive", "signal"), squares),
                "held_out_mean_square": (("model", "held_out", "signal"), squares + 1.0),
                "floor_mean_square": (("drive", "signal"), [[1.0]]),
                "held_out_floor_mean_square": (("held_out", "signal"), [[1.0]]),
            },
            {"model": ["calibrated", "one", "two"], "signal": ["a_z"]},
            {"floor": "from repeats"},
        )
    )
    assert rungs["left"].values.ravel() == pytest.approx([1.0, 0.5, 0.0])
    assert rungs["held_out_left"].values.ravel() == pytest.approx([1.0, 0.6, 0.2])
    assert [row["model"] for row in table(rungs)] == ["calibrated", "one", "two"]
    assert table(rungs)[0]["rmse"] == pytest.approx(np.sqrt(5.0))
