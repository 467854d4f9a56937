"""From what a search found to a verdict, on a model in which everything is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import evidence, judge, select

from .linear import Linear, alone, judged


def test_the_missing_effect_is_named_measured_and_confirmed_on_the_held_out_drive():
    selection, found = judged(Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0}))
    assert found.verdict == "named" and [e.name for e in found.effects] == ["effect_2"]
    size = found.effects[0].sizes[0]
    assert size["interval"][0] < 1.0 < size["interval"][1] and size["unit"] == "N"
    assert found.share > 0.8 and found.held_out_share > 0.5
    assert selection.final.values["stiffness"] == pytest.approx(0.7, abs=0.05)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_effect_that_stood_in_for_two_others_is_not_named_beside_them_and_does_not_blur_their_sizes(seed):
    """effect_0 does nearly what effect_1 and effect_2, which are missing, do together: it comes first, and is left out once they are there."""
    model = Linear(seed, {"effect_1.size": 2.0, "effect_2.size": 2.0})
    for columns in model.columns[2:]:  # those of all repeats are one
        columns["effect_0.size"] = columns["effect_0.size"] + columns["effect_1.size"] + columns["effect_2.size"]
    selection, found = judged(model)
    assert selection.accepted[0] == "effect_0" and selection.needless == {"effect_0"}
    assert selection.final.values["effect_0.size"] == 0.0 and "effect_0.size" not in selection.intervals
    assert selection.states[-1].fit.values["effect_0.size"] == 0.0, "shares are those of the model whose sizes are told"
    widths = [np.ptp(selection.intervals[f"effect_{k}.size"]) for k in (1, 2)]
    model.candidates = model.candidates[1:]
    without = select.select(model, {"stiffness": 0.0}, most=3)
    np.testing.assert_allclose(widths, [np.ptp(without.intervals[f"effect_{k}.size"]) for k in (1, 2)], rtol=0.1)
    assert {effect.name for effect in found.effects} == {"effect_1", "effect_2"}
    assert "effect_0 helped when it was found, but what was found with it does as well without it" in found.reasons
    by = ", ".join(selection.kept)
    assert any(reason.endswith(f"of the explainable error is removed on the fitted drives, by {by}") for reason in found.reasons)
    shares = [sum(getattr(effect, key) for effect in found.effects) for key in ("share", "held_out_share")]
    assert shares == pytest.approx([found.share, found.held_out_share]) and min(shares) > 0.9


def test_what_white_noise_would_do_as_well_is_not_named_however_well_places_agree(monkeypatch):
    scored = evidence.score_test

    def as_in_white_noise(*arguments, **options):
        found = scored(*arguments, **options)
        assert found.p_value.min() < 0.01
        return replace(found, white_p_value=np.full_like(found.white_p_value, 0.2))

    monkeypatch.setattr(evidence, "score_test", as_in_white_noise)
    selection, found = judged(Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0}))
    assert not found.effects and (selection.rounds[0].p_value >= 0.2).all()


@pytest.mark.parametrize("shared_z", [1.0, 30.0])
@pytest.mark.parametrize("gone", [-0.1, 0.1])
def test_an_error_of_the_measurement_is_suspect_by_name_unless_drives_held_out_refute_it(gone, shared_z):
    """By going up, or by going down less than anything that is missing makes them, whether or not repeats share an error for certain."""
    model = Linear(1, {"effect_2.size": 1.0})
    model.candidates = tuple(replace(one, instrument=one.name == "effect_2") for one in model.candidates)
    selection, found = judged(model)
    assert found.verdict == "suspect" and "effect_2 is an error of the measurement, not of the vehicle" in found.reasons
    first, last = selection.states
    held_out = first.held_out_squares - gone * (first.held_out_squares - selection.held_out_floor_squares)
    refuted = replace(selection, shared_z=shared_z, states=(first, replace(last, held_out_squares=held_out)))
    found = judge.judge(refuted, model.candidates)
    assert found.verdict == "outside" and not found.effects and found.is_like_error


def of_which_drives_held_out_know_little(model):
    """The selection of a model whose effects remove a tenth of the explainable error of drives held out."""
    selection, _ = judged(model)
    first, last = selection.states
    held_out = first.held_out_squares - 0.1 * (first.held_out_squares - selection.held_out_floor_squares)
    return replace(selection, states=(first, replace(last, held_out_squares=held_out)))


@pytest.mark.parametrize(("was_material", "said"), [(True, "outside"), (False, "nothing")])
def test_what_removes_little_of_an_error_that_was_not_worth_explaining_is_neither_named_nor_a_sign_of_something_else(was_material, said):
    model = Linear(1, {"effect_2.size": 1.0})
    selection = replace(of_which_drives_held_out_know_little(model), faster_gone=0.4)
    found = judge.judge(selection, model.candidates, is_material=False, was_material=was_material)
    assert found.verdict == said
    if said == "nothing":
        assert not found.effects and found.share == 0.0 and "effect_2 would help, but removes too little" in found.reasons[0]


def test_nor_is_what_may_as_well_be_none_beside_such_an_error():
    """As a mass that sits higher, which drives do not tell from a centre of gravity elsewhere than in the file."""
    model = Linear(1, {"effect_2.size": 1.0})
    selection = replace(of_which_drives_held_out_know_little(model), faster_gone=0.4, sure=frozenset())
    found = judge.judge(selection, model.candidates, is_material=False, was_material=False)
    assert found.verdict == "nothing" and not found.effects and found.share == 0.0
    assert found.reasons[0] == "effect_2 helps, but its size may as well be none"
    assert judge.judge(selection, model.candidates, is_material=False, was_material=True).verdict == "outside"


@pytest.mark.parametrize(
    ("gone", "z", "is_material", "notes", "said"),
    [
        (0.6, 10.0, False, (), "named"),
        (0.4, 10.0, False, (), "outside"),
        (0.6, 1.0, False, (), "outside"),
        (0.6, 10.0, True, (), "outside"),
        (0.6, 10.0, False, ("the road is another",), "outside"),
    ],
)
def test_what_removes_most_of_what_is_faster_than_a_driver_is_named_however_much_he_leaves(gone, z, is_material, notes, said):
    """Where nothing that is left is worth explaining, and the road is that of its file: another one makes fast errors that repeats share."""
    model = Linear(1, {"effect_2.size": 1.0})
    selection = replace(of_which_drives_held_out_know_little(model), faster_gone=gone, faster_z=z)
    found = judge.judge(selection, model.candidates, notes=list(notes), is_material=is_material)
    assert found.verdict == said
    told = "that is 60 % of what repeats share above 3 Hz: the rest is no more than a driver's foot and hands may make"
    assert (told in found.reasons) is (said == "named")


@pytest.mark.parametrize(("is_material", "left", "said"), [(False, 0.1, "named"), (False, 0.6, "outside"), (True, 0.1, "outside")])
def test_what_removes_most_of_what_is_worth_explaining_is_named_however_much_a_driver_leaves_beside_it(is_material, left, said):
    model = Linear(1, {"effect_2.size": 1.0})
    selection = replace(of_which_drives_held_out_know_little(model), faster_gone=0.4)
    found = judge.judge(selection, model.candidates, is_material=is_material, material_left=left)
    assert found.verdict == said
    told = "that is 90 % of what repeats share and is worth explaining: the rest is no more than a driver's foot and hands may make"
    assert (told in found.reasons) is (said == "named")


@pytest.mark.parametrize(("size", "is_like_error"), [(0.5, False), (0.9, True)])
def test_an_error_of_the_measurement_stands_in_for_something_else_only_where_it_removes_much(size, is_like_error):
    """Beside an effect, and with something missing that the library does not have; else it may be a part of what is left."""
    model = Linear(2, {"effect_1.size": 1.2, "effect_4.size": size, "effect_5.size": 1.0})
    model.candidates = tuple(replace(one, instrument=one.name == "effect_4") for one in model.candidates[:5])
    selection, found = judged(model)
    assert selection.accepted == ("effect_1", "effect_4") and [effect.name for effect in found.effects] == ["effect_1"]
    assert found.is_like_error is is_like_error
    value = selection.final.values["effect_4.size"]
    assert any(reason.startswith(f"effect_4 (size {value:.3g} N) would help, an error of the measurement") for reason in found.reasons)


def test_effects_that_remove_nothing_in_all_are_not_told():
    """Each helps beside what the one before left, while parameters that are fitted anew may give all of it back."""
    model = Linear(1, {"effect_2.size": 1.0})
    selection, _ = judged(model)
    first, last = selection.states
    vain = replace(selection, states=(first, replace(last, squares=1.02 * first.squares)))
    found = judge.judge(vain, model.candidates)
    assert not found.effects and found.share == 0.0 and "effect_2 helped when added" in found.reasons[0]
    assert found.verdict == "nothing" and not any("-" in reason for reason in found.reasons)


def test_what_would_help_with_the_opposite_sign_is_said():
    selection, _ = judged(Linear(2, {"effect_1.size": 1.0, "effect_4.size": -0.5}))
    first = selection.rounds[0]
    assert "opposite sign" in first.passed_over["effect_4"] and first.p_value[first.names.index("effect_4")] > 0.05


def test_nothing_is_named_where_nothing_is_missing():
    verdicts = [judged(Linear(seed, {"stiffness": 0.5}))[1].verdict for seed in range(10, 20)]
    assert verdicts.count("nothing") >= 9


def test_effects_that_look_alike_are_named_as_a_cluster():
    _, found = judged(Linear(3, {"effect_2.size": 0.3}, twins=("effect_2.size", "effect_5.size")))
    assert found.verdict == "cluster"
    assert {found.effects[0].name, *found.effects[0].like} == {"effect_2", "effect_5"}


def nearly_alike(seed):
    """A model that lacks two effects of which the first round does not tell one from the other."""
    model = Linear(seed, {"effect_1.size": 0.3, "effect_4.size": 0.3})
    for columns in {id(own): own for own in model.columns}.values():
        columns["effect_4.size"] = 0.85 * columns["effect_1.size"] + np.sqrt(1 - 0.85**2) * columns["effect_4.size"]
    selection, found = judged(model)
    assert selection.accepted == ("effect_1", "effect_4") and selection.rounds[0].cluster == ("effect_4",)
    return model, selection, found


@pytest.mark.parametrize("seed", [0, 1])
def test_effects_that_are_both_there_are_no_other_names_of_one_another(seed):
    """Which one round may not tell, before the other is accepted, too."""
    model, selection, found = nearly_alike(seed)
    assert [(effect.name, effect.like) for effect in found.effects] == [("effect_1", ()), ("effect_4", ())]
    assert found.verdict != "cluster" and "effect_1 or effect_4" not in found.words() and "do not tell" not in found.words()
    assert [effect.like for effect in judge.standing(selection, model.candidates)] == [(), ()]
    is_none = replace(selection, sure=selection.sure - {"effect_4.size"})
    assert [(effect.name, effect.like) for effect in judge.judge(is_none, model.candidates).effects] == [("effect_1", ("effect_4",))]


def test_an_error_of_the_measurement_beside_an_effect_that_is_there_is_one_however_alike():
    model, selection, _ = nearly_alike(1)
    candidates = [replace(one, instrument=one.name == "effect_1") for one in model.candidates]
    found = judge.judge(selection, candidates)
    assert "effect_1 is an error of the measurement, not of the vehicle" in found.reasons and found.verdict == "suspect"


def test_what_no_candidate_explains_is_said_to_lie_outside_the_library():
    model = Linear(4, {"effect_5.size": 0.6})
    model.candidates = model.candidates[:5]
    _, found = judged(model)
    assert found.verdict == "outside" and found.effects == ()


def test_an_implausible_size_disqualifies():
    selection, found = judged(Linear(5, {"effect_3.size": 7.0}))
    assert "effect_3" not in [e.name for e in found.effects]
    assert any("plausible" in trial.objection for trial in selection.rounds[0].trials if trial.name == "effect_3")


def test_a_truth_at_the_end_of_what_is_plausible_is_not_held_against_it():
    _, found = judged(Linear(5, {"effect_3.size": 5.0}))
    assert [e.name for e in found.effects] == ["effect_3"]


def test_what_adds_little_at_the_same_port_may_be_another_shape_of_what_it_is_like_and_is_not_named():
    def found(port, like):
        model = Linear(2, {"effect_1.size": 1.2, "effect_4.size": 0.4})
        model.candidates = tuple(replace(candidate, port=port) for candidate in model.candidates)
        for columns in {id(own): own for own in model.columns}.values():
            columns["effect_4.size"] = like * columns["effect_1.size"] + np.sqrt(1 - like**2) * columns["effect_4.size"]
        selection, verdict = judged(model)
        first, second = selection.accepted
        without_first = judge.judge(replace(selection, needless=frozenset({first})), model.candidates)
        assert [e.name for e in without_first.effects] == [second]  # which is no other shape of what is not there
        return verdict

    both = {"effect_1", "effect_4"}
    assert {e.name for e in found("", 0.0).effects} == both
    assert {e.name for e in found("suspension", 0.0).effects} == both
    assert {e.name for e in found("", 0.7).effects} == both
    alike = found("suspension", 0.7)
    assert len(alike.effects) == 1 and any("another shape" in reason for reason in alike.reasons)


def test_suspicions_keep_the_data_from_naming_anything():
    _, found = judged(Linear(1, {"effect_2.size": 0.3}), ["the clock is off"])
    assert found.verdict == "suspect" and "the clock is off" in found.reasons


def test_a_verdict_is_plain_json():
    _, found = judged(Linear(6, {}))
    import json

    text = json.dumps(found.json())
    assert set(json.loads(text)) >= {"verdict", "effects", "reasons"} and "NaN" not in text
    assert found.words().startswith("Nothing")


def test_shared_error_of_repeats_is_nothing_for_noise_and_half_for_one_as_large_as_the_noise():
    selection, _ = judged(Linear(7, {}))
    assert abs(selection.remaining.share) < 0.05
    model = Linear(7, {"effect_0.size": 1.0})
    model.candidates = model.candidates[1:]
    selection, _ = judged(model)
    assert 0.3 < selection.remaining.share < 0.7 and selection.remaining.z > 3


def test_without_repeats_an_error_that_answers_to_what_cannot_be_it_is_more_than_noise():
    too_large = {"effect_3.size": 7.0}
    _, found = judged(alone(Linear(5, too_large)))
    assert found.verdict == "outside" and found.effects == ()
    assert any("answers to effect_3" in reason for reason in found.reasons)
    selection = select.select(alone(Linear(5, too_large)), {"stiffness": 0.0}, most=3)
    assert judge.judge(selection, Linear(5, {}).candidates, is_material=False).verdict == "nothing"


@pytest.mark.parametrize("seed", range(30, 36))
def test_without_repeats_noise_is_nothing(seed):
    assert judged(alone(Linear(seed, {})))[1].verdict == "nothing"


def test_without_repeats_the_floor_is_the_noise_that_is_known_of_the_instruments():
    model = alone(Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0}))
    assert any("taken as nil" in reason for reason in judged(model)[1].reasons)
    model.records = [replace(record, noise=(0.1,) * 4) for record in model.records]
    selection, found = judged(model)
    assert any("assumed from the noise" in reason for reason in found.reasons)
    low, high = model.records[0].band
    assert selection.floor_squares.max() == pytest.approx(0.01 * (high - low))


def test_drives_held_out_that_repeat_a_fitted_one_tell_the_floor():
    """One fitted drive, two more of it held out: no error is known that repeats share, but what noise is."""
    model = Linear(1, {"stiffness": 0.7, "effect_2.size": 1.0})
    repeated = judged(model)[0]
    model.records = [replace(record, role="fit" if number == 0 else "check") for number, record in enumerate(model.records)]
    selection, found = judged(model)
    assert selection.is_floor_known and not selection.has_repeats
    assert selection.floor_squares.mean() == pytest.approx(repeated.floor_squares.mean(), rel=0.2)
    assert found.verdict == "named" and [effect.name for effect in found.effects] == ["effect_2"]
    assert any("the floor is known from repeats that are held out" in reason for reason in found.reasons)


@pytest.mark.parametrize("is_repeated", [False, True])
def test_without_repeats_what_a_name_leaves_may_be_more_than_noise(is_repeated):
    model = Linear(1, {"effect_2.size": 2.0})
    _, found = judged(model if is_repeated else alone(model))
    assert (found.verdict, [effect.name for effect in found.effects]) == ("named", ["effect_2"])
    assert found.may_be_shared is not is_repeated
