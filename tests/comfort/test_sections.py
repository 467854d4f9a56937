"""Critical sections: whole windows, sequential and sliding."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import sections
from ridecomfort.errors import InputError
from ridecomfort.space import places

S = 50.0 + 0.25 * np.arange(400)


def test_windows_follow_upon_each_other():
    found = sections.windows(S)
    assert len(found) == 20 and found.start[:2].tolist() == [50.0, 55.0]
    assert np.all(found.behind - found.first == 20)
    # 605 windows of 5 m are 3025 m (docs/method.md, site lengths).
    assert len(sections.windows(np.arange(0, 3025.01, 0.25))) == 605
    assert len(sections.windows(np.arange(0, 3024.9, 0.1))) == 604


@pytest.mark.parametrize("sliding", [False, True])
def test_a_road_without_room_for_one_section_is_refused(sliding):
    """Of 78 m a run-in of 50 m and a run-out of 25 m leave 3 m; the study compared methods over no section at all."""
    s = places(0, 78, spacing=0.25, run_in=50, run_out=25)
    with pytest.raises(InputError, match="s: 3.25 m of road from 50 m on, expected room for one section of 5 m"):
        sections.windows(s, sliding=sliding)
    assert len(sections.windows(places(0, 80, spacing=0.25, run_in=50, run_out=25))) == 1


def test_a_window_is_critical_only_where_its_whole_length_is():
    signal = np.zeros(400)
    signal[20:40] = 1.0
    signal[60:79] = 1.0
    found = sections.critical(signal, S, 0.5)
    assert np.flatnonzero(found["critical"]).tolist() == [1]
    assert found["window_start"].values[1] == 55.0


def test_a_pair_is_left_on_either_side_and_an_array_follows_s():
    signal = np.where(np.arange(400) < 200, -3.0, 1.0)
    assert sections.critical(signal, S, (-2.0, 0.5))["critical"].all()
    assert sections.critical(signal, S, (-2.0, 1.5))["critical"].values.sum() == 10
    rising = np.linspace(0.0, 2.0, 400)
    assert sections.critical(np.ones(400), S, rising)["critical"].values.sum() == 10
    assert sections.critical(np.ones(400), S, (-rising, rising))["critical"].values.sum() == 10


def test_sliding_windows_find_what_lies_across_sequential_ones():
    signal = np.zeros(400)
    signal[30:50] = 1.0
    assert not sections.critical(signal, S, 0.5)["critical"].any()
    sliding = sections.critical(signal, S, 0.5, sliding=True)
    assert sliding["window_start"].values[sliding["critical"].values].tolist() == [S[30]]
    assert sections.stretches(sliding["critical"], sliding["window_start"], 5.0) == [(57.5, 62.5)]


def test_sliding_equals_sequential_where_they_coincide():
    signal = np.random.default_rng(1).standard_normal((3, 400)).cumsum(axis=1)
    sequential = sections.critical(signal, S, (-5.0, 5.0))
    sliding = sections.critical(signal, S, (-5.0, 5.0), sliding=True)
    assert np.array_equal(sliding["critical"].values[:, ::20][:, :20], sequential["critical"].values)


def test_irregular_places_by_plain_loops():
    rng = np.random.default_rng(2)
    s = np.sort(rng.uniform(0, 100, 300))
    signal = rng.standard_normal(300).cumsum()
    found = sections.critical(signal, s, 0.0, length=7.0)
    for start, critical in zip(found["window_start"].values, found["critical"].values):
        inside = (s >= start - 1e-6) & (s < start + 7.0 - 1e-6)
        assert critical == np.all(signal[inside] > 0.0)


def test_within_a_class_and_xarray():
    values = np.tile([[0.2], [0.4], [0.7]], (1, 400))
    signal = xr.DataArray(values, dims=("run", "s"), coords={"run": [4, 5, 6], "s": S})
    found = sections.within(signal, S, 0.315, 0.63)
    assert found["critical"].dims == ("run", "window")
    assert found["critical"].sel(run=5).all() and not found["critical"].sel(run=[4, 6]).any()


def test_means():
    assert sections.windows(S).mean(S) == pytest.approx(50.0 + 5.0 * np.arange(20) + 0.25 * 9.5)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((np.zeros(9), S, 0.0), "9"),
        ((np.full(400, np.nan), S, 0.0), "gap at s = 50 m"),
        ((np.zeros(400), S, (1.0, -1.0)), "above the upper"),
        ((np.zeros(400), S, 0.0, -5.0), "not a length"),
        ((np.zeros(3), [0.0, 10.0, 20.0], 0.0, 5.0), "no sample between"),
        ((np.zeros(2), [1.0, 0.0], 0.0), "ascending"),
        ((np.ones(400), S, np.nan), "threshold: nan, expected a number"),
        ((np.ones(400), S, (np.nan, 0.5)), "threshold: nan, expected a number"),
        ((np.ones(400), S, (-0.5, np.where(S < S[9], np.nan, 0.5))), "threshold: nan, expected a number"),
    ],
)
def test_mistakes_are_named(arguments, message):
    with pytest.raises(InputError, match=message):
        sections.critical(*arguments)
