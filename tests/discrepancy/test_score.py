"""The score of a verdict: found, in the cluster, missed, named wrongly, and whether intervals hold the truth."""

from __future__ import annotations

from ridecomfort.discrepancy.score import score
from tests.report import differing as made_up

HIDDEN = {"suspension_friction": {"front": 75.0, "rear": 60.0}, "damper_asymmetry": {"front": 0.3}}


def test_the_score_tells_found_from_missed_and_whether_intervals_hold():
    found = score(made_up.VERDICT, HIDDEN)
    by_size = {(row["effect"], row["parameter"]): row for row in found["rows"]}
    front = by_size["suspension_friction", "front"]
    assert front["found"] == "named" and front["covered"] and front["unit"] == "N"
    assert by_size["suspension_friction", "rear"]["covered"] is None
    assert by_size["damper_asymmetry", "front"]["found"] == "missed"


def test_what_shapes_an_effect_is_scored_only_where_it_is_not_as_usual():
    scored = lambda way: [row["parameter"] for row in score(made_up.VERDICT, {"suspension_friction": {"front": 75.0, "presliding": way}})["rows"]]
    assert "presliding" not in scored(0.0) and "presliding" in scored(0.0005)


def test_the_score_knows_clusters_wrong_names_and_what_the_model_had():
    effect = made_up.VERDICT["effects"][0]
    cluster = {**made_up.VERDICT, "effects": [{**effect, "like": ["damper_asymmetry"]}]}
    assert score(cluster, {"damper_asymmetry": {"front": 0.3}})["rows"][0]["found"] == "in the cluster"
    assert score(cluster, {"damper_asymmetry": {"front": 0.3}})["rows"][-1]["found"] == "in the cluster"  # what stands for the cluster
    assert score(cluster, {"bump_stop": {"front": 1.0}})["rows"][-1]["found"] == "named wrongly"
    assert score(made_up.VERDICT, {})["rows"][0]["found"] == "named wrongly"
    assert score(made_up.nothing(), HIDDEN, known=["suspension_friction"])["rows"][0]["found"] == "in the model"


def test_what_a_verdict_only_lists_is_not_named():
    """As what the library alone comes up to where something else is missing."""
    effects = [{**made_up.VERDICT["effects"][0], "is_of_measurement": False}]
    said = lambda kind, **more: score({**made_up.VERDICT, "verdict": kind, "effects": effects, **more}, HIDDEN)["rows"][0]["found"]
    assert [said("named"), said("cluster"), said("outside", is_beside_form=True)] == ["named"] * 3
    assert [said("outside"), said("suspect")] == ["missed"] * 2
    assert not score({**made_up.VERDICT, "verdict": "outside", "effects": effects}, {})["rows"]
