"""The ladder starts with all of the explainable error and ends at the floor; sections are counted as they are graded."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import critical
from ridecomfort.discrepancy.ladder import LEVEL, Measured, disagreeing, helps, ladder, risen, worsened


def comparison(*squares, floor=1.0, states=("reference", "calibrated"), by_stretch=None, start=0.0):
    """A comparison of a fitted and a check drive of one signal with these mean squares by state, in each stretch if not given ``by_stretch``, from
    ``start`` (m) on."""
    values = np.sqrt(np.array(squares))[:, None, None] * np.ones((1, 2, 1))
    stretches = np.array(squares)[:, None] * np.ones(4) if by_stretch is None else np.array(by_stretch, float)
    return xr.Dataset(
        {
            "explainable_rmse": (("state", "drive", "signal"), np.sqrt(values**2 - floor)),
            "nrmse": (("state", "drive", "signal"), 0.1 * values),
            "floor_rmse": (("drive", "signal"), np.full((2, 1), np.sqrt(floor))),
            "square_by_stretch": (("state", "drive", "signal", "stretch_of_road"), stretches[:, None, None] * np.ones((1, 2, 1, 1))),
            "role": ("drive", ["fit", "check"]),
        },
        {"state": list(states), "drive": ["one", "slow"], "signal": ["a_z"], "stretch_of_road": start + 100.0 * np.arange(stretches.shape[-1])},
        {"floor": "from repeats"},
    )


def of_two(own, other, floor=1.0):
    """A comparison of two signals, a_z and a_y."""
    second = comparison(*other, floor=floor).assign_coords(signal=["a_y"])
    return xr.concat([comparison(*own), second], "signal", data_vars="minimal", join="outer")


def sections(*simulated, measured=(0, 1, 2, 0), groups=(0, 1), first=0, length=5.0):
    """Graded sections from the ``first`` on; ``simulated`` by state."""
    grade = np.array([measured, *simulated], np.int8)[:, None, None, :] * np.ones((1, 2, 2, 1), np.int8)
    return xr.Dataset(
        {
            "grade": (("source", "method", "drive", "window"), grade),
            "window_start": ("window", first * length + length * np.arange(grade.shape[-1])),
            "repeat_group": ("drive", list(groups)),
        },
        {"source": ["measured", "reference", "calibrated"], "method": list(critical.METHODS), "drive": ["one", "slow"]},
        {"critical_length": length},
    )


@pytest.fixture(scope="module")
def found():
    comparisons = {"base": comparison(9.0, 5.0), "one": comparison(9.0, 3.0), "one+two": comparison(9.0, 1.0)}
    graded = {
        "base": sections((0, 0, 0, 0), (1, 0, 0, 0)),
        "one": sections((0, 0, 0, 0), (0, 1, 0, 0)),
        "one+two": sections((0, 0, 0, 0), (0, 1, 2, 0)),
    }
    return ladder({"ts1": Measured(comparisons, graded, True)}, list(comparisons), ["+ one", "+ two"])


def test_shares_left_fall_from_one_to_nought(found):
    assert list(found["rung"].values) == ["uncalibrated", "calibrated", "+ one", "+ two"]
    for group in ("fitted", "held out"):
        chosen = found.sel(site="ts1", group=group)
        assert chosen["left"].sel(signal="a_z").values == pytest.approx([2.0, 1.0, 0.5, 0.0])
        assert chosen["left_overall"].values == pytest.approx([2.0, 1.0, 0.5, 0.0])
    assert found["rmse"].sel(site="ts1", group="fitted", signal="a_z").values == pytest.approx(np.sqrt([9.0, 5.0, 3.0, 1.0]))


def test_models_are_compared_where_all_have_been():
    """Drives that are aligned for each of them begin and end a little apart: a stretch or a section more or less."""
    base = comparison(9.0, 5.0, by_stretch=[[9.0] * 7, [1.0] + [5.0] * 6])
    later = comparison(9.0, 3.0, by_stretch=[[9.0] * 7, [4.0] * 6 + [99.0]], start=100.0)
    graded = {"base": sections((0, 0, 0, 0), (2, 0, 1, 0)), "one": sections((0, 0, 0, 0), (0, 1, 0, 9), measured=(1, 2, 0, 0), first=1)}
    found = ladder({"ts1": Measured({"base": base, "one": later}, graded, True)}, ["base", "one"], ["+ one"]).sel(site="ts1", rung="+ one")
    for group in ("fitted", "held out"):
        chosen = found.sel(group=group)
        assert float(chosen["falling"]) == 1.0 and float(chosen["fall_p_value"]) == pytest.approx(1 / 64)
        assert (chosen["compared"] == 3).all() and (chosen["changed"] == 0).all()


def test_sections_are_the_same_whatever_their_length_and_a_drive_counts_where_it_is_known_of_all_models():
    still, models = [comparison(9.0, 5.0), comparison(9.0, 5.0)], ("base", "one")
    calm = np.zeros(400)
    base, one = (sections(calm, calm, measured=calm, first=first, length=4.6) for first in (3, 4))
    found = ladder({"ts1": Measured(dict(zip(models, still)), {"base": base, "one": one}, True)}, models, ["+ one"])
    assert (found["compared"].sel(rung="+ one") == 399).all()

    base, one = (sections((0, 0, 0, 0), (0, 0, 0, 0), measured=(0, 1, 2, 0)) for _ in models)
    base["grade"][:, :, 1, 0] = critical.NOT_DRIVEN  # where the second drive is not compared yet
    found = ladder({"ts1": Measured(dict(zip(models, still)), {"base": base, "one": one}, True)}, models, ["+ one"]).sel(site="ts1", rung="+ one")
    assert (found["compared"].sel(group="held out") == 3).all() and (found["compared"].sel(group="fitted") == 4).all()
    assert (found["changed"] == 0).all() and (found["changed_in_all"] == 0).all()


def test_a_fall_is_as_sure_as_the_stretches_that_it_is_met_in():
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in ("base", "one")}
    base = [[9.0] * 6, [5.0, 5.0, 5.0, 5.0, 5.0, 45.0]]

    def against(*better):
        models = {"base": comparison(9.0, 5.0, by_stretch=base), "one": comparison(9.0, 3.0, by_stretch=[[9.0] * 6, list(better)])}
        chosen = ladder({"ts1": Measured(models, graded, True)}, list(models), ["+ one"]).sel(site="ts1", group="held out", rung="+ one")
        return float(chosen["falling"]), float(chosen["fall_p_value"])

    # All six of six by chance in 1 of 64 cases, however much of the fall the rough stretch holds.
    assert against(4.0, 4.0, 4.0, 4.0, 4.0, 5.0) == pytest.approx((1.0, 1 / 64))
    falling, chance = against(6.0, 6.1, 6.2, 6.3, 6.4, 5.0)  # one rough stretch falls, all others rise
    assert falling == pytest.approx(1 / 6) and chance > LEVEL
    assert against(*base[1]) == (0.0, 1.0)


def test_few_stretches_do_not_tell_whether_an_error_falls(found):
    assert np.isnan(found["fall_p_value"]).all() and np.isnan(found["falling"]).all()


@pytest.mark.parametrize(
    "fall, p_value, said", [(0.2, 0.01, "yes"), (0.001, 0.01, "little"), (0.2, 0.3, "no"), (-0.2, 0.01, "no"), (np.nan, np.nan, "")]
)
def test_a_model_helps_that_lowers_the_error_for_certain_and_by_enough(fall, p_value, said):
    assert helps(fall, p_value) == said


def test_sections_are_compared_with_the_measured_and_with_the_rung_before(found):
    chosen = found.sel({"site": "ts1", "group": "fitted", "method": "thresholds"})
    assert chosen["compared"].values.tolist() == [4, 4, 4, 4]
    assert chosen["critical_measured"].values.tolist() == [2, 2, 2, 2]
    assert chosen["critical_simulated"].values.tolist() == [0, 1, 1, 2]
    assert chosen["agreeing"].values.tolist() == [2, 1, 3, 4]
    assert np.isnan(chosen["changed"].values[0]) and chosen["changed"].values[1:].tolist() == [1, 2, 1]
    assert np.isnan(chosen["changed_in_all"].values[:2]).all() and chosen["changed_in_all"].values[2:].tolist() == [2, 3]


def test_the_floor_is_the_least_that_any_rung_shows():
    base, better = comparison(5.0, 5.0, floor=2.0), comparison(5.0, 1.0, floor=0.5)
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in ("base", "one")}
    found = ladder({"ts1": Measured({"base": base, "one": better}, graded, True)}, ["base", "one"], ["+ one"])
    assert found["floor_rmse"].sel(site="ts1", group="fitted").item() == pytest.approx(np.sqrt(0.5))


def test_a_floor_that_is_taken_as_nil_beside_one_model_is_not_less_than_one_that_is_known():
    """Two drives repeat one another beside the first model, and by a hair not beside the second."""
    base, better = comparison(5.0, 5.0, floor=1.0), comparison(5.0, 1.0, floor=0.0).assign_attrs(floor="taken as nil: no drive was repeated")
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in ("base", "one")}
    for models in (("base", "one"), ("one", "base")):
        found = ladder({"ts1": Measured({"base": base, "one": better}, graded, True)}, models, ["+ one"])
        assert found["floor_rmse"].sel(site="ts1", group="fitted").item() == pytest.approx(1.0)
        assert found["floor_known"].item() == "from repeats"


def test_drives_of_a_site_that_was_not_fitted_are_all_held_out():
    graded = {"base": sections((0, 0, 0, 0), (0, 0, 0, 0))}
    found = ladder({"ts2": Measured({"base": comparison(9.0, 5.0)}, graded, False)}, ["base"], [])
    assert found["rmse"].sel(group="fitted").isnull().all() and found["rmse"].sel(group="held out").notnull().all()


def test_a_signal_at_its_floor_has_nothing_left_to_tell():
    graded = {"base": sections((0, 0, 0, 0), (0, 0, 0, 0))}
    found = ladder({"ts1": Measured({"base": comparison(1.01, 1.01)}, graded, True)}, ["base"], [])
    assert found["left"].isnull().all()


def test_a_signal_at_its_floor_does_not_count_among_all_signals_either():
    """A rung that lowers its floor by a thousandth would else count what the uncalibrated vehicle made worse of it."""

    models = {"base": of_two((9.0, 5.0), (3.0, 1.001)), "one": of_two((9.0, 3.0), (3.0, 0.999), floor=0.998)}
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in models}
    for names, titles in ((["base"], []), (["base", "one"], ["+ one"])):
        found = ladder({"ts1": Measured({name: models[name] for name in names}, graded, True)}, names, titles)
        assert found["left"].sel(signal="a_y").isnull().all()
        assert found["left_overall"].sel(group="fitted").values[:2, 0] == pytest.approx([2.0, 1.0])


def test_repeats_say_how_well_a_perfect_model_could_agree():
    one = sections((0, 0, 0, 0), (0, 0, 0, 0), groups=(2, 2))
    one["grade"][0, 0, 1, 0] = 1  # the second repeat is graded otherwise by thresholds in one section of four
    same = comparison(9.0, 5.0).assign(role=("drive", ["fit", "fit"]))
    found = ladder({"ts1": Measured({"base": same}, {"base": one}, True)}, ["base"], [])
    assert found["repeats_agreeing"].sel(site="ts1", group="fitted").values == pytest.approx([0.75, 1.0])


def test_a_model_that_leaves_more_than_the_one_before_it_is_named_and_so_is_one_whose_starts_disagree():
    squares = {"base": (9.0, 5.0), "one": (9.0, 3.0), "one+two": (9.0, 4.0)}
    starts = {"base": "agree", "one": "starts disagree: so far", "one+two": "agree"}
    models = {name: comparison(*each).assign_attrs(starts=starts[name]) for name, each in squares.items()}
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in models}
    found = ladder({"ts1": Measured(models, graded, True), "ts2": Measured(models, graded, False)}, list(models), ["+ one", "+ two"])
    # Of the 4 above the floor the first effect leaves 2, the second 3; on ts2 nothing was fitted, and the calibration is that of ts1.
    assert risen(found) == [("ts1", "+ two leaves 75 % on the fitted drives, more than the 50 % without it")]
    assert disagreeing(found) == [("ts1", "+ one: starts disagree: so far")]


def test_a_model_that_makes_one_signal_worse_while_all_together_fall_may_stand_in_for_another():
    models = {"base": of_two((30.0, 5.0), (2.0, 3.0)), "one": of_two((30.0, 3.0), (2.0, 2.5))}
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in models}
    found = ladder({"ts1": Measured(models, graded, True)}, list(models), ["+ one"])
    # Calibrated a_z leaves 4 of 29 above the floor and a_y 2 instead of 1; the effect lowers both.
    assert worsened(found) == [
        (
            "ts1",
            "calibrated: on drives held out the error grows in a_y (100 % left after 50 %), though it falls over all signals: "
            "what was fitted may stand in for something that is missing",
        )
    ]


def test_a_signal_that_rises_by_little_of_its_floor_is_not_told_however_much_of_what_was_left_that_is():
    """A y lay 0.1 above a floor of 1, and lies 0.2 above it: a tenth of the floor, but as much as all that was left."""
    models = {"base": of_two((30.0, 5.0), (2.0, 1.1)), "one": of_two((30.0, 3.0), (2.0, 1.2))}
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in models}
    found = ladder({"ts1": Measured(models, graded, True)}, list(models), ["+ one"])
    left = found["left"].sel(rung=["calibrated", "+ one"], site="ts1", group="held out", signal="a_y").values
    assert left == pytest.approx([1.0, 2.0]) and worsened(found) == []


def test_a_model_that_makes_one_signal_worse_is_told_of_the_nominal_vehicle_too():
    """It has no calibrated rung that its first effect could be put beside."""
    base = of_two((30.0, 30.0), (2.0, 2.0)).sel(state=["reference"])
    one = of_two((30.0, 3.0), (2.0, 2.5)).assign_coords(state=["reference", "with_effects"])
    both = sections((0, 0, 0, 0), (0, 0, 0, 0)).assign_coords(source=["measured", "reference", "with_effects"])
    graded = {"base": both.sel(source=["measured", "reference"]), "one": both}
    found = ladder({"ts1": Measured({"base": base, "one": one}, graded, False)}, ["base", "one"], ["+ one"])
    assert worsened(found) == [
        (
            "ts1",
            "+ one: on drives held out the error grows in a_y (150 % left after 100 %), though it falls over all signals: "
            "what was switched on may stand in for something that is missing",
        )
    ]


def test_a_signal_that_leaves_its_floor_is_told_though_no_share_of_it_was_left_before():
    models = {"base": of_two((30.0, 5.0), (1.0, 1.0)), "one": of_two((30.0, 3.0), (1.0, 4.0))}
    graded = {name: sections((0, 0, 0, 0), (0, 0, 0, 0)) for name in models}
    found = ladder({"ts1": Measured(models, graded, True)}, list(models), ["+ one"])
    ((site, said),) = worsened(found)
    assert site == "ts1" and said.startswith("+ one: on drives held out the error grows in a_y (2 times as large), of which nothing was left above the floor: ")


def test_a_ladder_that_falls_has_nothing_to_say(found):
    assert risen(found) == [] and worsened(found) == [] and disagreeing(found) == []
