"""What is drawn of a missing force, and beside what: where a diagnosis found something."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy import missing_force as drawing
from ridecomfort.effects import library


@pytest.fixture
def asked(monkeypatch):
    """What ``signature`` is asked for, and residuals that stand for the values they were simulated with."""
    found = {}
    monkeypatch.setattr(drawing, "signature", lambda rung, **wanted: found.update(wanted))
    monkeypatch.setattr(drawing.exp, "simulate", lambda experiment, values, indices: values)
    return found


def candidate(name):
    return SimpleNamespace(name=name, sizes=(SimpleNamespace(key=f"{name}.front", neutral=0.0),))


EXPERIMENT = SimpleNamespace(effects={"wheel_recession": {}}, candidates=[candidate("suspension_friction"), candidate("imu_lever_arm")])

SELECTION = SimpleNamespace(
    final=SimpleNamespace(values={"suspension_friction.front": 80.0, "imu_lever_arm.front": 0.1}),
    accepted=("suspension_friction", "imu_lever_arm"), rounds=[SimpleNamespace(trials=[SimpleNamespace(name="bump_steer")])],
)  # fmt: skip

RUNG = SimpleNamespace(experiment=EXPERIMENT, fit=SimpleNamespace(residuals={}))


def verdict(*names):
    return SimpleNamespace(effects=[SimpleNamespace(name=name, like=()) for name in names])


def port(name):
    return library.find()[name].effect.port


def test_of_names_it_is_what_they_alone_would_show_at_their_ports_and_those_of_effects_that_are_on(asked):
    drawing.missing_force(EXPERIMENT, RUNG, SELECTION, verdict("suspension_friction"))
    assert asked["ports"] == [port("suspension_friction"), port("wheel_recession")]
    assert asked["found"] == {"suspension_friction.front": 80.0, "imu_lever_arm.front": 0.0}


def test_of_a_proposed_form_it_is_what_that_shows_with_all_beside_it_and_its_port_too(asked):
    proposal = SimpleNamespace(place="links", port="kinematics", residuals={0: "with it"})
    drawing.missing_force(EXPERIMENT, RUNG, SELECTION, verdict("suspension_friction"), proposal)
    assert asked["ports"][-1] == "kinematics" and asked["found"] == {0: "with it"}


def test_where_nothing_was_found_it_is_drawn_where_something_came_nearest_beside_nothing(asked):
    nothing = SimpleNamespace(place="", port="", residuals={})
    drawing.missing_force(EXPERIMENT, RUNG, SELECTION, verdict(), nothing)
    assert asked["ports"] == [port("bump_steer"), port("wheel_recession")] and asked["found"] is None
