"""A vehicle's file that is farther off than it was thought to be."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import beyond, diagnose, opening, refit, rung, select
from ridecomfort.discrepancy.experiment import Size
from ridecomfort.discrepancy.amended import with_parameters
from ridecomfort.discrepancy.verdict import Named, Verdict
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import trials

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def measured(car, wrong, effects=None, seed=41):
    """Drives of a car some of whose parameters are these many times what its file says."""
    true = car.replace(**{name: factor * car[name] for name, factor in wrong.items()})
    return trials.make(seed, true, effects or {}, 1.0).measured


def selected(drives, car, library="crosswind"):
    experiment = opening.car(opening.sites_of(drives), car, library_names=[library])
    return select.search(rung.begin(experiment, opening.start_values(experiment)), most=1)


def holds(one, truth):
    return one.interval[0] < truth < one.interval[1] and not one.bounds[0] < one.value < one.bounds[1]


@pytest.mark.long
def test_a_bar_twice_as_stiff_and_an_inertia_of_seven_tenths_are_told_with_what_they_explain(car):
    wrong = {"anti_roll_stiffness_rear": 2.0, "roll_inertia": 0.7}
    told, _ = beyond.beyond_bounds(selected(measured(car, wrong), car))
    by_name = {one.parameter: one for one in told.parameters}
    assert all(holds(by_name[name], factor * car[name]) for name, factor in wrong.items())
    assert told.share > 0.3 and told.held_out_share > 0.3 and "roll_inertia" in told.words(is_more=False)


def test_nothing_is_told_of_a_car_that_is_within_its_bounds(car):
    selection = selected(measured(car, {"anti_roll_stiffness_rear": 1.1}), car)
    assert not beyond.ends_at_bounds(selection) and beyond.beyond_bounds(selection) is None


def test_a_damper_that_ends_at_its_bound_is_told_where_nothing_is_missing(car):
    selection = selected(measured(car, {"damping_front": 1.17}), car)
    (damper,) = beyond.at_bounds(selection, selection.frame.experiment.free)
    assert not selection.accepted and (damper.parameter, damper.end) == ("damping_front", "upper")
    assert damper.words() == "damping_front at 2415 N s/m, its upper bound"


@pytest.mark.long
def test_beside_an_effect_that_is_named_the_verdict_tells_a_damper_at_its_bound(car):
    hidden = {"wheel_imbalance": library.find()["wheel_imbalance"].effect.values()}
    _, verdict, _ = diagnose(measured(car, {"damping_front": 1.17}, hidden), car, among=["wheel_imbalance"], workers=1)
    (damper,) = verdict.at_bounds
    assert verdict.verdict == "named" and (damper.parameter, damper.end) == ("damping_front", "upper")
    assert verdict.reasons[-1].startswith("damping_front at 2415 N s/m, its upper bound: ")
    assert verdict.off_file is None  # a value at a bound is not what the drives ask for


@pytest.mark.long
def test_a_bar_of_half_the_stiffness_takes_the_place_of_an_effect_that_stands_in_for_it(car):
    stand_in = selected(measured(car, {"anti_roll_stiffness_front": 0.54}), car, "tyre_pressure_loss")
    assert stand_in.accepted
    right = beyond.before_effects(stand_in)
    told = beyond.searched(stand_in, select.search(right, most=1))
    (bar,) = told.parameters
    assert bar.parameter == "anti_roll_stiffness_front" and holds(bar, 0.54 * car["anti_roll_stiffness_front"])
    assert told.is_first and told.held_out_share > 0.5


@pytest.mark.long
def test_a_clock_that_is_off_is_seen_beside_a_wrong_file(car):
    """The first search, which leaves too much, cannot tell it."""
    true = car.replace(anti_roll_stiffness_rear=2.0 * car["anti_roll_stiffness_rear"], roll_inertia=0.7 * car["roll_inertia"])
    drives = trials.make(41, true, {}, clock=0.008).measured
    table, verdict, _ = diagnose(drives, car, among=["crosswind"], workers=1)
    assert verdict.verdict == "suspect" and any("clock" in reason for reason in verdict.reasons)
    assert {one.parameter for one in verdict.beyond_bounds.parameters} >= {"anti_roll_stiffness_rear", "roll_inertia"}


@pytest.mark.long
def test_an_effect_that_is_missing_beside_a_wrong_file_is_named_alone(car):
    """Without the damping put right, friction of the struts would stand in for it."""
    hidden = {"top_mount": library.find()["top_mount"].effect.values()}
    drives = measured(car, {"damping_front": 1.45}, hidden, seed=5002)
    _, verdict, _ = diagnose(drives, car, among=["top_mount", "suspension_friction"], workers=1)
    assert verdict.verdict == "named" and [effect.name for effect in verdict.effects] == ["top_mount"]
    (damping,) = verdict.beyond_bounds.parameters
    assert damping.parameter == "damping_front" and holds(damping, 1.45 * car["damping_front"])
    assert any("other shares are of what they leave" in reason for reason in verdict.reasons)


@pytest.mark.parametrize(
    ("value", "half", "birge", "end"),
    [(15000.0, 3000.0, 1.0, "lower"), (39990.0, 3000.0, 1.0, "upper"), (15100.0, 3000.0, 1.0, None), (15000.0, 11000.0, 1.0, None),
     (15000.0, 11000.0, 1.5, "lower")],
)  # fmt: skip
def test_a_spring_that_ends_at_a_bound_is_told_where_fitted_drives_tell_it(value, half, birge, end):
    """Told is one that is known to an eighth of the bounds to either side, not one known hardly better than they say themselves; what
    drives held out widened its interval by does not count."""
    spring, size = "spring_stiffness_rear", Size("suspension_friction.front", "N", 0.0, 0.0, 300.0, 10.0)
    free = (Size(spring, "N/m", 31800.0, 15000.0, 40000.0, 500.0), size)
    selection = SimpleNamespace(
        frame=SimpleNamespace(experiment=SimpleNamespace(free=free)), final=SimpleNamespace(values={spring: value, size.key: 0.0}),
        intervals={spring: (value - half, value + half), size.key: (-1.0, 1.0)}, birge_ratio=birge,
    )  # fmt: skip
    bound = {"lower": 15000.0, "upper": 40000.0, None: None}[end]
    assert beyond.at_bounds(selection, free) == (() if end is None else (beyond.AtBound(spring, "N/m", value, bound, end),))
    narrower = (replace(free[0], lower=20000.0, upper=35000.0), size)
    assert all(one.is_wider and one.words().endswith(" that was tried beyond its bounds") for one in beyond.at_bounds(selection, narrower))


@pytest.mark.parametrize(
    ("alone", "kept", "whole", "told_as"),
    [(-0.1, 1, 0.99, "first"), (-0.1, 1, 0.97, "as good"), (-0.1, 1, 0.94, "as good"), (-0.1, 1, 0.92, None), (-0.1, 2, 0.99, None),
     (0.3, 2, 0.99, None), (0.97, 0, 0.97, "first"), (-0.1, 0, 0.96, None)],
)  # fmt: skip
def test_a_wrong_file_is_told_of_which_fewer_effects_leave_half_and_beside_those_that_leave_no_less(monkeypatch, alone, kept, whole, told_as):
    """Two effects remove 95 %. Parameters, put right, remove ``alone``, and with the ``kept`` effects ``whole``: beside one that does nearly
    all, a wrong damper is but some percent, most of which a knee of the dampers takes; which of the two it is, drives leave open."""
    before = SimpleNamespace(kept=("roll_centre_height", "damper_knee"), states=(0.0, 0.75, 0.95), frame=SimpleNamespace(experiment=None))
    after = SimpleNamespace(
        kept=before.kept[:kept], states=(alone, whole), frame=before.frame, final=SimpleNamespace(values={}), intervals={}
    )
    damping = beyond.Beyond("damping_rear", "N s/m", 2230.0, (1895.5, 2564.5), (631.8, 7693.5), 1193.0, (1182.0, 1204.0))
    monkeypatch.setattr(beyond, "shares", lambda selection, first, last, *others: (last - first, last - first))
    monkeypatch.setattr(beyond, "_beyond", lambda *found, is_first=False: beyond.BeyondBounds((damping,), *found[-2:], is_first))
    told = beyond.searched(before, after)
    assert (told is not None) is (told_as is not None)
    if told_as == "as good":
        assert told.is_instead and not told.is_first and told.effects == ("roll_centre_height",)
        assert told.words(True).startswith(
            f"another explanation, as good, {100 * whole:.0f} % of the explainable error, {100 * whole:.0f} % on drives held out: roll_centre_height alone, "
            "with parameters of the vehicle beyond their bounds, damping_rear 1193 N s/m (1182 to 1204) for 2230"
        )
    elif told is not None and alone < 0.0:
        assert told.words(True).startswith("beside what is missing, parameters of the vehicle lie beyond their bounds: damping_rear 1193 N s/m (1182 to 1204) for 2230")


@pytest.mark.parametrize(
    ("alone", "held_out", "sizes", "is_told"),
    [(0.686, 0.575, 4, True), (0.68, 0.575, 1, True), (0.67, 0.575, 4, False), (0.686, 0.55, 4, False), (0.686, float("nan"), 4, True), (0.686, 0.575, 0, False)],
)  # fmt: skip
def test_parameters_that_do_alone_as_much_by_no_more_numbers_are_not_told_from_an_effect(monkeypatch, alone, held_out, sizes, is_told):
    """As of tyres on soft ground, which sinks under every wheel: half of the pressure is lost in all four, 69 and 58 %, or they are half as
    stiff, beyond what is published. What is accepted after that, and is little, changes nothing."""
    loss = SimpleNamespace(name="tyre_pressure_loss", sizes=(None,) * sizes)
    frame = SimpleNamespace(experiment=SimpleNamespace(candidates=(loss,)))
    before = SimpleNamespace(kept=(loss.name,), states=((0.0, 0.0), (0.694, 0.576)), frame=frame)
    after = SimpleNamespace(
        kept=("damper_asymmetry",), states=((alone, held_out), (alone, held_out)), frame=frame, final=SimpleNamespace(values={}), intervals={}
    )
    stiffness = beyond.Beyond("tyre_radial_stiffness", "N/m", 320000.0, (250000.0, 400000.0), (83333.0, 1.2e6), 142000.0, (138000.0, 146000.0))
    monkeypatch.setattr(beyond, "shares", lambda selection, first, last, *others: tuple(np.subtract(last, first)))
    monkeypatch.setattr(beyond, "_beyond", lambda *found, is_first=False: beyond.BeyondBounds((stiffness,), *found[-2:], is_first))
    told = beyond.searched(before, after)
    assert (told is not None) is is_told
    if not is_told:
        return
    assert told.is_instead and told.is_another_name and told.share == alone
    gone = "69 %" if alone == 0.686 else "68 %"
    assert told.words(True).startswith(f"another explanation, as good, {gone} of the explainable error")
    effect = Named(loss.name, (), "", 0.001, 0.694, 0.576, 0.0, (), {})
    found = with_parameters(Verdict("named", (effect,), (), 0.694, 0.576), told)
    assert found.verdict == "cluster" and found.words().startswith(
        "Missing: tyre_pressure_loss or tyre_radial_stiffness beyond its bounds; the data do not tell those apart. "
    )
    # Data are suspect for what hums: those parameters are another explanation of the effect, not of that.
    assert with_parameters(Verdict("suspect", (effect,), (), 0.694, 0.576), told).words().startswith("The data are suspect. ")


def test_other_effects_are_no_other_explanation(monkeypatch):
    """They would be another search's verdict; what is told is that parameters do as much as the effects that are dropped."""
    before = SimpleNamespace(kept=("roll_centre_height", "damper_knee"), states=(0.0, 0.95), frame=SimpleNamespace(experiment=None))
    after = SimpleNamespace(kept=("crosswind",), states=(-0.1, 0.95))
    monkeypatch.setattr(beyond, "shares", lambda selection, first, last, *others: (last - first, last - first))
    assert beyond.searched(before, after) is None


def test_the_same_effects_without_one_that_the_last_fit_does_without_are_no_fewer(monkeypatch):
    names = ("tyre_pressure_loss", "roll_centre_height", "damper_knee")
    frame = SimpleNamespace(experiment=SimpleNamespace(candidates=[SimpleNamespace(name=name, sizes=(None,) * 2) for name in names]))
    before = SimpleNamespace(accepted=names, kept=names[1:], states=(0.0, 0.95), frame=frame)
    after = SimpleNamespace(accepted=names[1:], kept=names[1:], states=(-0.1, 0.99), frame=frame)
    monkeypatch.setattr(beyond, "shares", lambda selection, first, last, *others: (last - first, last - first))
    assert beyond.searched(before, after) is None and beyond._numbers(before) == 4


def test_what_lies_beyond_but_not_surely_is_told_apart_if_it_does_as_much():
    """In bounds of 0.9 to 1.1 times the file, by 0.4, 0.4, 0.4 and 0 of it; the third parameter changes the signals a tenth as much."""
    names = "roll_inertia", "pitch_inertia", "yaw_inertia", "damping_front"
    free = tuple(Size(name, "kg m2", 1.0, 0.9, 1.1, 0.1) for name in names)
    before = SimpleNamespace(free=free, vehicle=dict.fromkeys(names, 1.0))
    fit = refit.Fit(dict(zip(names, (1.5, 1.5, 1.5, 1.0))), {}, names, np.array([[1.0, 1.0], [0.0, 1.0], [0.1, 0.0], [1.0, 0.0]]), 0.0)
    intervals = dict(zip(names, ((1.4, 1.6), (0.8, 2.2), (0.8, 2.2), (0.5, 1.5))))
    told = beyond._beyond(before, SimpleNamespace(free=free), fit, intervals, 0.4, 0.3)
    assert [one.parameter for one in told.parameters] == ["roll_inertia"]
    assert [one.parameter for one in told.less_sure] == ["pitch_inertia"]
    assert "roll_inertia 1.5 kg m2 (1.4 to 1.6) for 1, less surely pitch_inertia 1.5 kg m2 (0.8 to 2.2) for 1, of which" in told.words(is_more=False)
    unsure = {**intervals, "roll_inertia": (0.8, 2.2)}
    assert beyond._beyond(before, SimpleNamespace(free=free), fit, unsure, 0.4, 0.3) is None


@pytest.mark.long
def test_springs_beyond_their_bounds_are_told_and_no_gain_of_an_instrument(repository, monkeypatch):
    """Within the bounds an accelerometer of 1.03 fits a van best whose rear springs are 9 % stiffer than its file says, and are kept 2 % above."""
    van = parameters.read(repository / "config" / "vehicles" / "van.yaml")
    for name, value in {"SPEED": 12.0, "ACCELEROMETER": 0.06, "GYROSCOPE": 0.002}.items():
        monkeypatch.setattr(trials, name, value)
    own = opening.bounds_of(van)
    monkeypatch.setattr(trials, "BOUNDS", {name: (0.8 * van[name], 1.2 * van[name]) for name in own})
    trial = trials.make(8000, van, {})
    stiffness = trial.truth["car"]["spring_stiffness_rear"]
    assert stiffness > own["spring_stiffness_rear"][1]
    _, verdict, _ = diagnose(trial.measured, van, workers=1)
    (found,) = verdict.beyond_bounds.parameters
    assert verdict.verdict == "outside" and not verdict.effects and not any("gain" in reason for reason in verdict.reasons)
    assert found.parameter == "spring_stiffness_rear" and holds(found, stiffness)
