"""Parameters that calibration holds are told where drives give them other values than the vehicle's file, and that matters."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from ridecomfort.discrepancy import amended, judge, select
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.off_file import Held, OffFile, off_file

from .coloured import coloured
from .linear import SAMPLES, Linear


class OfVehicle(Linear):
    """A linear model whose vehicle has an inertia and a height, too, that calibration holds at nil."""

    def __init__(self, truth, power=30.0):
        super().__init__(6, truth, library=2)
        random = np.random.default_rng(60)
        held = [Size(key, "kg m2", 0.0, -5.0, 5.0, 0.1, held=True) for key in ("inertia", "height")]
        self.free += tuple(held)
        for columns in {id(own): own for own in self.columns}.values():
            columns.update({size.key: coloured(random, SAMPLES) for size in held})
        self.signals = np.sqrt(power) * coloured(random, SAMPLES)

    def measured(self, index):
        return self.signals


def searched(model):
    return select.select(model, dict.fromkeys(("stiffness", "inertia", "height"), 0.0), most=1)


def test_one_that_drives_find_elsewhere_is_told_with_its_interval_and_with_what_holding_it_costs():
    selection = searched(OfVehicle({"inertia": 1.5, "effect_1.size": 1.0}))
    found = off_file(selection)
    (inertia,) = found.parameters
    assert (inertia.parameter, inertia.unit, inertia.given) == ("inertia", "kg m2", 0.0)
    assert inertia.value == pytest.approx(1.5, abs=0.1) and inertia.interval[0] < 1.5 < inertia.interval[1]
    mean = np.mean(list(found.left.values()))
    assert mean == pytest.approx(1.5**2 / 30.0, rel=0.3), "the power of its column is one, that of the signals thirty"
    assert found.words().startswith("the drives ask for inertia 1.") and "which calibration holds" in found.words()


def test_its_verdict_says_so_and_names_what_is_missing_beside_it():
    model = OfVehicle({"inertia": 1.5, "effect_1.size": 1.0})
    selection = searched(model)
    found = amended.with_held(judge.judge(selection, model.candidates), off_file(selection))
    assert [effect.name for effect in found.effects] == ["effect_1"] and found.reasons[-1] == found.off_file.words()
    assert found.json()["off_file"]["parameters"][0]["parameter"] == "inertia"


def test_where_drives_agree_with_the_file_nothing_is_told():
    model = OfVehicle({"effect_1.size": 1.0})
    selection = searched(model)
    assert off_file(selection) is None
    said = judge.judge(selection, model.candidates)
    assert amended.with_held(said, None) is said


def test_nor_where_it_matters_to_no_signal():
    selection = searched(OfVehicle({"inertia": 0.4}, power=1e4))
    assert selection.intervals["inertia"][0] > 0.0 and off_file(selection) is None


def test_what_is_more_than_half_of_the_floor_matters_however_large_the_signals_are():
    """As of dampers and inertias 4 % beside the file and quiet instruments: with both effects named and right, half of the error stayed on the
    ladder, and less than a thousandth of the power of any signal."""
    selection = searched(OfVehicle({"inertia": 1.5}, power=1e4))
    found = off_file(selection)
    assert max(found.left.values()) < 0.001
    assert list(found.of_floor.values()) == pytest.approx([1.5**2] * 4, rel=0.3), "its column is as large as the noise"
    assert " times the floor of " in found.words() and found.words().endswith(" is left")


@pytest.mark.parametrize(("size", "is_told"), [(0.4, True), (2.0, False)])
def test_what_is_as_much_as_small_effects_remove_matters_beside_these(size, is_told):
    """As of a top mount of a tenth of its usual size and an inertia 3 % beside the file: on the ladder, beside the inertia of the file, it did not help."""
    selection = searched(OfVehicle({"inertia": 0.4, "effect_1.size": size}, power=1e4))
    assert selection.accepted == ("effect_1",) and off_file(selection) is None
    found = off_file(selection, is_named=True)
    assert (found is not None) is is_told
    if is_told:
        assert found.of_gone == pytest.approx(1.0, abs=0.3)
        assert re.search(r"with the values of the file another \d+ % of what the effects remove is left$", found.words())


def test_where_no_floor_is_known_only_power_tells():
    selection = searched(OfVehicle({"inertia": 1.5}, power=1e4))
    assert off_file(replace(selection, floor_squares=0.0 * selection.floor_squares)) is None


def test_what_does_little_beside_another_is_not_told():
    """The height is surely not as the file says, but does a hundredth of what the inertia does."""
    (inertia,) = off_file(searched(OfVehicle({"inertia": 4.0, "height": 0.4}))).parameters
    assert inertia.parameter == "inertia"


def test_what_is_told_already_is_not_told_again_and_is_fitted_beside_the_others():
    """A bar beyond its bounds, say, that comes first: the inertia beside it is told in the same verdict."""
    selection = searched(OfVehicle({"inertia": 1.5, "height": 2.0}))
    assert {one.parameter for one in off_file(selection).parameters} == {"inertia", "height"}
    (inertia,) = off_file(selection, ["height"]).parameters
    assert inertia.parameter == "inertia" and inertia.value == pytest.approx(1.5, abs=0.1)


def test_one_at_its_bound_has_no_value_that_drives_give_it():
    selection = searched(OfVehicle({"inertia": 1.5, "effect_1.size": 1.0}))
    (size,) = (size for size in selection.frame.experiment.free if size.key == "inertia")
    at_its_bound = replace(selection, final=replace(selection.final, values={**selection.final.values, "inertia": size.upper}))
    assert off_file(selection) is not None and off_file(at_its_bound) is None


def test_what_holding_it_makes_better_is_said_beside_what_it_costs():
    found = OffFile((Held("inertia", "kg m2", 460.0, 416.0, (413.0, 418.0)),), {"a_y": 0.081, "a_x": -0.041, "a_z": 1e-5})
    assert found.words().endswith("another 8.1 % of the power of a_y is left, and 4.1 % less of that of a_x")
