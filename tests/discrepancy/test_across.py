"""Whether repeats bear out what speaks for an effect on one of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import judge
from ridecomfort.discrepancy.across import Borne, borne_out
from ridecomfort.discrepancy.rung import begin

from .coloured import coloured
from .linear import SAMPLES, Linear, judged


def answering(seed, is_missing, own=0.6):
    """The frame of a model without anything but one column, that column, and its residuals: what it does answers to what is alike in repeats, and so far
    to noise of each record's ``own``; of it all is missing, or, as noise moves a model, what answers to noise alone."""
    rng, model = np.random.default_rng(seed), Linear(seed, {})
    rung = begin(model, {"stiffness": 0.0})
    alike = coloured(rng, SAMPLES)
    noise = {index: own * coloured(rng, SAMPLES) for index in rung.frame.indices}
    column = {index: alike + part for index, part in noise.items()}
    wrong = column if is_missing else noise
    return rung.frame, {index: rung.fit.residuals[index] - 0.2 * part for index, part in wrong.items()}, column


@pytest.mark.parametrize("seed", range(4))
def test_what_is_missing_on_every_repeat_is_borne_out_and_what_answers_to_noise_is_not(seed):
    is_there, is_noise = (borne_out(*answering(seed, is_missing)) for is_missing in (True, False))
    assert is_there.share == pytest.approx(1.0, abs=0.2) and is_there.z > 8.0
    assert is_noise.share == pytest.approx(0.0, abs=0.3) and abs(is_noise.z) < 3.0


def test_what_is_fitted_anyway_says_nothing_of_what_repeats_bear_out():
    """Nine tenths of the power of what an effect does are what a free parameter does, too, which a fit has taken out of the residuals."""
    frame, residuals, column = answering(1, is_missing=True)
    taken_up = 3.0 * coloured(np.random.default_rng(9), SAMPLES)
    free, absorbed = dict.fromkeys(column, taken_up), {index: part + taken_up for index, part in column.items()}
    alone, beside = borne_out(frame, residuals, column), borne_out(frame, residuals, absorbed, [free])
    assert beside.share == pytest.approx(alone.share, abs=0.1) and beside.z == pytest.approx(alone.z, rel=0.1)
    assert borne_out(frame, residuals, absorbed).z < 0.5 * alone.z


def test_repeats_on_which_an_effect_does_something_else_bear_nothing_out():
    assert np.isnan(borne_out(*answering(1, is_missing=True, own=3.0))).all()


def test_without_repeats_nobody_knows():
    frame, residuals, column = answering(1, is_missing=True)
    frame.experiment.records[:] = [replace(record, condition=record.name) for record in frame.experiment.records]
    assert np.isnan(borne_out(frame, residuals, column)).all()


def test_an_effect_that_a_search_found_where_it_is_missing_is_borne_out():
    selection, found = judged(Linear(2, {"effect_2.size": 1.0}))
    assert selection.rounds[0].borne.share == pytest.approx(1.0, abs=0.1) and np.isnan(selection.rounds[-1].borne.share)
    assert found.verdict == "named"


OF_NOISE = "effect_2 helps every drive by what it does in that drive, and hardly by what it does in its repeats"


@pytest.mark.parametrize(("borne", "said"), [(Borne(0.3, 9.0), OF_NOISE), (Borne(0.7, 2.0), "effect_2 may be chance or noise of what the model is driven with")])
def test_what_repeats_do_not_bear_out_has_no_name(borne, said):
    model = Linear(2, {"effect_2.size": 1.0})
    selection, _ = judged(model)
    rounds = [replace(turn, borne=borne) if turn.winner else turn for turn in selection.rounds]
    found = judge.judge(replace(selection, rounds=tuple(rounds), shared_z=1.0), model.candidates, is_material=False, was_material=False)
    assert found.verdict == "nothing" and not found.effects and found.share == 0.0
    assert found.reasons[0].startswith(said)
