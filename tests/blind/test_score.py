"""Verdicts and rows made up by hand against what they count for."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
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


def proposal(place: str, *accepted: tuple[str, float], needless: tuple[str, ...] = ()) -> SimpleNamespace:
    """One that begins with a mean square of 10, of which everything that is accepted takes off its part; ``needless``: names that the last model
    does without."""
    squares = 10.0 - np.cumsum([0.0, *(gone for _, gone in accepted)])
    states, names = tuple(SimpleNamespace(held_out_squares=np.full((1, 6), value)) for value in squares), tuple(name for name, _ in accepted)
    kept = tuple(name for name in names if name not in needless)
    return SimpleNamespace(place=place, selection=SimpleNamespace(accepted=names, states=states, kept=kept, needless=needless))


OPENED = np.full((1, 6), 10.0)


def share_of(first, last):
    """As against an oracle that leaves 2 of 10."""
    return float(np.mean(first - last) / 8.0)


def test_of_a_form_its_own_terms_count_and_what_stands_beside_it_only_together():
    row = score.form("strut", proposal("strut", ("top_mount", 2.0), ("strut:velocity_cube", 4.0), ("strut:velocity_size", 1.0)), OPENED, share_of)
    assert row["place"] == "strut" and row["place_right"]
    assert row["form_share"] == pytest.approx(5.0 / 8.0) and row["together_share"] == pytest.approx(7.0 / 8.0)


def test_what_only_stood_in_for_a_form_counts_as_the_forms():
    stood_in = proposal("strut", ("top_mount", 2.0), ("strut:velocity_cube", 4.0), needless=("top_mount",))
    row = score.form("strut", stood_in, OPENED, share_of)
    assert row["form_share"] == row["together_share"] == pytest.approx(6.0 / 8.0)


def test_without_a_form_nothing_goes_and_no_place_is_right():
    none = {"place": "", "place_right": False, "form_share": 0.0, "together_share": 0.0}
    assert score.form("strut", None, OPENED, share_of) == none
    assert score.form("strut", proposal("tyre", ("tyre:a", 4.0)), OPENED, share_of)["place_right"] is False


def test_where_no_form_could_be_right_nothing_is_judged_but_a_place_is():
    nowhere = score.form(None, proposal("strut", ("strut:velocity_cube", 4.0)), OPENED, share_of)
    assert nowhere == {"place": "strut", "place_right": "", "form_share": "", "together_share": ""}
    unseen = score.form("strut", proposal("strut", ("strut:velocity_cube", 4.0)), OPENED, lambda first, last: float("nan"))
    assert unseen == {"place": "strut", "place_right": True, "form_share": "", "together_share": ""}


def row(kind: str, verdict: str = "nothing", **more) -> dict:
    """A row of trials.csv in which nothing is right."""
    wrong = {"first_right": False, "in_cluster": False, "wrong_named": False, "exact": False}
    counts = {"covered": 0, "sizes": 0, "wrong": 0, "told": 0, "p_value": 0.5, "against_oracle": float("nan"), "cpu_seconds": 40.0}
    formed = {"place": "", "place_right": "", "form_share": "", "together_share": ""}
    return {"kind": kind, "hidden": "top_mount", "reached": 1.0, "verdict": verdict, "found": "", **wrong, **counts, **formed, **more}


def lines(*rows: dict) -> dict[str, tuple[str, str]]:
    """Of every figure how many of how many hundred, and over how many trials."""
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in score.summary(rows)[2:]]
    return {figure: (reached.partition(" (")[0], trials) for figure, _, reached, _, trials in table}


@pytest.mark.parametrize(
    ("aim", "hits", "count", "said"),
    [
        ("95 %", 19, 20, "yes"), ("95 %", 18, 20, "missed by chance, perhaps"), ("95 %", 80, 100, "missed"), ("95 %", 0, 0, ""), ("", 1, 2, ""),
        ("at most 3 %", 3, 100, "yes"), ("at most 3 %", 5, 100, "missed by chance, perhaps"), ("at most 3 %", 17, 206, "missed"),
        ("3-8 %", 5, 100, "yes"), ("3-8 %", 3, 21, "missed by chance, perhaps"), ("3-8 %", 0, 21, "missed by chance, perhaps"), ("3-8 %", 30, 100, "missed"),
    ],
)  # fmt: skip
def test_an_aim_that_is_missed_is_said_to_be(aim, hits, count, said):
    assert score.met(aim, hits, count) == said


RIGHT = {"first_right": True, "in_cluster": True, "exact": True}


def test_rows_of_one_effect_count_from_a_kappa_on_and_say_what_is_left_out():
    found = lines(
        row("clean", "named", **RIGHT, against_oracle=1.0), row("clean", against_oracle=0.0), row("clean", "cluster", in_cluster=True, reached=0.3),
        row("clean", reached=0.24, against_oracle=0.5), row("clean", "named", **RIGHT, reached=0.2), row("clean", reached=0.03),
        row("messy", "named", wrong_named=True), row("messy", reached=0.1),
    )  # fmt: skip
    assert found["first name right, clean, kappa >= 0.3"] == ("25 %", "4 of 6")
    assert found["first name right, messy, kappa >= 0.3"] == ("0 %", "1 of 2")
    assert found["true effect named or in the named cluster, kappa >= 0.3"] == ("40 %", "5 of 8")
    at = [found[f"found, clean, kappa {kappa}"] for kappa in ("0.05", "0.1", "0.3", "1")]
    assert at == [("-", "0"), ("100 %", "1"), ("50 %", "2"), ("50 %", "2")]
    assert found["wrong effect named with confidence"] == ("12 %", "8")
    assert found["hidden effect below kappa 0.04 at any plausible size (left out above)"] == ("1", "8")
    # What was not found counts against the oracle, too.
    assert found["held-out error removed, relative to the oracle, median (10th percentile)"] == ("0.50", "3")


def test_beside_outside_no_name_is_right_where_the_library_has_what_is_missing():
    found = lines(
        row("messy", "outside", **RIGHT), row("messy", "named", **RIGHT), row("two", "outside", **RIGHT), row("wrong file", "outside", **RIGHT),
        row("outside, beside the library", "outside", **RIGHT), row("clean", "outside", **RIGHT),
    )  # fmt: skip
    assert found["first name right, messy, kappa >= 0.3"] == ("50 %", "2")
    assert found["true effect named or in the named cluster, kappa >= 0.3"] == ("33 %", "3")
    assert found["found, clean, kappa 1"] == ("0 %", "1")
    assert found["exact set of 2 effects, each at kappa >= 0.3"] == ("0 %", "1")
    assert found["what is missing named, and nothing else, beside a wrong file of the vehicle, kappa >= 0.3"] == ("0 %", "1")
    assert found["effect of the library beside such a force named, and no other"] == ("100 %", "1")


def test_rows_of_nothing_and_of_sets():
    null = {"hidden": "", "reached": 0.0}
    found = lines(
        row("nothing", **null), row("nothing", **null), row("nothing", "named", **null, found="payload", wrong_named=True, p_value=0.01),
        row("brisk foot", **null, p_value=0.04), row("gain error", "suspect", **null), row("gain error", **null),
        row("two", "named", **RIGHT), row("two", "named", first_right=True, in_cluster=True), row("two", "named", **RIGHT, reached=0.1),
        row("measurement", "suspect", **RIGHT), row("measurement", "named", **RIGHT), row("measurement", "suspect"),
        row("messy", covered=1, sizes=2), row("clean", covered=3, sizes=4), row("clean", covered=0, sizes=9, reached=0.0),
    )  # fmt: skip
    assert found["an effect named where nothing is missing: nothing"] == ("33 %", "3")
    assert found["p of the whole library below 5 %: all of these"] == ("50 %", "4")
    assert found["suspect data flagged: gain error"] == ("50 %", "2")
    assert found["exact set of 2 effects, each at kappa >= 0.3"] == ("50 %", "2 of 3")
    assert found["exact set of 3 effects, each at kappa >= 0.3"] == ("-", "0")
    assert found["suspect data flagged, by name: another error of the measurement, kappa >= 0.3"] == ("33 %", "3")
    assert found["90 % interval of a size covers the truth, messy"] == ("50 %", "2 sizes")
    assert found["90 % interval of a size covers the truth, others"] == ("75 %", "4 sizes")


def test_a_form_counts_between_what_is_too_little_and_what_is_too_much_and_where_outside_is_said():
    formed = lambda share, said="outside", **more: row(
        "outside", said, place="strut", place_right=True, form_share=share, together_share=1.0, **more
    )
    missed = row("outside, messy", place_right=False, form_share=0.0, together_share=0.0)
    found = lines(
        formed(0.79), formed(0.8), formed(1.25), formed(2.02), missed, formed(1.0, reached=0.1), formed("", "outside"),
        row("outside", "outside", place="strut"),
    )  # fmt: skip
    assert found["place of such an effect right (strut, tyre, contact, links, body, steering, structure)"] == ("83 %", "6 of 8")
    assert found["its proposed form alone removes 80 to 125 % of what the true one does, held out"] == ("40 %", "5 of 8")
    assert found['the same where "outside" is said'] == ("50 %", "4 of 5")
    assert found["force at a port that no form has (left out of places and forms)"] == ("1", "7")
    assert found["force that changes nothing held out (left out of forms)"] == ("1", "7")
    assert found['"outside the library" said when it is, clean, kappa >= 0.3'] == ("100 %", "6 of 7")
    assert found['"outside the library" said when it is, messy, kappa >= 0.3'] == ("0 %", "1")


def test_beside_effects_of_the_library_both_count_together():
    placed = {"place": "strut", "place_right": True, "form_share": 0.1}
    both = lambda share, **more: row("outside, beside the library", "outside", **placed, together_share=share, **more)
    found = lines(both(0.9, exact=True), both(0.5), both(1.3), both(0.9, reached=0.1))
    assert found["effect of the library beside such a force named, and no other"] == ("33 %", "3 of 4")
    assert found["both together remove 80 to 125 % of what the true ones do, held out"] == ("33 %", "3 of 4")


def test_beside_a_wrong_file_outside_counts_with_a_place_only_and_stands_beside_what_is_said_of_the_file_alone():
    kind, placed = "outside, beside a wrong file", {"place": "strut", "place_right": True, "form_share": 0.9, "together_share": 0.9}
    alone = {"hidden": "", "reached": 0.0, "wrong": 1}
    found = lines(
        row(kind, "outside", **placed, wrong=2, told=2), row(kind, "outside", place_right=False, form_share=0.0, together_share=0.0, wrong=2, told=1),
        row(kind, wrong=1, told=1, reached=0.1), row("wrong file", "outside", **alone, told=1), row("wrong file", "outside", **alone, place="tyre"),
        row("wrong file", **alone), row("wrong file", "named", **RIGHT, wrong=1, told=1), row("wrong file", "named", **RIGHT, wrong=1, reached=0.1),
    )  # fmt: skip
    assert found['"outside the library" said when it is, with a place, beside a wrong file, kappa >= 0.3'] == ("50 %", "2 of 3")
    assert found['"outside the library" said where nothing but the vehicle\'s file is wrong'] == ("67 %", "3")
    assert found["the same, with a place"] == ("33 %", "3")
    assert found["all that is wrong in the file told to 5 %, beside such a force"] == ("50 %", "2 of 3")
    assert found["all that is wrong in the file told to 5 %"] == ("40 %", "5")
    assert found["what is missing named, and nothing else, beside a wrong file of the vehicle, kappa >= 0.3"] == ("100 %", "1 of 2")
    assert found["its form removes 80 to 125 % of what is left to who knows file and force, held out"] == ("50 %", "2 of 3")
    assert found["no effect named where nothing but the vehicle's file is wrong"] == ("100 %", "3")
