"""Which refits the data do not tell from the best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from .linear import Linear, judged


@pytest.mark.parametrize(("size", "where"), [(0.0, "drive 3"), (0.001, "drive 3"), (1.0, "drive 0, at 30 km/h")])
def test_the_drive_that_would_tell_two_apart_best_may_be_one_that_was_not_made(size, where):
    class Elsewhere(Linear):
        def would_differ(self, one, other, index):
            drawn = np.random.default_rng(3).standard_normal((4, 2000))
            return {"20 km/h": 0.5 * size * drawn, "30 km/h": size * drawn} if size else {}

    twins = Elsewhere(1, {"effect_2.size": 1.0}, twins=("effect_2.size", "effect_4.size"))
    selection, found = judged(twins)
    assert found.effects[0].like == ("effect_4",)
    assert selection.rounds[0].differ_on == {"effect_4": where}


@pytest.mark.parametrize(("upper", "like"), [(5.0, ()), (50.0, ("effect_4",))])
def test_what_would_have_to_be_larger_than_is_plausible_is_no_other_name_of_what_is_missing(upper, like):
    """A twin of effect_2 that needs seven times its size, 7, where no more than ``upper`` is plausible."""
    model = Linear(1, {"effect_2.size": 1.0})
    for own in {id(columns): columns for columns in model.columns}.values():
        own["effect_4.size"] = (own["effect_2.size"] + 0.003 * own["effect_4.size"]) / 7.0
    twin = replace(model.candidates[4].sizes[0], upper=upper, probe=0.7)
    model.candidates = tuple(replace(one, sizes=(twin,)) if one.name == "effect_4" else one for one in model.candidates)
    selection, found = judged(model)
    (objection,) = (trial.objection for trial in selection.rounds[0].trials if trial.name == "effect_4")
    assert ("lies outside what is plausible" in objection) is not bool(like)
    assert found.verdict == ("cluster" if like else "named")
    assert [(effect.name, effect.like) for effect in found.effects] == [("effect_2", like)]
    assert not any("effect_4 in the place of" in reason for reason in found.reasons)
