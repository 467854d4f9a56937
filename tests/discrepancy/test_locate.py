"""An error is found where, at what frequency and under what condition it was put; its power adds up."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import explain, findings, judged, locate
from ridecomfort.drive.sampling import low_pass
from ridecomfort.vocabulary import SIGNALS

from .drives import put_between_1400_and_1600_m


@pytest.fixture(scope="module")
def comparison():
    return put_between_1400_and_1600_m()


@pytest.fixture(scope="module")
def located(comparison):
    return locate.locate(comparison)


def test_the_largest_power_lies_where_the_error_was_put(located):
    signal, stretch, band = np.unravel_index(located["power_share"].values.argmax(), located["power_share"].shape)
    assert SIGNALS[signal] == "a_z"
    assert located["band_lower"][band] <= 11.0 < located["band_upper"][band]
    assert 1300 < located["stretch_start"][stretch] < 1600


def test_power_adds_up_to_the_mean_square(located, comparison):
    """0.8 sin has a mean square of 0.32 while it lasts; what both drives share is no floor, so all of it counts."""
    whole = (located["power_share"] * located["measured_power"].sum("band")).sel(signal="a_z").sum()
    assert float(whole) == pytest.approx(float((comparison["residual"].sel(signal="a_z") ** 2).mean()), rel=0.03)


def test_explainable_shares_of_a_signal_make_one(located):
    assert located["explainable_share"].sel(signal="a_z").sum().item() == pytest.approx(1.0)


def test_the_map_integrates_to_the_mean_square_and_peaks_where_the_error_is(located, comparison):
    one = located["error_map"].sel(signal="a_z")
    step = float(one["frequency_map"][1] - one["frequency_map"][0])
    inside = one.sel(s_map=slice(1440, 1560))
    assert float(inside.mean("s_map").sum() * step) == pytest.approx(0.32, rel=0.05)
    place, frequency = np.unravel_index(np.nanargmax(one.values), one.shape)
    assert 1400 < one["s_map"][place] < 1600 and one["frequency_map"][frequency] == pytest.approx(11.0)


def test_an_error_that_is_even_along_a_drive_is_as_large_at_its_ends_in_the_map():
    """White noise of unit variance at 100 Hz has a density of 0.02; a window reaches 1 s, 25 m, to either side."""
    noise = np.random.default_rng(7).standard_normal((60, 6000))
    places, _, density = locate._map([(0.25 * np.arange(6000), noise)], 100.0, 200)
    mean = density.mean(axis=(0, 2))
    known = np.flatnonzero(np.isfinite(mean))
    assert (places[known[0]], places[known[-1]]) == (40.0, 1460.0)
    np.testing.assert_allclose(mean[known[[0, -1]]], 0.02, rtol=0.05)
    np.testing.assert_allclose(mean[known[1:-1]].mean(), 0.02, rtol=0.02)


def test_a_drive_of_a_few_seconds_beside_repeats_is_located_with_them(comparison):
    three = xr.concat([comparison, comparison.isel(drive=[0]).assign_coords(drive=["short"])], "drive")
    three["s"] = three["s"].where(three["drive"] != "short", three["s"] + 3000.0)
    three["residual"] = three["residual"].where((three["drive"] != "short") | (three["time"] < 3.5))
    found = locate.locate(three)
    assert found.attrs["floor"] and np.isfinite(found["floor_density"]).all()
    assert np.isfinite(found["error_map"]).any("s_map").all()


def test_a_signal_that_is_constant_has_no_share_of_power_and_hides_none_of_the_others(comparison):
    dead = comparison.copy(deep=True)
    dead["measured"].loc[{"signal": "a_x"}] = 0.123456
    found = locate.locate(dead)
    assert found["power_share"].sel(signal="a_x").isnull().all()
    assert [one.words() for one in findings.findings(found)] == [one.words() for one in findings.findings(locate.locate(comparison))]


def test_the_floor_is_what_a_drive_has_of_its_own(comparison):
    rng = np.random.default_rng(3)
    noisy = comparison.copy(deep=True)
    noise = 0.1 * rng.standard_normal(noisy["residual"].shape)
    noisy["residual"] = noisy["residual"] + noise
    found = locate.locate(noisy).sel(signal="a_y")
    expected = 0.01 * (found["band_upper"] - found["band_lower"]) / 50.0
    np.testing.assert_allclose(found["band_floor"], expected, rtol=0.15)
    assert float(found["floor_density"].mean()) == pytest.approx(0.01 / 50.0, rel=0.15)
    assert abs(float(found["power_share"].sum())) < 0.003
    # By chance some bands lie below the floor: none above it is more than all of the error for that.
    bands = found["explainable_share"].sum("stretch").values
    assert bands.min() < 0.0 and bands.max() <= 1.0 and bands[bands > 0.0].sum() == pytest.approx(1.0)


def test_a_floor_that_is_assumed_is_where_each_instrument_tells_anything(comparison):
    """White noise of a density of 0.1 up to 45 and 10 Hz, as the densities of the instruments tell."""
    cut_offs, density, rng = (45.0, 10.0), 0.1, np.random.default_rng(4)
    white = density * np.sqrt(50.0) * rng.standard_normal(comparison["residual"].shape)
    told = np.stack([[low_pass(own.T, 0.01, cut_off).T for own, cut_off in zip(white[0], cut_offs)]])
    floor = density * np.sqrt(np.array(cut_offs)[:, None] - judged.lowest(comparison["signal"].values))
    two = comparison.assign(residual=(comparison["residual"].dims, told), cut_off=("drive", list(cut_offs)), floor_rmse=(("drive", "signal"), floor))
    found = locate.locate(two.assign(e=two["e"] + xr.DataArray([0.0, 2.0], dims="drive")))
    np.testing.assert_allclose(found["band_floor"], found["error_power"].mean("stretch"), rtol=0.2, atol=2e-3)
    highest = found["frequency_map"] > 1.1 * max(cut_offs)
    assert not found["floor_density"].where(highest, 0.0).any() and (found["floor_density"].where(found["frequency_map"] < 9.0, 1.0) > 0.0).all()


def test_the_floor_of_repeats_beside_a_slower_instrument_is_where_each_tells_anything(comparison):
    """White noise in two repeats up to 45 Hz and in a drive 2 m aside up to 8 Hz: no band's error lies below its floor."""
    rng, three = np.random.default_rng(4), comparison.isel(drive=[0, 1, 1]).assign_coords(drive=["one", "two", "three"])
    white = rng.standard_normal(three["residual"].shape)
    white[:, 2] = [low_pass(own.T, 0.01, 8.0).T for own in white[:, 2]]
    aside = three["e"] + xr.DataArray([0.0, 0.0, 2.0], dims="drive")
    found = locate.locate(three.assign(residual=(three["residual"].dims, white), cut_off=("drive", [45.0, 45.0, 8.0]), e=aside))
    np.testing.assert_allclose(found["band_floor"], found["error_power"].mean("stretch"), rtol=0.25)


def test_a_floor_that_is_known_from_another_site_is_there_by_frequency_too(comparison):
    """Noise below 5 Hz of 0.3 and white noise of 0.1: on a site without repeats the first is where it is, not spread."""
    rng, noisy = np.random.default_rng(6), comparison.assign_coords(drive=["one", "two"])
    noise = rng.standard_normal(noisy["residual"].shape)
    slow = np.stack([[low_pass(own.T, 0.01, 5.0).T for own in rng.standard_normal(noise.shape)[0]]])
    noisy = noisy.assign(residual=noisy["residual"] + 0.1 * noise + 0.3 * slow / slow.std())
    known = explain.explain(noisy)
    there = known.merge(locate.locate(known))
    here = explain.explain(noisy.isel(drive=[0]), None, ("ts1", there))
    found = locate.locate(here, elsewhere=there)
    slower = locate.locate(here.assign(cut_off=("drive", [8.0])), elsewhere=there)
    for name, highest in (("band_floor", slower["band_upper"]), ("floor_density", slower["frequency_map"])):
        np.testing.assert_allclose(slower[name], there[name].where(highest <= 8.0, 0.0))
    assert here.attrs["floor"].startswith("from repeats on ts1")
    np.testing.assert_allclose(found["band_floor"], there["band_floor"])
    np.testing.assert_allclose(found["floor_density"], there["floor_density"])
    assert (found["band_floor"].sel(signal="a_z")[0] > 5.0 * locate.locate(here)["band_floor"].sel(signal="a_z")[0]).all()
    assert locate.locate(known, elsewhere=there.assign(band_floor=0.0 * there["band_floor"]))["band_floor"].sum() > 0.0


def test_conditions_are_divided_into_classes_of_equal_duration(located, comparison):
    """Half of the time at 15 m/s, half at 25 m/s; the error was put where it is fast."""
    assert list(located["condition"].values)[0] == "speed"
    level = located["condition_level"].sel(condition="speed").values
    assert level[np.isfinite(level)] == pytest.approx([15.0, 25.0])
    band = int(np.flatnonzero(located["band_lower"] == 8.0)[0])
    slow, fast = located["condition_error"].sel(condition="speed", signal="a_z").isel(band=band).values[np.isfinite(level)]
    # It lasts 200 m of the 1,250 m that are driven at 25 m/s.
    assert fast == pytest.approx(0.32 * 200 / 1250, rel=0.05) and fast > 100 * slow


def test_a_signal_of_the_wrong_sign_is_told_before_all_that_is_found_of_it(comparison, located):
    assert not findings.doubts(located)
    turned = comparison.copy(deep=True)
    turned["residual"].loc[{"signal": "a_y"}] = -1.98 * turned["measured"].sel(signal="a_y")
    assert findings.words(locate.locate(turned))[0] == "a_y runs against the model (correlation -1.00): is its sign right?"


def test_a_signal_that_stands_in_the_column_of_another_is_told_first_too(comparison):
    other = comparison.copy(deep=True)
    other["measured"].loc[{"signal": "a_z"}] = other["measured"].sel(signal="a_y")
    other["residual"].loc[{"signal": "a_z"}] = (other["simulated"].isel(state=0) - other["measured"]).sel(signal="a_z")
    assert findings.words(locate.locate(other))[0].startswith("a_z does what the model does in a_y")


def test_a_signal_in_another_unit_is_told_first_too(comparison):
    """Degrees per second that were read as radians."""
    other = comparison.copy(deep=True)
    other["measured"].loc[{"signal": "pitch_rate"}] *= 57.3
    other["residual"].loc[{"signal": "pitch_rate"}] = (other["simulated"].isel(state=0) - other["measured"]).sel(signal="pitch_rate")
    assert findings.words(locate.locate(other))[0] == "pitch_rate is 57.3 times what the model does: is its unit right?"


def test_the_last_state_is_located_and_another_when_asked_for(comparison, located):
    worse = (comparison[["residual"]] * 2.0).assign_coords(state=["reference"])
    both = comparison.drop_vars("residual").isel(state=[0, 0]).assign_coords(state=["reference", "calibrated"])
    both["residual"] = xr.concat([worse, comparison[["residual"]]], "state")["residual"]
    np.testing.assert_allclose(locate.locate(both)["error_power"], located["error_power"])
    found = locate.locate(both, "reference")
    assert found.attrs["located_state"] == "reference"
    np.testing.assert_allclose(found["error_power"], 4.0 * located["error_power"])


def test_an_error_as_large_as_the_signal_is_all_of_its_power_however_long_each_drive(comparison):
    same = comparison.copy(deep=True)
    same["measured"].loc[{"drive": "two"}] *= 3.0
    same["s"].loc[{"drive": "two"}] *= 1.3  # at another speed, so that it repeats nothing
    same["residual"] = same["measured"].expand_dims(state=["calibrated"]).where(~((same["drive"] == "two") & (same["time"] > 40.0)))
    shares = locate.locate(same)["power_share"].sum(("stretch", "band")).sel(signal="a_z")
    assert float(shares) == pytest.approx(1.0, abs=0.02)
