"""The evidence of a selection as a Dataset."""

import xarray as xr

from ridecomfort.discrepancy import ranking, select
from ridecomfort.vocabulary import describe
from tests.described import undescribed

from .linear import Linear

MODEL = Linear(2, {"effect_1.size": 0.4, "effect_4.size": 0.2})


def selection():
    return select.select(MODEL, {"stiffness": 0.0}, most=3)


def test_forces_of_any_form_stand_beside_the_library_and_come_back_as_they_were():
    table = ranking.dataset(MODEL, selection())
    assert ranking.forms(table) is None
    both = ranking.with_forms(table, table.copy())
    xr.testing.assert_identical(both[list(table.data_vars)], table)
    assert undescribed(describe(both)) == []
    again = ranking.forms(both)
    assert {"p_value", "gain", "passed_over", "trial_effect", "winner"} <= set(again.data_vars)
    xr.testing.assert_identical(again.drop_attrs(), table[list(again.data_vars)].drop_attrs())


def test_every_refit_is_told_with_its_round_and_size():
    found = selection()
    table = ranking.dataset(MODEL, found)
    trials = [(number, trial.name) for number, turn in enumerate(found.rounds, 1) for trial in turn.trials]
    assert list(zip(table["trial_round"].values, table["trial_effect"].values)) == trials
    assert all(str(words).startswith("size ") and str(words).endswith(" N") for words in table["trial_sizes"].values)


def test_the_last_model_is_not_called_by_an_effect_that_it_does_without():
    """effect_0 does nearly what effect_1 and effect_2, which are missing, do together."""
    model = Linear(1, {"effect_1.size": 2.0, "effect_2.size": 2.0})
    for columns in model.columns[2:]:  # those of all repeats are one
        columns["effect_0.size"] = columns["effect_0.size"] + columns["effect_1.size"] + columns["effect_2.size"]
    found = select.select(model, {"stiffness": 0.0}, most=3)
    assert found.needless == {"effect_0"}
    names = ranking.dataset(model, found)["model"].values.tolist()
    assert names == ["calibrated", *found.accepted[:-1], "without effect_0"]
