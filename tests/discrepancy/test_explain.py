"""The explainable error is what repeats share; their noise is the floor."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy.explain import HIGHEST, explain, joined, near_repeats, repeats, too_short
from ridecomfort.discrepancy.judged import LOWEST, LOWEST_OF_DRIVER, band, judged
from ridecomfort.drive.sampling import low_pass

from .coloured import coloured


def comparison(repeats=3):
    rng = np.random.default_rng(1)
    time = np.arange(6000) / 100.0
    common = 2.0 * coloured(rng, 6000)
    noise = np.stack([coloured(rng, 6000) for _ in range(repeats)])
    residual = np.stack([common + noise, 0.5 * common + noise])
    series = (("drive", "time"), np.broadcast_to(20.0 * time, (repeats, 6000)))
    constant = lambda value: series[:1] + (np.full((repeats, 6000), value),)
    return noise, xr.Dataset(
        {"residual": (("state", "drive", "signal", "time"), residual), "s": series, "v_x": constant(20.0), "e": constant(0.0)},
        {"state": ["reference", "calibrated"], "time": time},
    )


def white(compared):
    """The same, its floor a white one up to 45 Hz."""
    frequency = np.arange(LOWEST, 45.0, 0.5)
    density = np.ones((compared.sizes["signal"], frequency.size))
    return compared.assign(floor_density=(("signal", "frequency_map"), density), frequency_map=frequency)


def test_the_floor_is_the_noise_and_three_quarters_are_explained_by_half_the_common_error():
    noise, compared = comparison()
    found = explain(compared)
    assert np.asarray(found["floor_rmse"]).mean() == pytest.approx(judged(noise, 100.0, ["a_z"] * noise.shape[1]).std(axis=-1).mean(), rel=0.06)
    assert float(found["explained_share"].sel(state="calibrated").mean()) == pytest.approx(0.75, abs=0.06)
    assert found.attrs["floor"] == "from repeats"


@pytest.mark.parametrize("loud", [(1.0, 1.0), (0.5, 1.5), (0.5, 1.0, 1.5)])
def test_noise_is_not_explainable_though_one_repeat_has_more_of_it_than_another(loud):
    shares = []
    for seed in range(4):
        rng, (_, found) = np.random.default_rng(seed), comparison(len(loud))
        noise = np.stack([size * coloured(rng, 6000) for size in loud])
        found = explain(found.isel(state=[0]).assign(residual=(("state", "drive", "signal", "time"), noise[None])))
        floor, above = ((found[name].values ** 2).reshape(-1, found.sizes["drive"], found.sizes["signal"]).mean(axis=(0, 1))
                        for name in ("floor_rmse", "explainable_rmse"))  # fmt: skip
        shares.append(np.mean(above / (above + floor)))
    assert np.mean(shares) < 0.03


def test_what_one_of_two_repeats_does_not_record_is_not_the_others_noise():
    """An error of 0.3 that both share, noise of 0.05, both white up to 50 Hz, and an instrument that records up to 20 Hz alone."""
    random = np.random.default_rng(2)
    compared = comparison(repeats=2)[1].isel(state=[0], signal=[0])
    noise = 0.05 * random.standard_normal((2, 6000))
    residual = 0.3 * random.standard_normal(6000) + noise
    residual[1] = low_pass(residual[1, :, None], 0.01, 20.0)[:, 0]
    compared = compared.assign(residual=(compared["residual"].dims, residual[None, :, None]), cut_off=("drive", [45.0, 20.0]))
    up_to_both = band(judged(noise, 100.0, ["a_z"]), 100.0, (0.0, HIGHEST * 20.0))
    assert explain(compared)["floor_rmse"].values.ravel() == pytest.approx(2 * [up_to_both.std()], rel=0.1)


def test_what_a_slower_instrument_does_not_tell_is_known_from_the_others_all_the_same():
    compared = comparison()[1].copy(deep=True)
    residual = compared["residual"].values
    residual[:, 2] = [low_pass(own.T, 0.01, 8.0).T for own in residual[:, 2]]
    compared = compared.assign(cut_off=("drive", [45.0, 45.0, 8.0]))
    found, alone = explain(compared), explain(compared.isel(drive=[0, 1]))
    np.testing.assert_allclose(found["floor_rmse"][:2], alone["floor_rmse"])
    assert (found["floor_rmse"][2] > 0.0).all()


@pytest.mark.parametrize(("cut_offs", "up_to"), [((45.0, 30.0, 8.0), 30.0), ((45.0, 44.4, 8.0), 44.4)])
def test_what_none_tells_as_much_of_is_known_as_far_as_the_next_one_tells(cut_offs, up_to):
    """White noise and an error that all share, in three repeats by instruments of unlike cut-offs."""
    random = np.random.default_rng(3)
    compared = comparison()[1].isel(state=[0], signal=[0])
    noise = 0.05 * random.standard_normal((3, 6000))
    residual = 0.1 * random.standard_normal(6000) + noise
    residual = np.stack([low_pass(own[:, None], 0.01, cut_off)[:, 0] for own, cut_off in zip(residual, cut_offs)])
    compared = compared.assign(residual=(compared["residual"].dims, residual[None, :, None]), cut_off=("drive", list(cut_offs)))
    known = band(judged(noise, 100.0, ["a_z"]), 100.0, (0.0, HIGHEST * up_to))
    assert explain(compared)["floor_rmse"].values[:2, 0] == pytest.approx(2 * [known.std()], rel=0.1)


def test_noise_that_a_drive_beside_repeats_does_not_record_is_no_floor_of_it():
    """White noise and an error, up to 45 Hz in two repeats and up to 8 Hz in a drive 2 m aside of them, or on another site."""
    random = np.random.default_rng(3)
    compared = comparison()[1].isel(state=[0], signal=[0]).assign_coords(signal=["a_z"])
    noise = 0.05 * random.standard_normal((3, 6000))
    residual = 0.1 * random.standard_normal(6000) + noise
    residual[2] = low_pass(residual[2, :, None], 0.01, 8.0)[:, 0]
    aside = compared["e"] + xr.DataArray([0.0, 0.0, 2.0], dims="drive")
    compared = compared.assign(residual=(compared["residual"].dims, residual[None, :, None]), cut_off=("drive", [45.0, 45.0, 8.0]), e=aside)
    known = band(judged(noise, 100.0, ["a_z"]), 100.0, (0.0, 8.0)).std()
    other = explain(compared.isel(drive=[2]), elsewhere=("alpha", white(explain(compared.isel(drive=[0, 1])))))
    for found in (explain(compared)["floor_rmse"][2, 0], other["floor_rmse"][0, 0]):
        assert float(found) == pytest.approx(known, rel=0.1)


def test_a_drive_beside_repeats_has_the_floor_of_those_that_tell_as_much_as_it_does():
    """White noise and an error, up to 45 Hz in two of three repeats, up to 8 Hz in the third, and up to 45 Hz in a drive 2 m aside of them."""
    random = np.random.default_rng(3)
    compared = comparison(repeats=4)[1].isel(state=[0], signal=[0]).assign_coords(signal=["a_z"])
    noise = 0.05 * random.standard_normal((4, 6000))
    residual = 0.1 * random.standard_normal(6000) + noise
    residual[2] = low_pass(residual[2, :, None], 0.01, 8.0)[:, 0]
    aside = compared["e"] + xr.DataArray([0.0, 0.0, 0.0, 2.0], dims="drive")
    compared = compared.assign(residual=(compared["residual"].dims, residual[None, :, None]), cut_off=("drive", [45.0, 45.0, 8.0, 45.0]), e=aside)
    found = explain(compared)["floor_rmse"].values[:, 0]
    assert found[3] == pytest.approx(judged(noise, 100.0, ["a_z"])[3].std(), rel=0.05)


def test_a_drive_that_is_hardly_compared_is_told():
    compared = comparison()[1].assign_coords(drive=["first", "second", "third"])
    assert too_short(compared) == []
    compared["residual"][:, 1, :, 320:] = np.nan
    assert too_short(compared) == ["second is compared for 3.2 s only, which tells little (expected 10 s at least)"]


def test_a_short_repeat_leaves_the_floors_of_the_others_as_they_are():
    """Behind 600 m of 1,200 noise is three times and what is shared five times as large; the third of three repeats ends there."""
    _, compared = comparison()
    behind = (compared["s"] > 600.0).isel(drive=0).values
    random = np.random.default_rng(4)
    noise = np.stack([coloured(random, 6000) for _ in range(3)]) * np.where(behind, 3.0, 1.0)
    residual = noise + 2.0 * coloured(random, 6000) * np.where(behind, 5.0, 1.0)
    residual[2, :, behind] = np.nan
    dims = compared["residual"].dims
    found = explain(compared.isel(state=[0]).assign(residual=(dims, residual[None])))["floor_rmse"].values
    true = [judged(own[:, :n], 100.0, ["a_z"] * noise.shape[1]).std(axis=-1) for own, n in zip(noise, (6000, 6000, 3000))]
    assert np.mean(found / true, axis=1) == pytest.approx(np.ones(3), abs=0.15)


def test_the_squares_by_stretch_are_parts_of_the_whole():
    found = explain(comparison()[1])
    whole = found["explainable_rmse"] ** 2 + found["floor_rmse"] ** 2
    assert found.sizes["stretch_of_road"] > 3
    np.testing.assert_allclose(found["square_by_stretch"].mean("stretch_of_road"), whole.transpose("state", "drive", "signal"), rtol=0.05)


def test_a_stretch_is_the_same_road_for_drives_at_any_speed():
    """At 20 and 10 m/s from 30 m on: an error between 300 and 400 m stands in the same stretch of both; ends that are not covered are empty."""
    time = np.arange(6000) / 100.0
    s = np.stack([30.0 + 20.0 * time, 30.0 + 10.0 * time])
    wave = np.sin(2 * np.pi * 5.0 * time)
    residual = np.where((s > 300.0) & (s < 400.0), wave, 1e-3 * wave)[None, :, None]
    over = lambda values: (("drive", "time"), values)
    compared = xr.Dataset(
        {"residual": (("state", "drive", "signal", "time"), residual), "s": over(s), "e": over(np.zeros_like(s))},
        {"state": ["reference"], "signal": ["a_z"], "time": time},
    )
    square = explain(compared)["square_by_stretch"].values[0, :, 0]
    assert np.nanargmax(square, axis=1).tolist() == [3, 3]
    assert np.isnan(square[:, 0]).all() and np.isfinite(square[0, 1:12]).all() and np.isnan(square[1, 7:]).all()


def test_without_repeats_the_floor_is_said_to_be_taken_as_nil():
    found = explain(comparison(repeats=1)[1])
    assert "nil" in found.attrs["floor"] and float(found["floor_rmse"].max()) == 0.0


def test_without_repeats_it_may_be_assumed_from_the_instruments():
    """White noise of a density d from 0.8 to 50 Hz has a mean square of 49.2 d^2; the error is larger than that."""
    compared = comparison(repeats=1)[1].isel(signal=[0, 1]).assign_coords(drive=["one"], signal=["a_z", "roll_rate"])
    found = explain(compared, {"one": {"accelerometer": 0.01, "gyroscope": 0.002}})
    assert found["floor_rmse"].values.ravel() == pytest.approx([0.01 * np.sqrt(49.2), 0.002 * np.sqrt(49.2)], rel=0.01)
    assert "assumed from the noise densities" in found.attrs["floor"] and "no drive was repeated" in found.attrs["floor"]


@pytest.mark.parametrize(("cut_off", "bandwidth"), [(20.0, 19.2), (45.0, 44.2)])
def test_noise_that_was_low_passed_away_is_no_floor(cut_off, bandwidth):
    """As left of noise of a density d by an instrument of 50 or 100 Hz, its records low-passed below half of that."""
    compared = comparison(repeats=1)[1].isel(signal=[0, 1]).assign_coords(drive=["one"], signal=["a_z", "a_x"])
    compared = compared.assign(cut_off=("drive", [cut_off]))
    found = explain(compared, {"one": {"accelerometer": 0.01, "gyroscope": 0.002}})
    expected = 0.01 * np.sqrt([bandwidth, bandwidth - LOWEST_OF_DRIVER["a_x"] + LOWEST])
    assert found["floor_rmse"].values.ravel() == pytest.approx(expected, rel=0.01)


def test_a_density_that_is_told_of_one_drive_is_that_of_another_as_far_as_that_records():
    compared = comparison(repeats=2)[1].isel(signal=[0]).assign_coords(drive=["one", "two"], signal=["a_z"])
    compared = compared.assign(cut_off=("drive", [40.0, 10.0]), e=compared["e"] + xr.DataArray([0.0, 2.0], dims="drive"))
    found = explain(compared, {"one": {"accelerometer": 0.01}})
    assert found["floor_rmse"].values.ravel() == pytest.approx(0.01 * np.sqrt([40.0 - LOWEST, 10.0 - LOWEST]), rel=0.01)


def test_on_another_road_the_floor_is_that_of_the_repeats_on_which_the_vehicle_is_calibrated():
    compared = comparison()[1]
    compared = compared.assign_coords(signal=["a_z", "roll_rate", "pitch_rate", "a_y"][: compared.sizes["signal"]])
    there, here = white(explain(compared)), compared.isel(drive=[0])
    found = explain(here, elsewhere=("alpha", there))
    assert found["floor_rmse"].values[0] == pytest.approx(np.sqrt((there["floor_rmse"] ** 2).mean("drive").values))
    assert found.attrs["floor"].startswith("from repeats on alpha")
    # Its own noise densities and repeats are nearer, and a site without repeats knows nothing either.
    named = here.isel(signal=[0]).assign_coords(drive=["one"])
    known = explain(named, {"one": {"accelerometer": 0.01, "gyroscope": 0.002}}, ("alpha", there))
    assert "assumed from the noise densities" in known.attrs["floor"]
    assert explain(compared, elsewhere=("alpha", there)).attrs["floor"] == "from repeats"
    assert "nil" in explain(here, elsewhere=("alpha", white(explain(here)))).attrs["floor"]


def test_densities_of_no_drive_that_is_compared_are_not_known():
    compared = comparison(repeats=1)[1].isel(signal=[0]).assign_coords(drive=["one"], signal=["a_z"])
    assert "nil" in explain(compared, {"another": {"accelerometer": 0.01}}).attrs["floor"]


def test_what_lies_before_the_run_in_makes_no_repeats():
    """From 0 to 600 m and from 500 to 1,100 m, of the second of which the first 100 m are not compared."""
    compared = comparison(repeats=2)[1].isel(time=slice(0, 3000)).copy(deep=True)
    compared["s"] = compared["s"] + xr.DataArray([0.0, 290.0], dims="drive")
    assert repeats(compared) == [[0, 1]]
    compared["residual"] = compared["residual"].where((compared["s"] < 300) | (compared["s"] > 600))
    assert repeats(compared) == []


def test_drives_that_differ_in_speed_elsewhere_repeat_one_another_where_both_drove():
    """Both at 20 m/s for 600 m; one goes on at 10 m/s."""
    compared = comparison(repeats=2)[1].copy(deep=True)
    slower = compared["s"].values.copy()
    slower[1, 3000:] = slower[1, 3000] + 10.0 * (compared["time"].values[3000:] - 30.0)
    kept = compared["residual"].where((xr.DataArray([0, 1], dims="drive") == 1) | (compared["s"] < 600))
    assert repeats(compared.assign(s=(("drive", "time"), slower), residual=kept)) == [[0, 1]]


@pytest.mark.parametrize(("change", "found"), [(0.03, [[0, 1]]), (0.25, [])])
def test_drives_of_one_mean_speed_repeat_one_another_only_where_they_are_as_fast_all_along(change, found):
    """At 20 m/s all along, and slower at first than at last by so much of it."""
    compared = comparison(repeats=2)[1].copy(deep=True)
    place, time = compared["s"].values.copy(), compared["time"].values
    share = (time - time[0]) / np.ptp(time)
    place[1] = place[1, 0] + np.ptp(place[1]) * ((1.0 - change) * share + change * share**2)
    assert repeats(compared.assign(s=(("drive", "time"), place))) == found


PACE = "mean speeds 8.3 % apart (5 % at most) and speeds over stretches of the road 8.3 % apart (8 % at most)"
PATH, SENSORS = "paths 0.304 m apart (0.3 m at most)", "sensors 0.200 m apart (0.05 m at most)"


@pytest.mark.parametrize(
    ("slower", "aside", "ahead", "said"),
    [
        (0.0, 0.0, 0.0, ""),
        (0.08, 0.0, 0.0, PACE),
        (0.0, 0.304, 0.0, PATH),
        (0.08, 0.304, 0.2, f"{PACE} and {PATH} and {SENSORS}"),
        (0.3, 0.304, 0.0, ""),
    ],
)
def test_what_keeps_a_drive_from_repeating_another_is_told(slower, aside, ahead, said):
    compared = comparison(repeats=2)[1].assign_coords(drive=["one", "two"])
    place = compared["s"].values.copy()
    place[1] = place[1, 0] + (1.0 - slower) * (place[1] - place[1, 0])
    sensors = {"sensor_x": ("drive", [0.0, ahead]), "sensor_y": ("drive", np.zeros(2)), "sensor_z": ("drive", np.zeros(2))}
    moved = compared.assign(s=(("drive", "time"), place), e=compared["e"] + xr.DataArray([0.0, aside], dims="drive"), **sensors)
    assert near_repeats(moved) == ([f"two is no repeat of one: {said}"] if said else [])


def test_of_a_drive_that_repeats_one_but_not_the_other_it_is_told_which_it_does_not():
    """At 20, 20.8 and 19.2 m/s."""
    compared = comparison(repeats=3)[1].assign_coords(drive=["one", "two", "three"])
    factor = xr.DataArray([1.0, 1.04, 0.96], dims="drive")
    start = compared["s"].isel(time=0)
    moved = compared.assign(s=start + factor * (compared["s"] - start))
    assert repeats(moved) == [[0, 1]]
    assert near_repeats(moved) == ["three is no repeat of two: mean speeds 8.0 % apart (5 % at most) and speeds over stretches of the road 8.0 % apart (8 % at most)"]


def test_of_a_drive_that_repeats_one_where_the_other_ended_it_is_told_that_it_counts_as_none():
    """From 0 to 600 m, to 1,200 m, and from 600 m on."""
    compared = comparison(repeats=3)[1].assign_coords(drive=["one", "two", "three"])
    which = xr.DataArray([0, 1, 2], dims="drive")
    driven = ((which != 0) | (compared["s"] < 600.0)) & ((which != 2) | (compared["s"] > 600.0))
    parts = compared.assign(residual=compared["residual"].where(driven))
    assert repeats(parts) == [[0, 1]]
    assert near_repeats(parts) == ["three repeats two, but hardly any of the way that all of its repeats drove: it counts as no repeat"]


def test_of_a_drive_that_hardly_meets_those_it_repeats_that_is_told_whatever_else_is_near():
    """The same behind a drive that is 12 % slower."""
    compared = comparison(repeats=4)[1].assign_coords(drive=["slower", "one", "two", "three"])
    which, start = xr.DataArray(range(4), dims="drive"), compared["s"].isel(time=0)
    compared = compared.assign(s=(start + xr.DataArray([0.88, 1.0, 1.0, 1.0], dims="drive") * (compared["s"] - start)).transpose(*compared["s"].dims))
    driven = ((which != 1) | (compared["s"] < 600.0)) & ((which != 3) | (compared["s"] > 600.0))
    said = near_repeats(compared.assign(residual=compared["residual"].where(driven)))
    assert said[-1] == "three repeats two, but hardly any of the way that all of its repeats drove: it counts as no repeat"


def test_repeats_know_better_than_a_data_sheet():
    compared = comparison()[1].assign_coords(drive=["one", "two", "three"])
    found = explain(compared, {"one": {"accelerometer": 10.0, "gyroscope": 10.0}})
    assert found.attrs["floor"] == "from repeats"


def test_errors_that_are_slower_than_the_vehicle_are_not_its_to_explain():
    compared = comparison()[1]
    slow = compared.copy(deep=True)
    slow["residual"] = slow["residual"] + 5.0 * np.sin(2 * np.pi * 0.2 * slow["time"])
    for name in ("floor_rmse", "explainable_rmse"):
        np.testing.assert_allclose(explain(slow)[name], explain(compared)[name], rtol=0.01)


def test_drives_at_one_speed_on_other_stretches_repeat_nothing():
    """Nor do those that have less than half of the shorter one in common."""
    compared = comparison(repeats=2)[1]
    for apart, floor in ((2000.0, "nil"), (800.0, "nil"), (200.0, "from repeats")):
        moved = compared.copy(deep=True)
        moved["s"] = moved["s"] + xr.DataArray([0.0, apart], dims="drive")
        assert floor in explain(moved).attrs["floor"]


def test_drives_on_other_tracks_repeat_nothing():
    """Their wheels meet another road: what a model of it gets wrong differs, too, and is no noise."""
    compared = comparison(repeats=2)[1]
    for apart, floor in ((0.1, "from repeats"), (0.25, "from repeats"), (0.5, "nil"), (3.5, "nil")):
        moved = compared.assign(e=compared["e"] + xr.DataArray([0.0, apart], dims="drive"))
        assert floor in explain(moved).attrs["floor"]
    weaving = compared.assign(e=compared["e"] + 0.3 * np.sin(compared["s"] / 30.0) * xr.DataArray([-1.0, 1.0], dims="drive"))
    assert "nil" in explain(weaving).attrs["floor"]


def test_drives_with_instruments_at_different_places_repeat_nothing():
    """Of a body that pitches they record other accelerations, so that other errors of the model would pass for noise."""
    compared = comparison(repeats=3)[1].assign({f"sensor_{axis}": ("drive", np.zeros(3)) for axis in "yz"})
    for ahead, found in (([0.0, 0.02, -0.02], [[0, 1, 2]]), ([0.0, 0.3, 0.0], [[0, 2]]), ([0.0, 0.3, 0.6], [])):
        assert repeats(compared.assign(sensor_x=("drive", ahead))) == found


def test_drives_that_repeat_one_another_all_have_a_stretch_in_common():
    """The third has all of its own in common with the first, but hardly anything with both others."""
    passages, numbers = [], []
    for start, end in ((0.0, 2000.0), (0.0, 1020.0), (1000.0, 2000.0)):
        numbers.append(joined(passages, np.linspace(start, end, 101), np.linspace(0.0, (end - start) / 20.0, 101), np.zeros(101)))
    assert numbers == [0, 0, 1]
    assert [(passage.speed, passage.start, passage.end) for passage in passages] == [(20.0, 0.0, 1020.0), (20.0, 1000.0, 2000.0)]


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1), (2, 1, 0), (1, 0, 2)])
def test_beside_a_short_repeat_drives_at_other_speeds_elsewhere_repeat_nothing_whatever_their_order(order):
    """The first at 20 m/s, the third at 14 m/s but for 300 m, in which the second drove its 200 m as they both did."""
    slow = np.array([14.0] * 30 + [20.0] * 30 + [14.0] * 60)
    driven = {0: (0.0, np.full(120, 20.0)), 1: (320.0, np.full(20, 20.0)), 2: (0.0, slow)}
    passages, numbers = [], {}
    for which in order:
        start, speeds = driven[which]
        place = start + np.concatenate([[0.0], np.cumsum(np.full(speeds.size, 10.0))])
        time = np.concatenate([[0.0], np.cumsum(10.0 / speeds)])
        numbers[which] = joined(passages, place, time, np.zeros(place.size))
    assert numbers[0] != numbers[2] and numbers[1] in (numbers[0], numbers[2])
