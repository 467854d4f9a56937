"""The path of a drive beside the one that is recorded."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.drive import align, path
from tests import quarter_cars


@pytest.mark.parametrize(("around", "found"), [(None, 0.0), (0.3, 0.3), (-0.5, -0.5)])
def test_a_search_without_room_ends_where_it_begins(around, found, monkeypatch):
    """Where the road is hardly wider than the car no other path is tried."""
    beginning = around or 0.0
    monkeypatch.setattr(path, "free", lambda work, road: (beginning - 0.05, beginning + 0.05))
    monkeypatch.setattr(path, "part", lambda work: work)
    assert path.find_offset(None, None, None, None, {}, around) == pytest.approx(found)


def swinging(road, nominal, aside, e):
    """What alignment finds of a drive whose path swings by ``aside`` (m) and is recorded as ``e`` makes of it, by another car than the nominal one."""
    run = quarter_cars.driven(road, quarter_cars.other(nominal), aside=aside)
    recorded = quarter_cars.recorded(run, noise=1.0)
    recorded["e"] = "time", e(run["e"].values, run["time"].values)
    found = align.align(recorded, road, nominal, simulate=quarter_cars.run)
    return found, found["e"].values - run["e"].values[: found.sizes["time"]]


@pytest.mark.parametrize("more", [0.0, 0.25])
@pytest.mark.parametrize("aside", [0.15, 0.3])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_path_of_the_wrong_sign_is_told_and_found(nominal, seed, aside, more):
    road = quarter_cars.road(length=560.0, seed=seed)
    found, off = swinging(road, nominal, aside, lambda e, time: more - e)
    (said,) = found.attrs["faults"].split("; ")
    assert said.startswith("e fits the road better with its sign reversed (") and "is it positive to the left" in said
    assert np.sqrt(np.mean(off**2)) < 0.03


@pytest.mark.parametrize("aside", [0.0, 0.05, 0.15, 0.3])
@pytest.mark.parametrize(
    "e",
    [
        lambda e, time: e,
        lambda e, time: e - 0.3,
        lambda e, time: e + 0.2 * np.sin(time),
        lambda e, time: e + 0.05 * np.random.default_rng(1).standard_normal(e.size),
        lambda e, time: e.mean() + 0.05 * np.random.default_rng(1).standard_normal(e.size),
    ],
    ids=["right", "aside", "drift", "noise", "nothing but noise"],
)
def test_a_path_of_the_right_sign_is_not_called_reversed(road, nominal, aside, e):
    assert "reversed" not in swinging(road, nominal, aside, e)[0].attrs["faults"]
