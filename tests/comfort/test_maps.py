"""Critical sections as GeoJSON."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import iso2631, maps
from ridecomfort.errors import InputError

S = 10.0 + 0.25 * np.arange(400)


@pytest.fixture
def comfort():
    """Ten runs: between 40 and 60 m six of them are fairly uncomfortable, elsewhere none."""
    a_v = np.full((10, S.size), 0.1)
    a_v[:6, (S >= 40) & (S < 60)] = 0.7
    return iso2631.evaluate([xr.Dataset({"a_v": (("run", "s"), a_v)}, {"run": np.arange(10), "s": S})])


@pytest.fixture
def road():
    u = np.arange(0, 121.0)
    return xr.Dataset({"x": ("u", 1000 + 60 * np.sin(u / 60)), "y": ("u", 60 * (1 - np.cos(u / 60)))}, {"u": u})


def test_sections_lie_on_the_reference_line(comfort, road):
    found = maps.geojson(comfort, road, speed=xr.DataArray(np.linspace(10, 20, 400), {"s": S}), site="ts1")
    assert json.loads(json.dumps(found))["type"] == "FeatureCollection"
    fair = [each for each in found["features"] if each["properties"]["class"] == "FU"]
    assert [each["properties"]["start_m"] for each in fair] == [40.0, 45.0, 50.0, 55.0]
    first = fair[0]["properties"]
    assert first["probability"] == 0.6 and first["probability_lower"] < 0.6 < first["probability_upper"]
    assert first["speed_m_per_s"] == pytest.approx(10 + 10 * 32.5 / 99.75, abs=0.01)
    line = np.array(fair[0]["geometry"]["coordinates"])
    assert np.hypot(line[:, 0] - 1000, line[:, 1] - 60) == pytest.approx(60.0, abs=0.01)
    assert np.sum(np.hypot(*np.diff(line, axis=0).T)) == pytest.approx(5.0, abs=0.01)
    assert "no geo-reference" in found["coordinates_in"]


def test_the_risk_level_is_the_planners(comfort, road):
    classes = {}
    for level in (0.5, 0.7):
        features = maps.geojson(comfort, road, probability=level)["features"]
        classes[level] = {each["properties"]["class"] for each in features}
    assert "FU" in classes[0.5] and "FU" not in classes[0.7]
    assert all("NU" not in names for names in classes.values())


def test_beyond_doubt_asks_for_more(comfort, road):
    """Six runs of ten make 0.6, but the interval reaches down to 0.31."""
    starts = {
        bound: [
            each["properties"]["start_m"]
            for each in maps.geojson(comfort.assign(critical=0 * comfort["critical"]), road, bound=bound)["features"]
            if each["properties"]["class"] == "FU"
        ]
        for bound in ("exceedance_probability", "exceedance_lower")
    }
    assert starts == {"exceedance_probability": [40.0, 45.0, 50.0, 55.0], "exceedance_lower": []}


def test_projected_coordinates_are_degrees(comfort, road):
    found = maps.geojson(comfort, road, project=lambda x, y: (15.0 + x / 1e5, 47.0 + y / 1e5))
    assert "coordinates_in" not in found
    longitude, latitude = found["features"][0]["geometry"]["coordinates"][0]
    assert 15.0 < longitude < 15.1 and 47.0 <= latitude < 47.1


@pytest.mark.parametrize("rule, label", [("severe", "U"), ("mild", "FU"), ("middle", "FU")])
def test_a_section_in_two_bands_is_one_feature_with_the_label_of_a_named_rule(road, rule, label):
    """0.85 m/s2 is fairly uncomfortable (0.5 to 1) and uncomfortable (0.8 to 1.6); the middle of both is 0.9."""
    shard = xr.Dataset({"a_v": (("run", "s"), np.full((3, S.size), 0.85))}, {"run": np.arange(3), "s": S})
    found = maps.geojson(iso2631.evaluate([shard]), road, rule=rule)["features"]
    assert len(found) == 20
    assert all(each["properties"]["class"] == label for each in found)
    assert all(each["properties"]["bands"] == ["FU", "U"] for each in found)


def test_the_class_of_a_section_is_one_of_its_bands_though_these_have_a_gap(road):
    """Of 20 runs 13 lie in LU or U and one in FU: what lies between the bands shown is none of them."""
    level = np.repeat([0.4, 0.9, 0.7, 0.1], [6, 7, 1, 6])
    shard = xr.Dataset({"a_v": (("run", "s"), np.repeat(level[:, None], S.size, axis=1))}, {"run": np.arange(20), "s": S})
    comfort = iso2631.evaluate([shard])
    comfort["a_v"] = comfort["a_v"] * 0 + 0.75
    for each in maps.geojson(comfort, road, probability=0.2)["features"]:
        assert each["properties"]["class"] in each["properties"]["bands"] and each["properties"]["probability"] > 0.2


def test_sliding_sections_that_overlap_are_one_feature(road):
    """0.7 m/s2 from 40 to 60 m: of sections of 5 m that begin every 0.25 m those from 40 to 55 m."""
    a_v = np.full((10, S.size), 0.1)
    a_v[:6, (S >= 40) & (S < 60)] = 0.7
    shard = xr.Dataset({"a_v": (("run", "s"), a_v)}, {"run": np.arange(10), "s": S})
    found = maps.geojson(iso2631.evaluate([shard], sliding=True), road)["features"]
    fair = [each["properties"] for each in found if each["properties"]["class"] == "FU"]
    assert [(each["start_m"], each["end_m"], each["probability"]) for each in fair] == [(40.0, 60.0, 0.6)]


def test_an_unknown_rule_is_refused(comfort, road):
    with pytest.raises(InputError, match="severe, mild, middle"):
        maps.geojson(comfort, road, rule="best")


def test_sections_beyond_the_road_are_refused(comfort, road):
    with pytest.raises(InputError, match="leave the road"):
        maps.geojson(comfort, road.isel(u=slice(0, 50)))
