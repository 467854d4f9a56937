"""From time to space: waves keep their height and place, refusal where a drive cannot be placed."""

import numpy as np
import pytest
import xarray as xr

from ridecomfort.errors import InputError
from ridecomfort.space import along, places

RATE = 100.0


def drives(speeds, length=200.0, pad=0):
    """Drives at constant speed over ``length`` m; a_v is the distance itself, a_z a wave of 8 m."""
    lengths = [int(np.ceil(length / speed * RATE)) + 2 for speed in speeds]
    s = np.full((len(speeds), max(lengths) + pad), np.nan)
    for run, (speed, count) in enumerate(zip(speeds, lengths)):
        s[run, :count] = speed * np.arange(count) / RATE
    return xr.Dataset(
        {
            "s": (("run", "time"), s),
            "a_v": (("run", "time"), s.copy()),
            "a_z": (("run", "time"), np.sin(2 * np.pi * s / 8)),
        },
        coords={"run": np.arange(len(speeds)) + 250, "time": np.arange(s.shape[1]) / RATE},
    )


S = places(0, 200, spacing=0.25, run_in=50, run_out=25)


def test_places_cover_the_evaluated_stretch():
    assert S[0] == 50 and S[-1] == 175 and np.allclose(np.diff(S), 0.25)


def test_places_start_where_the_road_starts():
    assert places(1000, 1200, spacing=0.5, run_in=50, run_out=25)[0] == 1050


def test_a_road_too_short_is_refused():
    with pytest.raises(InputError, match="a road of 70 m, expected more than run_in 50 m and run_out 25 m together"):
        places(0, 70, spacing=0.25, run_in=50, run_out=25)


def test_what_is_linear_in_distance_is_exact():
    result = along(drives([10.0, 27.8, 3.3], pad=7), S, ["a_v", "a_z"])
    assert result["a_v"].dtype == np.float32 and result["a_v"].dims == ("run", "s")
    assert list(result["run"].values) == [250, 251, 252]
    np.testing.assert_allclose(result["a_v"], np.broadcast_to(S, (3, len(S))), rtol=1e-6)


def test_a_wave_keeps_its_place_at_any_speed():
    result = along(drives([10.0, 20.0]), S, ["a_z"])["a_z"].values
    # Ripple of the filter; -45 dB are 6e-3.
    np.testing.assert_allclose(result, np.broadcast_to(np.sin(2 * np.pi * S / 8), result.shape), atol=2e-3)


@pytest.mark.parametrize("frequency", [5.0, 20.0, 35.0])
def test_a_wave_keeps_its_height_between_records(frequency):
    """Straight lines take up to 19 % of the height at 20 Hz where the places lie halfway between records at 100 Hz."""
    moving = drives([24.9])
    wave = lambda s: np.sin(2 * np.pi * frequency * s / 24.9)
    moving["a_z"] = wave(moving["s"])
    result = along(moving, S, ["a_z"])["a_z"].values[0]
    np.testing.assert_allclose(result, wave(S), atol=0.01)


def test_a_run_does_not_depend_on_its_shard():
    together = along(drives([10.0, 27.8]), S, ["a_z"])
    alone = along(drives([27.8]), S, ["a_z"])
    assert np.array_equal(together["a_z"][1], alone["a_z"][0])


def test_a_moment_of_standing_changes_nothing():
    moving = drives([10.0])
    index = np.sort(np.concatenate([np.arange(moving.sizes["time"]), np.full(50, 900)]))
    standing = moving.isel(time=index).assign_coords(time=np.arange(len(index)) / RATE)
    np.testing.assert_array_equal(along(standing, S, ["a_v"])["a_v"], along(moving, S, ["a_v"])["a_v"])
    close = np.abs(S - 90.0) < 1.0
    np.testing.assert_array_equal(along(standing, S[~close], ["a_z"])["a_z"], along(moving, S[~close], ["a_z"])["a_z"])
    np.testing.assert_allclose(along(standing, S, ["a_z"])["a_z"], along(moving, S, ["a_z"])["a_z"], atol=0.02)


def broken(kind):
    bad = drives([10.0, 20.0])
    if kind == "stops":
        bad["s"][1] = np.minimum(bad["s"][1], 80.0)
    elif kind == "backwards":
        bad["s"][1, 500] = bad["s"][1, 499] - 1.0
    elif kind == "gap in s":
        bad["s"][1, 300] = np.nan
    elif kind == "gap in a_v":
        bad["a_v"][1, 300] = np.nan
    else:
        bad["s"][1] = np.nan
    return bad


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("stops", "stopped or left the road"),
        ("backwards", "falls at"),
        ("gap in s", "distance s has a gap"),
        ("gap in a_v", "a_v has a gap"),
        ("empty", "no records"),
    ],
)
def test_a_drive_that_cannot_be_placed_is_refused_by_its_run(kind, said):
    with pytest.raises(InputError, match=said) as problem:
        along(broken(kind), S, ["a_v"])
    assert "run 251" in str(problem.value)
