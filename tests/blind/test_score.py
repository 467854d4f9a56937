"""Verdicts and rows made up by hand against what they count for."""

from __future__ import annotations

import pytest
import xarray as xr

from ridecomfort.discrepancy.beyond import Beyond, BeyondBounds
from ridecomfort.discrepancy.ranking import SHARED
from ridecomfort.discrepancy.verdict import Named, Verdict
from tests.blind import score
from tests.blind.kinds import Draw

TABLE = xr.Dataset({"p_value": (("round", "effect"), [[0.2, 0.03], [0.001, 0.5]]), **{name: ((), 0.0) for name in SHARED}})
TRUTH = {"effects": {"top_mount": {"front": 2.0, "rear": 1.0}, "payload": {"mass": 120.0}}}


def named(name: str, *sizes: tuple[str, float, float], like=(), is_of_measurement=False) -> Named:
    told = tuple({"parameter": parameter, "interval": (lower, upper)} for parameter, lower, upper in sizes)
    return Named(name, told, "", 0.001, 0.5, 0.5, 0.0, tuple(like), {}, is_of_measurement)


def verdict(kind: str, *effects: Named, **more) -> Verdict:
    return Verdict(kind, effects, (), 0.8, 0.7, **more)


def hidden(*names: str, background=()) -> Draw:
    return Draw(names, 1.0, frozenset(names), spoilt={"background": background})


def scored(draw: Draw, kind: str, *effects: Named) -> dict:
    return score.score(draw, TRUTH, TABLE, verdict(kind, *effects))


def test_what_is_hidden_and_named_is_right():
    row = scored(hidden("top_mount"), "named", named("top_mount"))
    assert row["first_right"] and row["in_cluster"] and row["exact"] and not row["wrong_named"]
    assert row["found"] == row["likely"] == "top_mount" and row["p_value"] == 0.03


def test_another_name_is_wrong_but_in_a_cluster_with_what_is_hidden_found():
    wrong = scored(hidden("top_mount"), "named", named("payload"))
    assert wrong["wrong_named"] and not (wrong["first_right"] or wrong["in_cluster"] or wrong["exact"])
    cluster = scored(hidden("top_mount"), "cluster", named("payload", like=["top_mount"]))
    assert cluster["in_cluster"] and not (cluster["first_right"] or cluster["wrong_named"] or cluster["exact"])


def test_a_second_name_is_wrong_unless_it_is_in_the_background():
    names = named("top_mount"), named("payload")
    row = scored(hidden("top_mount"), "named", *names)
    assert row["first_right"] and row["wrong_named"] and not row["exact"]
    assert not scored(hidden("top_mount", background=["payload"]), "named", *names)["wrong_named"]


def test_of_two_that_are_hidden_one_is_no_exact_set_but_no_wrong_name():
    row = scored(hidden("top_mount", "payload"), "named", named("payload"))
    assert row["first_right"] and not row["exact"] and not row["wrong_named"]


def test_nothing_found_is_no_right_name():
    row = scored(hidden("top_mount"), "nothing")
    assert not (row["first_right"] or row["in_cluster"] or row["exact"] or row["wrong_named"])


def test_where_the_data_are_suspect_only_an_error_of_the_measurement_is_named():
    row = scored(hidden("top_mount"), "suspect", named("top_mount", like=["payload"]))
    assert not (row["first_right"] or row["in_cluster"] or row["exact"]) and row["found"] == "top_mount" and not row["likely"]
    row = scored(hidden("sensor_mount"), "suspect", named("sensor_mount", is_of_measurement=True))
    assert row["first_right"] and row["in_cluster"]


@pytest.mark.parametrize(("lower", "upper", "covers"), [(1.5, 2.5, 1), (2.1, 2.5, 0), (1.5, 1.9, 0)])
def test_an_interval_covers_the_truth_between_its_ends(lower, upper, covers):
    row = scored(hidden("top_mount"), "named", named("top_mount", ("front", lower, upper)), named("tyre_runout", ("front", 0.0, 1.0)))
    assert (row["covered"], row["sizes"]) == (covers, 1)


def test_of_a_wrong_file_what_is_told_to_five_percent_counts():
    draw = Draw((), 0.0, frozenset(), wrong={"roll_inertia": 2.0, "pitch_inertia": 0.5})
    car = {"roll_inertia": 500.0, "pitch_inertia": 2000.0, "yaw_inertia": 2200.0}
    parameter = lambda name, value: Beyond(name, "kg m2", car[name], (0.0, 1e4), (0.0, 1e5), value, (0.9 * value, 1.1 * value))
    said = [parameter("roll_inertia", 1040.0), parameter("pitch_inertia", 940.0), parameter("yaw_inertia", 2200.0)]
    assert score.told(draw, car, verdict("outside", beyond_bounds=BeyondBounds(tuple(said), 0.5, 0.5))) == 1
    assert score.told(draw, car, verdict("outside")) == 0
