"""A rung's last fit, whose sizes are told."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import floor
from ridecomfort.discrepancy import rung as rung_module
from ridecomfort.discrepancy.rung import awake, begin, climb, final_fit

from .linear import Linear

KEY = "effect_2.size"


class Bent(Linear):
    """The same where a small size of effect_2 acts the other way: nil is a minimum of the error, the truth of 2.5 another."""

    def __init__(self, seed):
        super().__init__(seed, {KEY: self.bent(2.5)})

    @staticmethod
    def bent(size):
        return size * (size - 1.0)

    def residual(self, values, index):
        return super().residual({**values, KEY: self.bent(values.get(KEY, 0.0))}, index)


def test_a_size_that_ended_where_it_starts_is_fitted_from_far_off_too():
    model = Bent(3)
    sizes = [*model.free, model.candidates[2].sizes[0]]
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, sizes)
    assert rung.fit.values[KEY] == pytest.approx(0.0, abs=0.1)
    fit, _ = final_fit(rung, sizes)
    assert fit.values[KEY] == pytest.approx(2.5, abs=0.05)


def test_it_is_so_before_the_next_effect_is_looked_for():
    model = Bent(3)
    sizes = [*model.free, model.candidates[2].sizes[0]]
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, sizes)
    assert awake(rung, sizes, model.free) is rung  # of other sizes none sleeps
    assert awake(rung, sizes, model.candidates[2].sizes).fit.values[KEY] == pytest.approx(2.5, abs=0.05)


@pytest.mark.parametrize("loud", [(1.0, 1.0, 1.0), (0.5, 1.0, 1.5), (0.3, 0.3, 2.0)])
def test_the_floor_is_the_noise_though_one_repeat_has_more_of_it_than_another(loud):
    """Of all four signals together hardly a tenth of one's power passes for explainable, where nothing is missing."""
    explainable = []
    for seed in range(60, 68):
        model = Linear(seed, {})
        for index, size in enumerate(loud):
            model.noise[index] = size * model.noise[index]
        rung = begin(model, {"stiffness": 0.0})
        reached = floor.squares(model, rung.frame.all_cleaned(rung.fit.residuals)).mean(axis=0)
        explainable.append(np.sum(1.0 - rung.floor_squares.mean(axis=0) / reached))
    assert 0.0 <= np.mean(explainable) < 0.2


def test_noise_that_is_told_of_some_instruments_is_assumed_of_the_others():
    model = Linear(3, {})
    for told in ({0}, {0, len(model.records) - 1}, {len(model.records) - 1}):
        alone = [replace(record, condition=str(k), noise=(0.05,) * 4 if k in told else ()) for k, record in enumerate(model.records)]
        one = copy(model)
        one.records = alone
        rung = climb(one, {"stiffness": 0.0}, model.free)
        assert not rung.is_floor_known
        floors = np.concatenate([rung.floor_squares, rung.held_out_floor_squares])
        np.testing.assert_allclose(floors, floors[:1].repeat(len(floors), axis=0))
        assert (floors > 0).all()


def test_a_density_that_is_told_of_one_instrument_fills_the_band_of_another_as_far_as_that_goes():
    model = Linear(3, {})
    widths = (40.0, 20.0, 10.0, 40.0)
    model.records = [
        replace(record, condition=str(k), band=(0.3, upper), noise=() if k else (0.02,) * 4)
        for k, (record, upper) in enumerate(zip(model.records, widths))
    ]
    rung = begin(model, {"stiffness": 0.0})
    floors = np.concatenate([rung.floor_squares, rung.held_out_floor_squares])
    np.testing.assert_allclose(floors, np.array([[0.02**2 * (upper - 0.3)] * 4 for upper in widths]))


def test_where_nil_is_best_it_stays():
    model = Linear(3, {})
    sizes = [*model.free, model.candidates[2].sizes[0]]
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, sizes)
    fit, _ = final_fit(rung, sizes)
    assert fit.values[KEY] == pytest.approx(0.0, abs=0.1) and awake(rung, sizes, model.candidates[2].sizes) is rung


class Curved(Linear):
    """The same where what the stiffness does changes with it, by as much at 10 N/m as it is from the start."""

    def residual(self, values, index):
        stiffness = values.get("stiffness", 0.0)
        curved = 0.05 * (stiffness**2 - self.truth["stiffness"] ** 2) * self.columns[index]["effect_5.size"]
        return super().residual(values, index) + curved


@pytest.mark.parametrize("truth", [6.0, 0.03])
def test_columns_of_the_parameters_are_those_of_where_the_fit_ended(truth):
    rung = begin(Curved(3, {"stiffness": truth}), {"stiffness": 0.0})
    assert rung.fit.values["stiffness"] == pytest.approx(truth, abs=0.05)
    for index, column in rung.raw["stiffness"].items():
        own = rung.experiment.columns[index]
        there = 0.1 * (own["stiffness"] + 0.1 * truth * own["effect_5.size"])
        assert np.linalg.norm(column - there) < 0.02 * np.linalg.norm(there)


class Held(Linear):
    """The same where drives, once they are aligned for a model, hold effect_2 back: they change otherwise than it does as it grows."""

    size, hold = 0.0, 5.0

    def retuned(self, values, indices, exactly=False):
        tuned = copy(self)
        tuned.size = values.get(KEY, 0.0)
        return tuned, {index: tuned.residual(values, index) for index in indices}

    def residual(self, values, index):
        off = self.hold * (values.get(KEY, 0.0) - self.size)
        return super().residual(values, index) + off * self.columns[index]["effect_5.size"]


def test_a_fit_that_alignment_holds_back_is_carried_on():
    model = Held(3, {KEY: 2.5})
    sizes = [*model.free, model.candidates[2].sizes[0]]
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, sizes)
    assert rung.fit.values[KEY] < 0.5
    fit, _ = final_fit(rung, sizes)
    assert fit.values[KEY] == pytest.approx(2.5, abs=0.1)


def test_above_another_drives_are_aligned_anew_while_the_fit_gains_much_by_it():
    model = Held(3, {KEY: 2.5})
    model.hold = 1.0  # an alignment lets it come half of its way
    start, sizes = {"stiffness": 0.0, KEY: 0.0}, [*model.free, model.candidates[2].sizes[0]]
    base = climb(model, start, model.free)
    reached = [climb(model, start, sizes, before=before).fit.values[KEY] for before in (None, base)]
    assert reached[0] < 1.5 and reached[1] == pytest.approx(2.5, abs=0.3)


def test_it_is_done_once_where_that_is_all_of_the_way(monkeypatch):
    model, fitted, count = Linear(3, {KEY: 2.5}), rung_module._fitted, []
    base = climb(model, {"stiffness": 0.0}, model.free)
    monkeypatch.setattr(rung_module, "_fitted", lambda *given: count.append(1) or fitted(*given))
    climb(model, {"stiffness": 0.0, KEY: 2.4}, [*model.free, model.candidates[2].sizes[0]], before=base)
    assert len(count) == 1


def test_drives_held_out_are_judged_by_their_own_spectrum_once_they_are_aligned():
    model = Linear(3, {KEY: 0.0})
    base = climb(model, {"stiffness": 0.0}, model.free)
    worse = climb(model, {"stiffness": 0.0, KEY: 2.5}, model.free, before=base)
    power = [float(np.mean(rung.check_frame.flat(rung.check) ** 2)) for rung in (base, worse)]
    assert power[1] == pytest.approx(power[0], rel=0.05)


def test_one_that_still_gains_at_the_last_of_them_is_a_rung_like_any_other():
    model = Held(3, {KEY: 2.5})
    sizes = [*model.free, model.candidates[2].sizes[0]]
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, sizes, before=climb(model, {"stiffness": 0.0}, model.free))
    assert 0.0 < rung.fit.values[KEY] < 1.5 and set(rung.raw) == {size.key for size in sizes}


def test_what_a_fit_leaves_is_told_of_drivers_who_are_brought_to_the_path_for_it():
    model = Held(3, {KEY: 2.5})
    rung = climb(model, {"stiffness": 0.0, KEY: 0.0}, [*model.free, model.candidates[2].sizes[0]])
    assert rung.experiment.size == rung.fit.values[KEY] != 0.0
    for index, residual in rung.fit.residuals.items():
        np.testing.assert_array_equal(residual, rung.experiment.residual(rung.fit.values, index))
    assert rung.fit.loss == pytest.approx(float(np.sum(rung.frame.flat(rung.fit.residuals) ** 2)))
