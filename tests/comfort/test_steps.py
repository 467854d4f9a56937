"""The steps of the workflow: shards in, the comfort datasets of the study out."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from ridecomfort import store
from ridecomfort.comfort import bands, iriedges, limits
from ridecomfort.errors import InputError
from ridecomfort.steps import agreement, iri, iso2631, maps
from ridecomfort.steps import thresholds as thresholds_step
from tests.described import undescribed

CONFIG = {
    "critical_length": 5,
    "sections": "sequential",
    "jerk": {name: [band.lower, band.upper] for name, band in limits.JERK.items()},
    "thresholds": {
        axis: {style: [band.lower, band.upper] for style, band in styles.items()}
        for axis, styles in limits.ACCELERATION.items()
    },
    "iso2631": {"bands": {name: [low, None if high == np.inf else high] for name, (low, high) in bands.BANDS.items()}},
    "iri": {
        "segment": 50,
        "wheel_tracks": [-0.75, 0.75],
        "moving_average": 0.25,
        "speed_km_h": list(iriedges.SPEED_KM_H),
        "thresholds": {name: list(edge) for name, edge in iriedges.EDGES.items()},
    },
}


@pytest.fixture
def files(tmp_path):
    rng = np.random.default_rng(1)
    s = 50.0 + 0.25 * np.arange(500)
    shards = []
    for first in (0, 5):
        size = (5, s.size)
        names = ("a_x", "a_y", "a_z")
        shard = xr.Dataset({name: (("run", "s"), rng.standard_normal(size).astype(np.float32)) for name in names})
        shard["v_x"] = ("run", "s"), np.full(size, 20.0, np.float32)
        shard["a_v"] = ("run", "s"), rng.uniform(0.2, 0.5, size).astype(np.float32)
        shard["weighted_rms"] = ("run", "axis"), rng.uniform(0.1, 0.4, (5, 3))
        shard["mtvv"] = ("run", "axis"), rng.uniform(0.4, 0.6, (5, 3))
        shard["crest_factor"] = ("run", "axis"), rng.uniform(3, 5, (5, 3))
        shard["vdv"] = ("run", "axis"), rng.uniform(1, 2, (5, 3))
        shard["msdv_z"], shard["duration"] = ("run", rng.uniform(0.1, 1.0, 5)), ("run", np.full(5, 6.25))
        shard = shard.assign_coords(axis=list(names), run=first + np.arange(5), s=s)
        shards.append(tmp_path / f"{first}.nc")
        store.write(shard, shards[-1], title="shard")
    u = np.arange(0, 200, 0.1)
    heights = np.repeat((rng.standard_normal(u.size).cumsum() * 4e-4)[:, None], 3, axis=1)
    road = xr.Dataset({"elevation": (("u", "v"), heights)}, {"u": u, "v": [-1.0, 0.0, 1.0]})
    store.write(road, tmp_path / "road.nc", title="road")
    return tmp_path, shards


@pytest.mark.parametrize(
    "step, dims, variables",
    [
        (thresholds_step, ("axis", "style"), {"a_x", "a_y", "a_z", "lower", "upper", "jerk_critical"}),
        (iso2631, ("band",), {"a_v", "band_lower", "band_upper", "window_mean", "vdv", "msdv_z", "duration"}),
        (iri, ("quality",), {"iri", "iri_full", "v_x", "threshold"}),
    ],
)
def test_a_step_writes_the_comfort_dataset_of_its_method(files, step, dims, variables):
    folder, shards = files
    inputs = {"road": folder / "road.nc"} if step is iri else {}
    step.main(shards=shards, config=CONFIG, output=folder / "out.nc", **inputs)
    found = store.read(folder / "out.nc")
    common = {"window_start", "critical", "exceedance_probability", "critical_count", "critical_share"}
    assert common | variables <= set(found.data_vars)
    assert found["critical"].dims == (*dims, "window") and found.sizes["window"] == 25
    assert found["critical_share"].values == pytest.approx(4.0 * found["critical_count"].values)
    assert found[dims[-1]].long_name.split()[0] in ("driving", "comfort", "class")
    assert found["run"].values.tolist() == list(range(10))
    numbers = [variable for variable in found.data_vars.values() if variable.dtype.kind in "fi"]
    assert all("units" in variable.attrs for variable in numbers)


@pytest.mark.parametrize("step", [thresholds_step, iso2631, iri])
def test_a_road_with_less_than_one_section_left_is_refused_by_the_first_step_that_knows_its_length(files, step):
    folder, shards = files
    for shard in shards:
        store.write(store.read(shard).isel(s=slice(12)), shard, title="shard")
    inputs = {"road": folder / "road.nc"} if step is iri else {}
    with pytest.raises(InputError, match="3 m of road from 50 m on, expected room for one section of 5 m"):
        step.main(shards=shards, config=CONFIG, output=folder / "out.nc", **inputs)


def test_a_truncated_shard_is_named_and_nothing_written(files):
    folder, shards = files
    shards[1].write_bytes(shards[1].read_bytes()[:4000])
    with pytest.raises(InputError, match="5.nc"):
        iso2631.main(shards=shards, config=CONFIG, output=folder / "out.nc")
    assert not (folder / "out.nc").exists()


def test_a_wheel_track_beside_the_road_names_the_road_and_the_setting(files):
    folder, shards = files
    config = {**CONFIG, "iri": {**CONFIG["iri"], "wheel_tracks": [-7, 7]}}
    with pytest.raises(InputError, match=r"road.nc: wheel track at -7 m .*, -1 to 1 m \(comfort: iri: wheel_tracks in config/study.yaml\)"):
        iri.main(shards=shards, road=folder / "road.nc", config=config, output=folder / "out.nc")


def test_sliding_sections_begin_at_every_place(files):
    folder, shards = files
    iso2631.main(shards=shards, config={**CONFIG, "sections": "sliding"}, output=folder / "out.nc")
    assert store.read(folder / "out.nc")["window_start"].values == pytest.approx(50.0 + 0.25 * np.arange(481))


def evaluated(folder, shards):
    """Files of the three methods, by name."""
    found = {}
    for name, step in (("thresholds", thresholds_step), ("iso2631", iso2631), ("iri", iri)):
        found[name] = folder / f"{name}.nc"
        road = {"road": folder / "road.nc"} if step is iri else {}
        step.main(shards=shards, config=CONFIG, output=found[name], **road)
    return found


def test_agreement_of_the_sites_from_their_files(files):
    folder, shards = files
    found = {name: [file, file] for name, file in evaluated(folder, shards).items()}
    samples = xr.Dataset({"lateral_position": ("run", np.arange(10.0))})
    store.write(samples, folder / "samples.nc", title="samples")
    config = {"sites": ["one", "two"], "seed": 1, "label": "severe"}
    agreement.main(**found, samples=[folder / "samples.nc"] * 2, config=config, output=folder / "agreement.nc")
    told = store.read(folder / "agreement.nc")
    assert told["site"].values.tolist() == ["one", "two", "pooled"] and told.attrs["rule"] == "severe"
    assert np.array_equal(told["confusion"].sel(site="one"), told["confusion"].sel(site="two"))
    assert int(told["confusion"].sel(site="pooled", pair="iso2631 - iri").sum()) == 50
    assert undescribed(told) == []


def test_maps_of_a_site_one_a_method(files):
    folder, shards = files
    found = evaluated(folder, shards)
    road = store.read(folder / "road.nc")
    line = road.assign(x=("u", 1000.0 + road["u"].values), y=("u", 0.0 * road["u"].values))
    store.write(line, folder / "line.nc", title="road")
    targets = [folder / f"ts1_{name}.geojson" for name in found]
    config = {"site": "ts1", "probability": 0.1, "label": "middle", "geo_reference": None}
    maps.main(road=folder / "line.nc", **found, config=config, output=targets)
    for target, method in zip(targets, found):
        told = json.loads(target.read_text())
        assert told["name"] == f"ts1 {method}" and "no geo-reference" in told["coordinates_in"]
        for each in told["features"]:
            assert each["properties"]["speed_m_per_s"] == 20.0
            assert each["geometry"]["coordinates"][0][0] == pytest.approx(1000.0 + each["properties"]["start_m"])
    assert any(json.loads(target.read_text())["features"] for target in targets)
    config["geo_reference"] = {"longitude": 15.4, "latitude": 47.1, "rotation_deg": 0}
    maps.main(road=folder / "line.nc", **found, config=config, output=targets)
    told = json.loads(targets[0].read_text())
    assert "coordinates_in" not in told and 15.4 < told["features"][0]["geometry"]["coordinates"][0][0] < 15.5
