"""Each stand-in road, read back from its file, has what the paper publishes of its road."""

import numpy as np
import pytest
import xarray as xr
from scipy.signal import cont2discrete, lfilter, ss2tf, welch

from ridecomfort.road import crg
from ridecomfort.vehicle.driver import speed_profile

SITES = ("ts1", "ts2", "ts3")
TABLE_KM_H = np.array([120, 100, 80, 70, 60, 50, 40, 30, 20, 10])


def golden_car_iri(profile, spacing, segment):
    """IRI in m/km per segment by scipy: ramp-invariant discretisation of the golden car at 80 km/h."""
    c, k1, k2, mu, speed = 6.0, 653.0, 63.3, 0.15, 80 / 3.6
    a = [[0, 1, 0, 0], [-k2, -c, k2, c], [0, 0, 0, 1], [k2 / mu, c / mu, -(k1 + k2) / mu, -c / mu]]
    b, out = np.array([[0], [0], [0], [k1 / mu]]), np.array([[0, 1, 0, -1]])
    ad, bd, cd, dd, _ = cont2discrete((np.array(a), b, out, np.zeros((1, 1))), spacing / speed, method="foh")
    numerator, denominator = ss2tf(ad, bd, cd, dd)
    smooth = np.convolve(np.pad(profile, 1, mode="edge"), np.ones(3) / 3.0, mode="valid")
    level = smooth - smooth[0] - (smooth[110] - smooth[0]) / 110 * np.arange(len(smooth))
    rate = lfilter(numerator[0], denominator, level)
    per = round(segment / spacing)
    return 1000.0 / speed * np.abs(rate[1:]).reshape(-1, per).mean(axis=1)


def window_shares(iri, s, edges, window=5.0):
    """Percent of windows that lie wholly in each class, counted one by one."""
    count = dict.fromkeys("GFMP", 0)
    starts = np.arange(s[0], s[-1] - window + 0.3, window)
    for start in starts:
        inside = (s >= start - 1e-6) & (s < start + window - 1e-6)
        classes = {sum(value >= edge for edge in limits) for value, limits in zip(iri[inside], edges.T[inside])}
        if len(classes) == 1 and (index := classes.pop()) > 0:
            count["GFMP"[index - 1]] += 1
    return {name: 100.0 * number / len(starts) for name, number in count.items()}


@pytest.mark.parametrize("name", SITES)
def test_length_slope_and_curvature_are_the_published_ones(made, published, name):
    road, site = made[name][0], published["sites"][name]
    length = float(road.u[-1] - road.u[0])
    assert length == pytest.approx(1000.0 * site["length_km"])
    assert 100.0 * float(np.abs(road.slope).mean()) == pytest.approx(site["mean_slope_pct"], abs=0.005)
    turned_gon = float(np.abs(np.diff(road.heading)).sum()) * 200.0 / np.pi
    assert turned_gon / (length / 1000.0) == pytest.approx(site["curvature_gon_per_km"], abs=0.05)


def test_settings_aim_at_the_published_classes_and_limits(settings, published):
    for name, site in settings["sites"].items():
        assert site["classes"] == {key: share[name][1] for key, share in published["detections"]["iri"].items()}
        assert site["speed"]["limit_km_h"] == published["sites"][name]["speed_limit_kmh"]
        assert site["speed"]["deviation"] == published["sampling"]["speed_deviation"][name]["normal"][0]


@pytest.mark.parametrize("name", SITES)
def test_shares_of_the_iri_classes_are_the_published_ones(made, settings, published, name):
    """Within one percentage point, by an IRI and a count of windows of this test's own."""
    road, speed = made[name][0], settings["sites"][name]["speed"]
    profile = speed_profile(
        road, limit=100 / 3.6, lateral_acceleration=speed["lateral_acceleration"],
        acceleration=speed["acceleration"], deceleration=speed["deceleration"],
    )  # fmt: skip
    tracks = road.elevation.interp(v=[-0.75, 0.75]).values
    iri = np.mean([golden_car_iri(track, 0.1, 50.0) for track in tracks.T], axis=0)
    length = float(road.u[-1])
    s = np.arange(50.0, length - 25.0 - 0.01, 0.25)
    survey = np.interp(s, np.arange(25.0, length, 50.0), iri)
    slowness = 1.0 / (3.6 * (np.interp(s, road.u, profile) + speed["deviation"]))
    table = published["iri_thresholds"]
    edges = np.array([np.interp(slowness, 1.0 / TABLE_KM_H, table[key]) for key in ("VG", "G", "F", "M")])
    found = window_shares(survey, s, edges)
    for key, share in published["detections"]["iri"].items():
        assert found[key] == pytest.approx(share[name][1], abs=1.0), found


@pytest.mark.parametrize("name", SITES)
def test_the_spectrum_falls_as_that_of_real_roads(made, name):
    road, _ = made[name]
    smooth = (np.cumsum(road.slope.values) * 0.1)[:, None] + road.bank.values[:, None] * road.v.values
    rough = road.elevation.values - smooth
    wavenumber, density = welch(rough[:, ::4], fs=10.0, nperseg=4096, axis=0, detrend="linear")
    inside = (wavenumber > 0.02) & (wavenumber < 2.5)
    exponent, level = np.polyfit(np.log(wavenumber[inside] / 0.1), np.log(density.mean(axis=1)[inside]), 1)
    assert 1.7 < -exponent < 2.5
    assert 1e-6 < np.exp(level) < 64e-6, "class A or the smooth half of B"


@pytest.mark.parametrize("name", SITES)
def test_roughness_changes_along_the_road(made, name):
    _, truth = made[name]
    iri = np.array(truth["segment_iri"])
    assert iri.max() / iri.min() > 2.5
    assert np.ptp(truth["waviness"]) > 0.2
    assert truth["defects"] == sorted(truth["defects"], key=lambda defect: defect["u"])


def test_the_same_seed_gives_the_same_file(make, tmp_path):
    for name in ("once", "twice"):
        road, truth = make(7)
        crg.write(tmp_path / name, road)
    assert (tmp_path / "once").read_bytes() == (tmp_path / "twice").read_bytes()


def test_another_seed_gives_another_road(make):
    one, other = make(7)[0], make(8)[0]
    assert not np.allclose(one.curvature, other.curvature)
    assert not np.allclose(one.elevation.isel(v=20), other.elevation.isel(v=20), atol=1e-3)


def test_any_seed_reaches_the_drawn_levels(make):
    for seed in range(3):
        road, truth = make(seed)
        tracks = road.elevation.interp(v=[-0.75, 0.75]).values.T
        iri = np.mean([golden_car_iri(track, 0.1, 50.0) for track in tracks], axis=0)
        np.testing.assert_allclose(iri, truth["segment_iri"], rtol=0.03)


def test_the_road_is_complete_and_flat_enough_to_be_real(make):
    road, _ = make(1)
    along = {"x", "y", "heading", "curvature", "slope", "bank"}
    assert isinstance(road, xr.Dataset) and set(road.data_vars) == {"elevation", *along}
    assert np.isfinite(road.elevation).all()
    assert np.abs(road.elevation.diff("u")).max() < 0.05
