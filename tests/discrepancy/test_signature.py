"""The missing force as a curve: drawn without a form in mind, it shows the one that is missing."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import opening
from ridecomfort.discrepancy.rung import begin
from ridecomfort.discrepancy.signature import signature
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import trials


@pytest.fixture(scope="module")
def found(repository):
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    trial = trials.make(7, car, {"suspension_friction": library.find()["suspension_friction"].effect.values()}, 1.0)
    experiment = opening.opened(trial.measured, car, among=(), workers=1)
    rung = begin(experiment, {**opening.start_values(experiment), **trial.truth["car"]})
    return signature(rung, named=trial.truth["effects"])


def test_friction_shows_as_a_step_where_the_velocity_turns(found):
    curve = found.sel(seen="strut velocity")
    slow = np.abs(curve["seen_at"]) < 0.2
    for axle in ("front", "rear"):
        own = curve.sel(axle=axle)
        expected = own["named_force"].isel(named_effect=0)
        assert float(expected.max()) > 15
        off = np.abs(own["missing_force"] - expected)[slow]
        # Friction turns within 2 mm/s, the curve between knots 40 mm/s apart.
        assert float(off.max()) < 0.4 * float(expected.max())


def test_the_place_where_the_force_acts_explains_most(found):
    assert str(found["seen"].values[int(np.argmax(found["seen_share"].values))]) == "strut velocity"


def test_a_force_at_rest_does_not_show(found):
    at_rest = found["missing_force"].where(found["seen_at"] == 0).max("knot")
    np.testing.assert_allclose(at_rest.values, 0.0, atol=1e-9)


def test_an_effect_that_acts_elsewhere_is_not_drawn(found):
    assert bool(found["named_force"].sel(seen="tyre deflection").isnull().all())
