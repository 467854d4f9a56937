"""What alignment refuses, and what it tells of a drive with what to change."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ridecomfort.drive import align, record, replay
from ridecomfort.errors import InputError
from ridecomfort.vocabulary import SIGNALS
from tests import quarter_cars
from tests.quarter_cars import LATERAL, aligned, driven, turned


@pytest.mark.parametrize("clock", [0.7, -2.0])
@pytest.mark.parametrize("told", [{}, {"lateral_position": 1.8}], ids=["unknown path", "known path"])
def test_a_clock_beyond_the_search_is_refused_with_what_it_is(lanes, nominal, clock, told):
    road, drive = lanes
    with pytest.raises(InputError, match=r"drive own: the inertial signals lag (\S+) s behind s \(expected within 0.5 s") as refused:
        aligned(quarter_cars.recorded(drive, clock=clock, noise=1.0, name="own", **told), road, nominal)
    assert float(str(refused.value).split(" lag ")[1].split()[0]) == pytest.approx(clock, abs=0.02)
    assert "\n" not in str(refused.value) and "alignment: search" in str(refused.value)


def test_a_path_farther_from_what_is_told_than_is_searched_is_refused(lanes, nominal):
    road, drive = lanes
    words = r"drive own: its path fits the road best \+1.80 m to the left of what is recorded or told.*lateral_position"
    with pytest.raises(InputError, match=words):
        aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=0.0, name="own"), road, nominal)


@pytest.mark.parametrize("told", [-15.0, -3.2, 3.0, 3.2, 15.0])
@pytest.mark.parametrize("is_recorded", [False, True])
def test_a_path_that_lies_off_the_road_is_refused_however_far(drive, road, nominal, told, is_recorded):
    """Half the vehicle keeps on this road from 1.1 m to the right to 1.1 m to the left of its middle."""
    recorded = quarter_cars.recorded(drive, name="own", lateral_position=np.nan if is_recorded else told)
    if is_recorded:
        recorded["e"] = recorded["e"].copy(data=np.where(recorded["time"] < 5.0, 0.0, told))
    with pytest.raises(InputError, match=rf"^drive own: its path, as recorded or told, lies .*[+-]{abs(told):.2f} .*m to the left .*expected -1.10 to \+1.10 m"):
        aligned(recorded, road, nominal)


@pytest.mark.parametrize("scale", [1.0, np.pi / 180.0])
def test_a_drive_that_is_refused_names_signals_in_another_unit(lanes, nominal, scale):
    """A roll rate in rad/s, told as deg/s, shows of its road as little as one on a wrong path."""
    road, drive = lanes
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=0.0, name="own")
    recorded["roll_rate"] = recorded["roll_rate"] * scale
    with pytest.raises(InputError, match="drive own: ") as refused:
        aligned(recorded, road, nominal)
    named = [part.split()[0] for part in str(refused.value).split("; ")[1:] if part.endswith("is its unit right?")]
    assert named == (["roll_rate"] if scale < 1.0 else [])


def test_a_path_at_the_edge_of_the_grid_is_refused(lanes, nominal):
    """A grid on which the path may lie up to 1.7 m to the left."""
    road, drive = lanes
    narrow = road.sel(v=slice(-2.65, 2.65))
    with pytest.raises(InputError, match=r"drive own: its path fits the road best .* at an end of what is searched or beyond"):
        aligned(quarter_cars.recorded(drive, noise=1.0, name="own"), narrow, nominal)


def test_a_drive_on_another_road_is_refused(drive, nominal):
    with pytest.raises(InputError, match=r"drive own: model and record agree nowhere .* \(expected 0.3 or more.*lateral_position"):
        aligned(quarter_cars.recorded(drive, noise=1.0, name="own"), quarter_cars.road(length=560.0, seed=8), nominal)


def test_a_place_that_no_round_settles_is_told(road, truth, nominal, monkeypatch):
    recorded = quarter_cars.recorded(driven(road, truth, along=0.5), noise=1.0, lateral_position=LATERAL)
    monkeypatch.setattr(align, "MOST", align.PASSES)
    (said,) = aligned(recorded, road, nominal).attrs["faults"].split("; ")
    assert said.startswith("alignment does not settle: its last round moved the place by 0.") and "is s good to 0.5 m" in said


@pytest.mark.parametrize(("longer", "said"), [(1.0, ""), (1.01, "s: runs 1.0 % too far over the road"), (0.985, "s: runs 1.5 % too short over the road")])
def test_an_odometer_that_is_told_for_a_place_on_the_road_is_called_one(drive, road, nominal, longer, said):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive.assign(s=start + longer * (drive["s"] - start)), noise=1.0, lateral_position=LATERAL)
    found = aligned(recorded.assign_attrs(faults="a_z: it clips"), road, nominal)
    before, *after = found.attrs["faults"].split("; ")
    assert before == "a_z: it clips" and len(after) == bool(said)
    for words in after:
        told = float(words.split()[2])
        assert words.startswith(f"s: runs {told} % too {said.split()[5]} over the road") and told == pytest.approx(float(said.split()[2]), abs=0.15)


def test_an_odometer_that_is_refused_for_its_clock_or_place_is_called_one_before(drive, road, nominal):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive.assign(s=start + 0.97 * (drive["s"] - start)), noise=1.0, lateral_position=LATERAL, name="own")
    words = rf"^drive own: s: runs [23].\d % too short over the road.* distance_start: {start:.0f}: .*; if not, (?!drive own)"
    with pytest.raises(InputError, match=words) as refused:
        aligned(recorded, road, nominal)
    assert "\n" not in str(refused.value)


def test_rates_of_the_wrong_sign_are_no_odometer(drive, road, nominal):
    """The distance is exact: scaled, it would agree with the road still less."""
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL)
    found = aligned(recorded.assign({name: -recorded[name] for name in ("roll_rate", "pitch_rate")}), road, nominal)
    assert "odometer" not in found.attrs["faults"]
    np.testing.assert_allclose(found["s"], drive["s"].values[: found.sizes["time"]], atol=0.1)


def odometer(drive, speed=True, late=0):
    """A drive whose distance runs 1.2 % too far, with or without a speed beside it, and comes so many samples late."""
    start, time = float(drive["s"][0]), drive["time"].values
    recorded = quarter_cars.recorded(drive, noise=1.0)
    told = {name: (time, recorded[name].values) for name in (*SIGNALS, "v_x")[: len(SIGNALS) + speed]}
    return record.from_arrays(told | {"s": (time[late:], start + 1.012 * (drive["s"].values[late:] - start))}, lateral_position=LATERAL)


def test_an_odometer_without_a_speed_beside_it_is_not_to_be_left_out_but_to_tell_the_speed(drive, road, nominal):
    said = aligned(odometer(drive, speed=False), road, nominal).attrs["faults"]
    assert "as that of an odometer (give its slope as v_x in its place, with distance_start: 60: " in said


def test_where_to_begin_without_s_is_where_the_record_begins_not_its_distance(drive, road, nominal):
    said = aligned(odometer(drive, late=300), road, nominal).attrs["faults"]
    told = float(said.split("distance_start: ")[1].split(":")[0])
    assert "(leave s out, with distance_start" in said and told == pytest.approx(float(drive["s"][0]), abs=2.5)  # 60 m more after 3 s


def test_an_instrument_that_no_round_turns_back_is_told(drive, road, nominal, monkeypatch):
    monkeypatch.setattr(align, "MOST", align.PASSES)
    said = aligned(turned(drive, 40.0), road, nominal).attrs["faults"].split("; ")[0]
    assert re.fullmatch(r"alignment does not settle: its last round turned the instrument by 1\d\.\d deg: are the axes .* right\?", said)


@pytest.mark.parametrize(
    ("degrees", "columns"), [(90, "a_x = -a_y, a_y = a_x, "), (-90, "a_x = a_y, a_y = -a_x, "), (180, "a_x = -a_x, a_y = -a_y, ")]
)
def test_axes_that_are_exchanged_are_told_with_what_to_change(drive, road, nominal, degrees, columns):
    (said,) = aligned(turned(drive, degrees), road, nominal).attrs["faults"].split("; ")
    assert said.startswith(f"the instrument looks turned by {degrees:+d} deg in yaw") and columns in said


@pytest.mark.parametrize(("angles", "said"), [((0, 0, 0), ""), ((0, 0, 25), "yaw"), ((0, 0, 40), "yaw"), ((0, 20, 0), "pitch"), ((20, 0, 0), "roll")])
@pytest.mark.parametrize("seed", [1, 2])
def test_an_instrument_that_is_turned_is_told_where_gravity_turns_none_back(truth, nominal, seed, angles, said):
    road = quarter_cars.road(length=560.0, seed=seed)
    drive, rng = driven(road, truth), np.random.default_rng(seed)
    back = Rotation.from_euler("xyz", angles, degrees=True).inv().as_matrix()
    rows = [back @ np.stack([drive[name].values for name in part]) for part in (SIGNALS[:3], SIGNALS[3:])]
    noise = np.array([0.02] * 3 + [0.001] * 3)[:, None] * rng.standard_normal((6, drive.sizes["time"]))
    given = dict(zip(SIGNALS, np.concatenate(rows) + noise)) | {name: drive[name].values for name in ("s", "v_x")}
    quantities = {name: (drive["time"].values, values) for name, values in given.items()}
    faults = aligned(record.from_arrays(quantities, gravity=False, lateral_position=LATERAL), road, nominal).attrs["faults"]
    assert faults.startswith(f"the instrument looks turned in {said} by 8 deg or more") if said else faults == ""


def test_axes_that_are_exchanged_are_told_where_a_drive_is_refused(truth, nominal):
    road = quarter_cars.road(length=560.0, seed=3)
    with pytest.raises(InputError, match=r"agree nowhere .*; the instrument looks turned by \+180 deg in yaw: .*, pitch_rate = -pitch_rate\)$"):
        aligned(turned(driven(road, truth), 180.0), road, nominal)


def test_a_drive_without_a_place_that_begins_elsewhere_is_asked_where_it_begins(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, place=False, noise=1.0, lateral_position=LATERAL)
    with pytest.raises(InputError, match=r"agree nowhere .* are the axes and signs right, and distance_start \(0 m unless given\) to 15 m\?"):
        aligned(recorded, road, nominal)


def test_a_drive_that_goes_on_behind_the_road_is_refused_by_its_way(whole, road, nominal):
    recorded = quarter_cars.recorded(whole, place=False, lateral_position=LATERAL)
    with pytest.raises(InputError, match=r"its centre of gravity runs from s = -?0.0 to 5\d\d.\d m by v_x \(expected within the road, 0.0 to 450.0 m\)"):
        aligned(recorded, road.sel(u=slice(0, 450)), nominal)


def test_a_drive_against_the_reference_line_is_called_that(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, name="back")
    with pytest.raises(InputError, match="^drive back: s falls from .* driven against the reference line"):
        aligned(recorded.assign(s=600 - recorded["s"]), road, nominal)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.assign(v_x=d["v_x"].where(d["time"] < 10, 0.2)), r"by v_x at (9|10).* \(expected above 1 m/s"),
        (lambda d: d.assign(s=d["s"].where(d["time"] < 10, d["s"].values[1000])), r"by s, \d+\.\d+ m/s by v_x at 1[01].* \(expected above 1 m/s"),
        (lambda d: d.assign(s=d["s"] + 300), "within the road"),
        (lambda d: d.assign(s=600 - d["s"]), "s falls from 5.* to .* m: driven against the reference line, which is not supported"),
    ],
)
def test_a_drive_that_cannot_be_driven_again_is_refused(drive, road, change, words):
    recorded = quarter_cars.recorded(drive, name="morning")
    with pytest.raises(InputError, match=words) as problem:
        replay.replay(change(recorded), road, quarter_cars.run)
    assert "drive morning" in str(problem.value)


@pytest.mark.parametrize(
    ("last", "turned", "asked"),
    [
        ((0.05, 0.0), 0.0, "is s good to 0.5 m (if not, leave s out, with distance_start: it is then integrated from v_x)?"),
        ((0.0, 0.05), 0.0, "was it driven parallel to the reference line (if not, record e)?"),
        ((0.0, 0.0), 0.02, "are the axes of accelerations and rates right?"),
    ],
)
def test_what_does_not_settle_is_asked_for(drive, last, turned, asked):
    recorded = quarter_cars.recorded(drive)
    assert align._unsettled(recorded, last, turned).endswith(f": {asked}")


def test_a_recorded_path_that_does_not_settle_is_asked_for_its_unit(drive):
    said = align._unsettled(quarter_cars.recorded(drive).assign(e=("time", drive["e"].values)), (0.0, 0.05), 0.0)
    assert said.endswith("0.05 m across the road: is e right, its unit, too?")


@pytest.mark.parametrize("scale", [0.001, 0.5, 1.2])
def test_a_distance_in_another_unit_than_the_speed_is_told_as_that(drive, road, nominal, scale):
    start = float(drive["s"][0])
    recorded = quarter_cars.recorded(drive, noise=1.0, lateral_position=LATERAL, name="own")
    with pytest.raises(InputError, match=r"^v_x: recorded speed times \S+ fits the road .* are the units of v_x and s right") as refused:
        aligned(recorded.assign(s=start + scale * (recorded["s"] - start)), road, nominal)
    assert float(str(refused.value).split("times ")[1].split()[0]) == pytest.approx(scale, rel=0.01)


def test_a_drive_without_a_place_that_is_too_short_to_find_it_is_refused(drive, road, nominal):
    recorded = quarter_cars.recorded(drive, place=False, distance_start=float(drive["s"][0]), noise=1.0, lateral_position=LATERAL, name="own")
    with pytest.raises(InputError, match=r"^drive own: lasts 11\.5 s \(expected at least 12 s where s is left out"):
        aligned(recorded.isel(time=slice(0, 1151)), road, nominal)
    long_enough = aligned(recorded.isel(time=slice(0, 1251)), road, nominal)
    np.testing.assert_allclose(long_enough["s"], drive["s"].values[: long_enough.sizes["time"]], atol=0.1)


@pytest.mark.parametrize("reversed_rates", [("roll_rate", "pitch_rate", "yaw_rate"), ("roll_rate", "pitch_rate")])
@pytest.mark.parametrize(("start", "scale"), [(60.0, 1.0), (68.0, 0.98)])
def test_without_a_place_rates_of_the_wrong_sign_move_nothing(drive, road, nominal, reversed_rates, start, scale):
    """The odometer listens to them: it put the drive 8 m away, onto another path."""
    told = quarter_cars.recorded(drive, noise=1.0, name="own", place=False, distance_start=start, speed_scale=scale)
    right, wrong = (aligned(one, road, nominal) for one in (told, told.assign({name: -told[name] for name in reversed_rates})))
    assert ", ".join(reversed_rates) + " run against the model" in wrong.attrs["faults"] and not right.attrs["faults"]
    for name in ("speed_scale", "distance_offset", "lateral_correction"):
        assert wrong.attrs[name] == pytest.approx(right.attrs[name], abs=1e-6)


def test_a_path_on_the_other_side_of_the_reference_line_is_asked_for_its_sign(lanes, nominal):
    """In the left one of two lanes, recorded to the right."""
    road, drive = lanes
    told = quarter_cars.recorded(drive, noise=1.0, name="own")
    with pytest.raises(InputError, match=r"fits the road best \+3\.\d+ m .* with the other sign e would lie there: is it positive to the left"):
        aligned(told.assign(e=told["e"].copy(data=np.full(told.sizes["time"], -1.8))), road, nominal)
    with pytest.raises(InputError) as other:
        aligned(quarter_cars.recorded(drive, noise=1.0, lateral_position=0.0, name="own"), road, nominal)
    assert "other sign" not in str(other.value)
