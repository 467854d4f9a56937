"""The missing force as a curve: drawn without a form in mind, it shows the one that is missing."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import curves, opening
from ridecomfort.discrepancy.experiment import simulate
from ridecomfort.discrepancy.rung import begin
from ridecomfort.discrepancy.signature import _Estimate, signature
from ridecomfort.effects import library
from ridecomfort.effects.contract import COMPILED, PORTS
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import describe
from tests.blind import trials
from tests.described import undescribed
from tests.effects import whole


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


def drawn(car, name: str):
    """Curves of drives in which an effect is hidden, with that of the effect."""
    trial = trials.make(7, car, {name: library.find()[name].effect.values()}, 1.0)
    experiment = opening.opened(trial.measured, car, among=(), workers=1)
    rung = begin(experiment, {**opening.start_values(experiment), **trial.truth["car"]})
    hidden = {f"{effect}.{key}": value for effect, sizes in trial.truth["effects"].items() for key, value in sizes.items()}
    found = simulate(rung.experiment, {**rung.fit.values, **trial.truth["car"], **hidden}, rung.fit.residuals)
    return signature(rung, found=found, ports=[library.find()[name].effect.port])


@pytest.fixture(scope="module")
def found(car):
    return drawn(car, "suspension_friction")


def test_friction_shows_as_a_step_where_the_velocity_turns(found):
    curve = found.sel(seen="strut velocity")
    slow = np.abs(curve["seen_at"]) < 0.2
    for axle in ("front", "rear"):
        own = curve.sel(axle=axle)
        expected = own["named_missing"]
        assert float(expected.max()) > 15
        off = np.abs(own["missing"] - expected)[slow]
        # Friction turns within 2 mm/s, the curve between knots 40 mm/s apart.
        assert float(off.max()) < 0.4 * float(expected.max())


def test_the_place_where_the_force_acts_explains_most(found):
    assert str(found["seen"].values[int(np.argmax(found["seen_share"].values))]) == "strut velocity"


def test_curves_tell_their_units(found):
    assert undescribed(describe(found.copy())) == []


def test_a_force_at_rest_does_not_show(found):
    at_rest = found["missing"].where(found["seen_at"] == 0).max("knot")
    np.testing.assert_allclose(at_rest.values, 0.0, atol=1e-9)


def test_what_the_true_effect_would_show_lies_within_the_errors_in_the_curves_of_other_places_too(found):
    others = found.sel(seen=["strut deflection", "tyre deflection"])
    off = np.abs(others["missing"] - others["named_missing"]) / others["missing_error"].where(others["seen_at"] != 0)
    assert int(off.notnull().sum()) > 10
    assert float((off < 3.0).sum() / off.notnull().sum()) > 0.8


@pytest.mark.long
def test_stiffness_that_grows_less_than_the_load_shows_as_a_falling_line(car):
    found = drawn(car, "cornering_degression")
    curve = found.sel(seen="tyre load")
    assert str(found["seen"].values[int(np.argmax(found["seen_share"].values))]) == "tyre load"
    assert curve["missing_unit"].item() == "1"
    met = (curve["seen_at"] > 2000) & (curve["seen_at"] < 6000)
    for axle in ("front", "rear"):
        own = curve.sel(axle=axle).where(met, drop=True)
        slope = np.polyfit(own["seen_at"], own["missing"], 1)[0]
        # The effect file: stiffness per load falls by 0.7 over a reference load of 4000 N.
        assert slope == pytest.approx(-0.7 / 4000.0, rel=0.15)


def test_only_what_acts_where_named_effects_do_is_estimated_beside_struts_and_tyres(found):
    assert list(found["seen"].values) == ["strut velocity", "strut deflection", "tyre deflection"]
    assert list(curves.at(["kinematics"])) == ["strut velocity", "strut deflection", "tyre deflection", "wheel travel"]


def test_dampers_that_are_joined_show_as_a_line_over_what_moves_them(car):
    """Of 300 N s/m: no damper of a single strut, which calibration could change, does what they do."""
    trial = trials.make(7, car, {}, 0.0)
    experiment = opening.opened(trial.measured, car, among=(), workers=1)
    rung = begin(experiment, {**opening.start_values(experiment), **trial.truth["car"]})
    joined = {"joined_dampers.damping": 300.0}
    # Beside all others at neutral: the kernel that has them all is compiled for other tests, too.
    neutral = {name: sizes for name, sizes in whole.NEUTRAL.items() if whole.ENTRIES[name].effect.port in COMPILED}
    with_them = opening.opened(trial.measured, car, effects=neutral, effects_folder=whole.FOLDER, among=(), workers=1)
    missing = simulate(with_them, {**rung.fit.values, **joined}, rung.fit.residuals)
    found = signature(rung, found=missing, ports=["interconnection"]).sel(seen="strut against other axle")
    for axle in ("front", "rear"):
        own = found.sel(axle=axle).dropna("knot")
        assert float(own["seen_at"].max()) >= 0.3
        slope = np.polyfit(own["seen_at"], own["named_missing"], 1)[0]
        assert slope == pytest.approx(300.0, rel=0.15)


@pytest.mark.parametrize("seen", curves.SEEN.values(), ids=curves.SEEN.keys())
def test_a_curve_returns_what_its_port_does(seen, tmp_path):
    """At a knot, its value there; on the left and on the right side of the front axle."""
    (tmp_path / "drawn.py").write_text(curves.source("drawn", seen))
    act = library.find(tmp_path)["drawn"].act
    motion, _, against = seen.expression.partition(" - ")
    given = {key: float(key != against) for key in PORTS[seen.port].sees} | {motion: seen.knots[1]}
    values = {size.key.partition(".")[2]: 0.0 for size in curves.candidate("drawn", seen).sizes} | {"front_1": 0.5 * seen.usual}
    for wheel in (0, 1):
        found = act(**{**given, "wheel": wheel}, **values)
        told = found if isinstance(found, tuple) else (found,)
        assert len(told) == len(PORTS[seen.port].returns)
        plain = act(**{**given, "wheel": wheel}, **(values | {"front_1": 0.0}))
        assert told != (plain if isinstance(plain, tuple) else (plain,))


def test_what_changes_nothing_has_no_curve(car):
    experiment = opening.opened(trials.make(7, car, {}, 1.0).measured, car, among=(), workers=1)
    rung = begin(experiment, opening.start_values(experiment))
    white = np.zeros((1, rung.frame.flat(rung.fit.residuals).size))
    estimate = _Estimate(rung.frame, white, white[:0])
    curve = estimate(({}, curves.SEEN["tyre load"]))
    assert np.isnan(curve.missing).all() and curve.share == 0.0
