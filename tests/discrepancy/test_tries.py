"""A candidate tried: from where its sizes are fitted, and when what shapes it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import probe, refit, select, tries
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.rung import climb
from ridecomfort.discrepancy.tries import Tries
from ridecomfort.errors import InputError

from .coloured import coloured
from .linear import SAMPLES, Linear, judged, rounds

FIRST, SECOND = "effect_1.size", "effect_2.size"


class Driven(Linear):
    """The same where effect_1 is 1, and effect_2, at 2, is what drives it on to where both are without effect; between lies what is worse."""

    def __init__(self, seed):
        super().__init__(seed, {})

    def residual(self, values, index):
        first, second = values.get(FIRST, 0.0), values.get(SECOND, 0.0)
        columns = self.columns[index]
        wall = 8.0 * np.clip((first - 2.0) * (5.5 - first), 0.0, None)
        share = 4.0 * np.exp(-first)
        together = (first - 1.0) * np.exp(-first) * columns[FIRST] + share * (second - 2.0) * columns[SECOND] + wall * columns["effect_5.size"]
        return super().residual({}, index) + together


def tried(model, first):
    """The first refit of effect_2 beside an effect_1 that was accepted with this size."""
    base = climb(model, {"stiffness": 0.0}, model.free)
    values = {"stiffness": 0.0, FIRST: first}
    rung = climb(model, values, model.free, before=base)
    fitted = [*model.free, model.candidates[1].sizes[0]]
    columns = {("effect_2", 0): probe.Probe(model, rung.fit.values, rung.fit.residuals)(("effect_2", 0))}
    raw = probe.secants(model, rung.fit.values, rung.fit.residuals, fitted)
    rung.raw.update(raw)
    candidates = {candidate.name: candidate for candidate in model.candidates}
    return Tries(rung, candidates, fitted, columns, model, refit.information(rung.frame, rung.fit.residuals)).first(("effect_2", 0))


@pytest.mark.parametrize("first", [6.0, 1.2])
def test_what_drove_an_accepted_size_beyond_what_is_plausible_is_fitted_from_where_that_was_plausible(first):
    values = tried(Driven(2), first).fit.values
    assert values[FIRST] == pytest.approx(1.0, abs=0.2) and values[SECOND] == pytest.approx(2.0, abs=0.2)


def test_without_that_it_stays_behind_the_wall(monkeypatch):
    monkeypatch.setattr(Tries, "_from_plausible", lambda self, fit, *given: fit)
    assert tried(Driven(2), 6.0).fit.values[FIRST] > 5.0


IN_BAND = (40.0 - 0.3) / 50.0 * 28.0 / 30.0
"""Mean square of a white vector of ``Linear``: share of the band, and of the seconds that are not at an edge."""


class Shaped(Linear):
    """The same where a setting shapes effect_2, which is tried at 0 only."""

    def __init__(self, seed, setting):
        super().__init__(seed, {"stiffness": 0.7, "effect_2.size": 1.0})
        shaping = Size("effect_2.setting", "1", 0.0, -1.0, 1.0, 0.05, shaping=True)
        self.candidates = tuple(
            replace(one, shapes=({shaping.key: 0.0},), shaping=(shaping,)) if one.name == "effect_2" else one for one in self.candidates
        )
        rng = np.random.default_rng([seed, 1])
        own = {condition: coloured(rng, SAMPLES) for condition in ("usual", "slow")}
        self.shaped, self.setting = [own[record.condition] for record in self.records], setting

    def residual(self, values, index):
        there = values.get("effect_2.size", 0.0) * values.get("effect_2.setting", 0.0)
        return super().residual(values, index) + (there - self.setting) * self.shaped[index]


def test_what_shapes_an_effect_is_fitted_where_that_is_worth_it():
    _, found = judged(Shaped(6, 0.4))
    assert found.verdict == "named" and [e.name for e in found.effects] == ["effect_2"]
    sizes = {size["parameter"]: size["interval"] for size in found.effects[0].sizes}
    assert sizes["size"][0] < 1.0 < sizes["size"][1] and sizes["setting"][0] < 0.4 < sizes["setting"][1]


def stuck(experiment, sooner, frame, values, sizes, columns, *, residuals, **settings):
    """A refit that ends where it began."""
    matrix, flat = np.stack([columns[size.key] for size in sizes]), frame.flat(residuals)
    return tries.refit.Fit(dict(values), residuals, tuple(size.key for size in sizes), matrix, float(flat @ flat))


def test_a_refit_that_does_not_begin_is_begun_by_the_sizes_of_the_effect_itself(monkeypatch):
    """As where columns of parameters bend so much that a step of all sizes together makes the white loss larger, however short it is."""
    monkeypatch.setattr(tries.refit, "refit_sooner", stuck)
    found = select.select(Linear(1, {"effect_2.size": 2.0}), {"stiffness": 0.0}, most=1)
    assert found.accepted == ("effect_2",) and found.final.values["effect_2.size"] == pytest.approx(2.0, rel=0.05)
    assert select.select(Linear(1, {}), {"stiffness": 0.0}, most=1).accepted == ()


def test_where_no_model_can_be_driven_at_that_beginning_the_refit_stays_as_it_was(monkeypatch):
    class Fragile(Linear):
        def residual(self, values, index):
            if values.get("effect_2.size", 0.0) > 1.5:
                raise InputError("the drive came to a stand")
            return super().residual(values, index)

    monkeypatch.setattr(tries.refit, "refit_sooner", stuck)
    found = select.select(Fragile(1, {"effect_2.size": 2.0}), {"stiffness": 0.0}, most=1)
    assert "effect_2" in {trial.name for trial in found.rounds[0].trials}
    assert "effect_2" not in found.rounds[0].passed_over


class Walled(Linear):
    """The same where effect_2 makes another error, as that of a resonance that wanders, at sizes between none and what is missing."""

    def __init__(self, seed, missing):
        super().__init__(seed, {"stiffness": 0.7, "effect_2.size": missing})
        rng = np.random.default_rng([seed, 3])
        own = {condition: coloured(rng, SAMPLES) for condition in ("usual", "slow")}
        self.wandering, self.missing = [own[record.condition] for record in self.records], missing

    def residual(self, values, index):
        size = values.get("effect_2.size", 0.0)
        return super().residual(values, index) + 60.0 * size * (size - self.missing) ** 2 * self.wandering[index]


@pytest.mark.parametrize("missing", [0.4, 0.35])
def test_what_is_worse_at_small_sizes_than_nothing_is_fitted_from_its_typical_size(missing):
    """0.4: four probes."""
    found = select.select(Walled(3, missing), {"stiffness": 0.0}, most=1)
    assert found.accepted == ("effect_2",) and found.final.values["effect_2.size"] == pytest.approx(missing, rel=0.1)


def test_the_shape_of_a_large_effect_is_fitted_where_the_error_that_it_leaves_is_white(monkeypatch):
    """In the frame of before, white by the large error itself, a fit may go where that error weighs least."""
    fitted, powers = tries.refit.refit_sooner, []

    def watched(experiment, sooner, frame, values, sizes, columns, *, residuals, **settings):
        if any(size.shaping for size in sizes):
            powers.append(float(np.mean(frame.flat(residuals) ** 2)) / IN_BAND)
        return fitted(experiment, sooner, frame, values, sizes, columns, residuals=residuals, **settings)

    monkeypatch.setattr(tries.refit, "refit_sooner", watched)
    model = Shaped(6, 0.4)
    model.truth["effect_2.size"] = 4.0
    select.select(model, {"stiffness": 0.0}, most=1)
    assert powers[0] == pytest.approx(1.0, abs=0.25)


def test_what_shapes_an_effect_mostly_stays_as_is_typical_where_the_drives_say_nothing_else():
    """By BIC of thirty blocks one in fifteen does not."""
    fitted = ["setting" in [size["parameter"] for size in judged(Shaped(seed, 0.0))[1].effects[0].sizes] for seed in range(20, 32)]
    assert sum(fitted) <= 3


class Gauged(Linear):
    """The same where a setting of effect_2 does what stiffness does once the effect is there, which is not what that does without it; beside an
    error that nothing explains."""

    def __init__(self, seed):
        super().__init__(seed, {}, noise=4.0)
        shaping = Size("effect_2.setting", "1", 0.0, -1.0, 1.0, 0.05, shaping=True)
        self.candidates = tuple(
            replace(one, shapes=({shaping.key: 0.0},), shaping=(shaping,)) if one.name == "effect_2" else one for one in self.candidates
        )
        rng = np.random.default_rng([seed, 5])
        own = {condition: coloured(rng, SAMPLES) for condition in ("usual", "slow")}
        self.beside = [own[record.condition] for record in self.records]

    def does(self, values, index):
        size, column = values.get("effect_2.size", 0.0), self.columns[index]
        amount = values.get("stiffness", 0.0) + size * values.get("effect_2.setting", 0.0)
        return amount * (column["stiffness"] + 2.0 * size * self.beside[index]) + size * column["effect_2.size"]

    def residual(self, values, index):
        rest = {key: value for key, value in values.items() if not key.startswith(("stiffness", "effect_2"))}
        truth = self.does({"stiffness": 0.7, "effect_2.size": 0.5}, index) + 0.5 * self.beside[index]
        return super().residual(rest, index) + self.does(values, index) - truth


def test_what_parameters_make_good_once_the_effect_is_there_is_not_fitted_as_its_shape(monkeypatch):
    fitted, keys = tries.refit.refit_sooner, set()

    def watched(experiment, sooner, frame, values, sizes, columns, **settings):
        keys.update(size.key for size in sizes)
        return fitted(experiment, sooner, frame, values, sizes, columns, **settings)

    monkeypatch.setattr(tries.refit, "refit_sooner", watched)
    assert rounds(Gauged(6), most=1)[0].winner.name == "effect_2"
    assert "effect_2.size" in keys and "effect_2.setting" not in keys


def test_a_setting_that_was_tried_and_not_fitted_is_said():
    model = Shaped(7, 0.5)
    model.candidates = tuple(
        replace(one, shapes=({"effect_2.setting": 0.0}, {"effect_2.setting": 0.5})) if one.name == "effect_2" else one
        for one in model.candidates
    )
    _, found = judged(model)
    assert "effect_2 was found with setting 0.5 held, the best of a few values that were tried" in found.reasons
    (held,) = found.effects[0].held
    assert (held["parameter"], held["size"], held["is_typical"]) == ("setting", 0.5, False)


class TurningAxles(Linear):
    """The same with a size for each axle, both of which do nearly the same, and turn from one thing to another as they grow."""

    def __init__(self, seed):
        super().__init__(seed, {"stiffness": 0.7})
        sizes = tuple(Size(f"effect_2.{axle}", "1", 0.0, 0.0, 5.0, 0.1) for axle in ("front", "rear"))
        self.candidates = tuple(
            replace(one, sizes=sizes, shapes=({}, {}), reaches=(1.0, 4.0)) if one.name == "effect_2" else one for one in self.candidates
        )
        rng = np.random.default_rng([seed, 6])
        alike = {condition: [coloured(rng, SAMPLES) for _ in range(2)] for condition in ("usual", "slow")}
        self.parts = {}
        for size in sizes:
            own = {condition: [part + 0.2 * coloured(rng, SAMPLES) for part in alike[condition]] for condition in alike}
            self.parts[size.key] = [own[record.condition] for record in self.records]

    def does(self, key, size, index):
        first, second = self.parts[key][index]
        angle = np.pi * min(size / 0.6, 1.0)
        return size * (np.cos(angle) * first + np.sin(angle) * second)

    def residual(self, values, index):
        others = {key: value for key, value in values.items() if not key.startswith("effect_2.")}
        return super().residual(others, index) + sum(self.does(key, values.get(key, 0.0), index) - self.does(key, 0.55, index) for key in self.parts)


@pytest.mark.parametrize("seed", range(1, 5))
def test_both_axles_of_such_an_effect_are_fitted_from_where_it_was_found(seed):
    final = select.select(TurningAxles(seed), {"stiffness": 0.7}, most=1).final
    assert [final.values[f"effect_2.{axle}"] for axle in ("front", "rear")] == pytest.approx([0.55, 0.55], abs=0.05)
