"""Which refits the data do not tell from the best."""

from __future__ import annotations

from dataclasses import replace

import pytest

from .linear import Linear, judged


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
