"""Sections of measured drives and of their replays: graded by what was put where."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import critical
from ridecomfort.vocabulary import SIGNALS


@pytest.fixture(scope="module")
def found():
    """Two repeats at 10 m/s: brakes at 3 m/s2 between 300 and 320 m that the replay does not know of; 60 m of run-in."""
    time = np.arange(6000) / 100.0
    s = 10.0 * time
    measured = np.zeros((2, 6, time.size))
    simulated = measured.copy()
    measured[:, SIGNALS.index("a_x")] = np.where((s >= 300) & (s <= 320), -3.0, 0.0)
    residual = simulated - measured
    residual[:, :, s < 60] = np.nan
    over = (("drive", "time"), np.stack([s, s]))
    comparison = xr.Dataset(
        {
            "measured": (("drive", "signal", "time"), measured),
            "simulated": (("state", "drive", "signal", "time"), simulated[None]),
            "residual": (("state", "drive", "signal", "time"), residual[None]),
            "s": over,
            "v_x": (("drive", "time"), np.full((2, time.size), 10.0)),
            "e": (("drive", "time"), np.zeros((2, time.size))),
            "role": ("drive", ["fit", "fit"]),
        },
        {"state": ["calibrated"], "drive": ["one", "two"], "signal": list(SIGNALS), "time": time},
    )
    return critical.critical(comparison, spacing=0.25)


def graded(found, method, source):
    grades = found["grade"].sel({"method": method, "source": source, "drive": "one"}).values
    return dict(zip(found["window_start"].values, grades))


def test_a_section_has_the_worst_style_that_is_left_in_its_whole_length(found):
    grades = graded(found, "thresholds", "measured")
    assert all(grades[place] == 2 for place in (300.0, 305.0, 310.0, 315.0))  # beyond PT and ND, within AG
    assert grades[295.0] == grades[325.0] == 0


def test_what_the_model_does_not_do_it_is_not_graded_for(found):
    assert set(graded(found, "thresholds", "calibrated").values()) == {0}
    assert set(graded(found, "iso2631", "calibrated").values()) == {0, critical.NOT_DRIVEN}


def test_iso2631_counts_the_bands_whose_lower_edge_is_reached(found):
    """Wd at constant braking of 2 s: a total value beyond 1.25 m/s2 (very uncomfortable) at its height, decaying after."""
    grades = graded(found, "iso2631", "measured")
    assert max(grades.values()) >= 3 and grades[100.0] == 0


def test_sections_of_the_run_in_are_not_there(found):
    assert found["window_start"].min() >= 60.0
    assert (found["grade"].sel({"method": "thresholds"}) >= 0).all()


def test_sections_of_the_first_second_have_no_running_rms_yet(found):
    """ISO 2631-1 averages over the second before: it is known from 70 m on at 10 m/s."""
    grades = graded(found, "iso2631", "measured")
    assert {grade for place, grade in grades.items() if place < 70.0} == {critical.NOT_DRIVEN}
    assert min(grade for place, grade in grades.items() if place >= 75.0) == 0


def test_repeats_share_a_group(found):
    assert len(set(found["repeat_group"].values)) == 1
