"""The search on a model in which everything is known: what is probed, refitted and accepted, round by round."""

from __future__ import annotations

from dataclasses import replace
from zlib import crc32

import numpy as np
import pytest

from ridecomfort.discrepancy import contest, probe, select, tries
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.rung import begin
from ridecomfort.effects.in_python import ActFails
from ridecomfort.errors import InputError

from .coloured import coloured
from .linear import SAMPLES, Linear, judged, rounds


class Opposed(Linear):
    """The same where effect_2 has two sizes of either sign whose columns are mostly alike, and of opposite signs in truth."""

    def __init__(self, seed):
        super().__init__(seed, {"stiffness": 0.7, "effect_2.front": 0.3, "effect_2.rear": -0.3})
        sizes = tuple(Size(f"effect_2.{axle}", "1", 0.0, -5.0, 5.0, 0.1) for axle in ("front", "rear"))
        self.candidates = tuple(replace(one, sizes=sizes) if one.name == "effect_2" else one for one in self.candidates)
        rng = np.random.default_rng([seed, 2])
        for condition in {id(columns): columns for columns in self.columns}.values():
            alike = 20.0 * condition.pop("effect_2.size")
            condition |= {size.key: alike + coloured(rng, SAMPLES) for size in sizes}


def test_sizes_of_opposite_signs_are_found_though_each_alone_and_their_sum_show_nothing():
    selection, found = judged(Opposed(8))
    assert found.verdict == "named" and [e.name for e in found.effects] == ["effect_2"]
    sizes = {size["parameter"]: size["size"] for size in found.effects[0].sizes}
    assert sizes["front"] == pytest.approx(0.3, abs=0.1) and sizes["rear"] == pytest.approx(-0.3, abs=0.1)


class Nearby(Linear):
    """The same where all but 3 % of the power of what effect_2 does is what alignment leaves open."""

    def __init__(self, seed, truth, **told):
        super().__init__(seed, truth)
        self.candidates = tuple(replace(one, instrument=True, **told) if one.name == "effect_2" else one for one in self.candidates)
        rng = np.random.default_rng([seed, 3])
        self.open = {id(columns): coloured(rng, SAMPLES) for columns in {id(columns): columns for columns in self.columns}.values()}
        for columns in {id(columns): columns for columns in self.columns}.values():
            columns["effect_2.size"] = np.sqrt(0.97) * self.open[id(columns)] + np.sqrt(0.03) * columns["effect_2.size"]

    def nuisances(self, values, index):
        return 10.0 * self.open[id(self.columns[index])][None]


def test_an_error_of_an_instrument_that_is_nearly_what_alignment_leaves_open_is_named_and_one_that_alignment_takes_out_not_tried():
    truth = {"stiffness": 0.7, "effect_2.size": 3.0}
    selection, found = judged(Nearby(1, truth))
    assert found.verdict == "suspect" and [effect.name for effect in found.effects] == ["effect_2"]
    assert selection.final.values["effect_2.size"] == pytest.approx(3.0, rel=0.15)
    aligned, _ = judged(Nearby(1, truth, is_aligned=True))
    assert "effect_2" in selection.rounds[0].names and "effect_2" not in aligned.rounds[0].names


class Edged(Linear):
    """The same with an edge of the road for 0.1 s, which the steps of the integration meet anew at any value: an error there that is another at
    each, far larger than the noise, and nil at the values of the calibrated model."""

    def residual(self, values, index):
        if not any(name.startswith("effect_") for name in values):
            return super().residual(values, index)
        any_size = np.random.default_rng([crc32(repr(sorted(values.items())).encode()), index]).standard_normal()
        return super().residual(values, index) + any_size * self.edge()

    def edge(self):
        error = np.zeros((4, SAMPLES))
        error[:, 2000:2010] = 10.0
        return error


def named_beside_an_edge(is_known):
    """Of five cars those whose missing effect is named."""
    found = []
    for seed in range(5):
        model = Edged(seed, {"stiffness": 0.7, "effect_2.size": 0.5})
        model.inexact = {index: model.edge() for index in range(4)} if is_known else {}
        found.append(judged(model)[1])
    return [one for one in found if one.verdict == "named" and [effect.name for effect in one.effects] == ["effect_2"]]


def test_an_edge_that_every_simulation_meets_otherwise_hides_no_effect_where_it_is_known_to():
    known, unknown = named_beside_an_edge(True), named_beside_an_edge(False)
    assert len(known) >= 4 and len(known) > len(unknown)
    sizes = [found.effects[0].sizes[0]["size"] for found in known]
    assert np.mean(sizes) == pytest.approx(0.5, abs=0.05) and sizes == pytest.approx([0.5] * len(sizes), abs=0.15)


class Turning(Linear):
    """The same where effect_2 does at its typical size, 0.4, nothing of what it does at a quarter of that."""

    def __init__(self, seed, reaches):
        super().__init__(seed, {"stiffness": 0.7})
        self.candidates = tuple(
            replace(one, shapes=({},) * len(reaches), reaches=reaches) if one.name == "effect_2" else one for one in self.candidates
        )
        rng = np.random.default_rng([seed, 5])
        own = {condition: coloured(rng, SAMPLES) for condition in ("usual", "slow")}
        self.turned = [own[record.condition] for record in self.records]

    def residual(self, values, index):
        angle = lambda size: 0.5 * np.pi * np.clip((size - 0.1) / 0.3, 0.0, 1.0)
        does = lambda size: size * (np.cos(angle(size)) * self.columns[index]["effect_2.size"] + np.sin(angle(size)) * self.turned[index])
        others = {key: value for key, value in values.items() if key != "effect_2.size"}
        return super().residual(others, index) + does(values.get("effect_2.size", 0.0)) - does(0.5)


@pytest.mark.parametrize("reaches, names", [((1.0,), []), ((1.0, 4.0), ["effect_2"])])
def test_an_effect_that_does_something_else_at_a_typical_size_is_found_by_what_it_does_there(reaches, names):
    selection, _ = judged(Turning(8, reaches))
    assert list(selection.accepted) == names
    if names:
        assert selection.final.values["effect_2.size"] == pytest.approx(0.5, rel=0.1)


class Bent(Linear):
    """The same where effect_2 bends as it grows, while at a setting beside the typical one, 0, it does at any size what it does there at a
    quarter."""

    def __init__(self, seed):
        super().__init__(seed, {"stiffness": 0.7, "effect_2.size": 1.0})
        shapes = ({"effect_2.setting": 0.0}, {"effect_2.setting": 0.5})
        self.candidates = tuple(replace(one, shapes=shapes) if one.name == "effect_2" else one for one in self.candidates)
        rng = np.random.default_rng([seed, 4])
        own = {condition: coloured(rng, SAMPLES) for condition in ("usual", "slow")}
        self.bent = [own[record.condition] for record in self.records]

    def residual(self, values, index):
        size = values.get("effect_2.size", 0.0)
        bend = 0.25 * size if values.get("effect_2.setting", 0.0) else size**2
        return super().residual(values, index) + (bend - 1.0) * self.bent[index]


def test_what_small_sizes_do_in_another_shape_is_refitted_in_the_typical_one_too():
    turn = rounds(Bent(7), most=1)[0]
    assert turn.winner.name == "effect_2" and turn.winner.shape == {"effect_2.setting": 0.0}
    assert turn.winner.fit.values["effect_2.size"] == pytest.approx(1.0, abs=0.05)


def test_two_missing_effects_are_both_found():
    _, found = judged(Linear(2, {"effect_1.size": 0.4, "effect_4.size": 0.2}))
    assert {e.name for e in found.effects} == {"effect_1", "effect_4"}


@pytest.mark.parametrize(("most", "why"), [(5, "its refit gains less than 5 % of the best"), (1, "not refitted: the 1 that gain most were")])
def test_what_is_significant_and_not_judged_is_said_why(monkeypatch, most, why):
    monkeypatch.setattr(contest, "PROPOSED", most)
    selection, _ = judged(Linear(2, {"effect_1.size": 1.0, "effect_4.size": 0.15}))
    first = selection.rounds[0]
    assert [trial.name for trial in first.trials] == ["effect_1"] and first.p_value[first.names.index("effect_4")] < 0.05
    assert first.passed_over["effect_4"] == why
    assert not first.passed_over.keys() & {trial.name for trial in first.trials}


def test_what_another_test_has_found_is_refitted_and_judged_by_the_drives_all_the_same():
    """A line in the spectrum is whitened away with what goes along with it; that it is there order analysis says."""
    model = Linear(2, {"effect_1.size": 1.0})
    heard = select.select(model, {"stiffness": 0.0}, most=1, known={"effect_4": 1e-9})
    p_value = lambda selection: selection.rounds[0].p_value[selection.rounds[0].names.index("effect_4")]
    assert p_value(heard) == 1e-9 and p_value(select.select(model, {"stiffness": 0.0}, most=1)) > 0.05
    assert heard.accepted == ("effect_1",)
    told = {**heard.rounds[0].passed_over, **{trial.name: trial.objection for trial in heard.rounds[0].trials}}
    assert told["effect_4"]


def test_no_two_draws_of_rounds_and_searches_are_alike(monkeypatch):
    """Decoys and the test, its rounds, and searches of other seeds."""
    model, draw, seeds = Linear(5, {"effect_1.size": 0.8}), np.random.default_rng, []
    monkeypatch.setattr(np.random, "default_rng", lambda seed: seeds.append(seed) or draw(seed))
    for seed in (0, 1):
        select.select(model, {"stiffness": 0.0}, most=2, seed=seed)
    first = [draw(seed).integers(2**62) for seed in seeds if np.ndim(seed)]
    assert len(first) == 16 and len(set(first)) == 16


def test_what_is_simpler_goes_before_what_explains_hardly_more():
    """An effect of the library before the term of a force that does what it does, and some noise besides."""
    model = Linear(4, {"effect_2.size": 1.0}, twins=("effect_2.size", "effect_1.size"))
    winner = lambda **settings: select.select(model, {"stiffness": 0.0}, most=1, **settings).accepted
    assert winner() == ("effect_2",) and winner(simpler={"effect_1"}) == ("effect_1",)
    apart = Linear(4, {"effect_2.size": 1.0})
    assert select.select(apart, {"stiffness": 0.0}, most=1, simpler={"effect_1"}).accepted == ("effect_2",)


def test_what_may_not_follow_those_accepted_is_not_looked_for_beside_them():
    model = Linear(1, {"effect_2.size": 1.5, "effect_4.size": 1.0})
    accepted = lambda **settings: set(select.select(model, {"stiffness": 0.0}, most=3, **settings).accepted)
    assert accepted() == {"effect_2", "effect_4"}
    assert accepted(together=lambda names, other: (names, other) != (["effect_2"], "effect_4")) == {"effect_2"}


def test_a_size_beyond_which_nothing_drives_is_probed_the_other_way():
    model = Linear(1, {"effect_2.size": 0.95})
    plain = model.residual

    def residual(values, index):
        if values.get("effect_2.size", 0.0) > 1.0:
            raise InputError("came to a stand")
        return plain(values, index)

    model.residual = residual
    assert [e.name for e in judged(model)[1].effects] == ["effect_2"]


def refusing(kind, words="came to a stand"):
    """A model that lacks effect_2 and cannot be driven with any effect_4."""
    model = Linear(1, {"effect_2.size": 1.5})
    plain = model.residual

    def residual(values, index):
        if values.get("effect_4.size", 0.0) > 0.0:
            raise kind(words)
        return plain(values, index)

    model.residual = residual
    return model


def test_what_cannot_be_driven_at_its_probe_is_told_with_the_reason():
    model = refusing(InputError)
    first, *others = rounds(model, 2)
    assert "effect_4" not in first.names and first.passed_over["effect_4"] == "could not be simulated: came to a stand"
    assert first.winner.name == "effect_2" and all("effect_4" not in turn.passed_over for turn in others)
    model.candidates = tuple(one for one in model.candidates if one.name == "effect_4")
    found = judged(model)[1]
    assert "effect_4: could not be simulated: came to a stand" in found.reasons


def test_what_has_no_size_to_fit_is_told_and_not_driven():
    model = Linear(1, {"effect_2.size": 1.5})
    model.candidates = tuple(replace(one, sizes=()) if one.name == "effect_4" else one for one in model.candidates)
    first, *others = rounds(model, 2)
    assert "effect_4" not in first.names and first.passed_over["effect_4"].startswith("no size to fit")
    assert first.winner.name == "effect_2" and all("effect_4" not in turn.passed_over for turn in others)
    model.candidates = tuple(one for one in model.candidates if one.name == "effect_4")
    found = judged(model)[1]
    assert found.verdict == "outside" and any(reason.startswith("effect_4: no size to fit") for reason in found.reasons)


def test_a_mistake_in_the_file_of_an_effect_ends_the_search():
    with pytest.raises(InputError, match="my_drift.py: act failed: NameError"):
        rounds(refusing(ActFails, "own/my_drift.py: act failed: NameError"), 1)


def test_a_size_that_can_be_larger_only_is_not_found_below_nil_by_way_of_another_that_may_be_of_either_sign():
    model, rng = Opposed(8), np.random.default_rng(7)
    for columns in {id(columns): columns for columns in model.columns}.values():
        columns |= {f"effect_2.{axle}": coloured(rng, SAMPLES) for axle in ("front", "rear")}
    model.truth = {"effect_2.front": -0.3}

    def gain(lower):
        front, rear = model.candidates[2].sizes
        model.candidates = tuple(replace(one, sizes=(replace(front, lower=lower), rear)) if one.name == "effect_2" else one for one in model.candidates)
        (first, *_) = rounds(model, 1)
        return first.gain[first.names.index("effect_2")]

    assert gain(-5.0) > 1000.0 and gain(0.0) < 4.0


def test_what_was_probed_from_the_same_rung_is_not_probed_again():
    rung = begin(Linear(1, {"effect_2.size": 1.5, "effect_4.size": 1.0}), {"stiffness": 0.0})
    asked = []

    def each(function, jobs):
        jobs = list(jobs)
        asked.extend(jobs if isinstance(function, probe.Probe) else ())
        return map(function, jobs)

    first = select.search(rung, each=each)
    count = len(asked)
    again = select.search(rung, each=each, probed=first.probed)
    known = {(candidate.name, 0) for candidate in rung.experiment.candidates}
    assert {*asked[: len(known)]} == known and asked[count:] == asked[len(known) : count]  # above that rung it is another one
    assert again.accepted == first.accepted and again.final.values == first.final.values


def test_an_effect_beside_which_the_error_grows_once_all_is_fitted_anew_is_taken_back_and_the_next_looked_for(monkeypatch):
    """As of a second one of which drives that are aligned for it know nothing: its refit alone spoke for it."""
    model = Linear(1, {"effect_1.size": 1.5, "effect_2.size": 1.0, "effect_4.size": 0.9})
    first, second, third = select.select(model, {"stiffness": 0.0}, most=3).accepted
    climbed = select.climb

    def climb(experiment, values, sizes, *arguments, **settings):
        rung = climbed(experiment, values, sizes, *arguments, **settings)
        if f"{second}.size" not in {size.key for size in sizes}:
            return rung
        larger = {index: 1.5 * residual for index, residual in rung.fit.residuals.items()}
        return replace(rung, fit=replace(rung.fit, residuals=larger), check={index: 1.5 * own for index, own in rung.check.items()})

    refitted, refit = [], tries.Tries.first
    monkeypatch.setattr(tries.Tries, "first", lambda self, job: refitted.append((job[0], id(self.rung))) or refit(self, job))
    monkeypatch.setattr(select, "climb", climb)
    found = select.select(model, {"stiffness": 0.0}, most=3)
    assert found.accepted == (first, third) and f"{second}.size" not in found.final.values
    objections = {trial.name: trial.objection for trial in found.rounds[1].trials}
    assert objections[second] == select.VAIN and not objections[third]
    assert second in found.rounds[1].names and second not in found.rounds[1].passed_over
    assert third in {name for name, _ in refitted} and all(refitted.count(own) == 1 for own in refitted), "others are not refitted again"
