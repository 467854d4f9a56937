"""Terms that remember, against what their equations come to at constant motion or in a ramp."""

from __future__ import annotations

from itertools import product
from math import exp, pi, sin, tanh
from types import SimpleNamespace

import pytest

from ridecomfort.discrepancy import places
from ridecomfort.discrepancy.places import PLACES
from ridecomfort.discrepancy.terms import FIRM

STEP, COARSE = 1e-4, 2e-3
"""s; and the step of a search for what is missing."""

STEADY = {"stiffness", "damping", "rest", "s", "front", "rear", "height", "place"}
"""What a place sees that hardly changes along a drive."""


class Moving:
    """A term of a place that is moved: its states are integrated, what shapes it is as given or typical."""

    def __init__(self, place: str, name: str, **settings: float):
        self.term = PLACES[place].terms[name]
        self.known = {"abs": abs, "max": max, "min": min, "tanh": tanh} | {one.name: one.typical for one in self.term.settings} | settings
        self.states = {state.name: 0.0 for state in self.term.states}
        self.slopes = {state.name: compile(state.slope, name, "eval") for state in self.term.states}

    def after(self, seconds: float, **seen) -> float:
        """The term after so many seconds, in which the place sees constants or functions of the time."""
        for number in range(round(seconds / STEP)):
            now = self._known(number * STEP, seen)
            self.states = {name: value + STEP * slope for (name, value), slope in zip(self.states.items(), self._slopes(now))}
        return eval(self.term.expression, {"__builtins__": {}}, self._known(seconds, seen))

    def record(self, step: float, seconds: float, seen) -> list[float]:
        """The term every COARSE, integrated as the kernel does it (Adams and Bashforth, third order); ``seen``: by time, what the place sees."""
        term, found = compile(self.term.expression, "term", "eval"), []
        before = earlier = [0.0] * len(self.states)
        for number in range(round(seconds / step)):
            now = self.known | self.states | seen(number * step)
            if number % round(COARSE / step) == 0:
                found.append(eval(term, {"__builtins__": {}}, now))
            slopes = self._slopes(now)
            changes = (step * (23.0 * own - 16.0 * last + 5.0 * first) / 12.0 for own, last, first in zip(slopes, before, earlier))
            self.states = {name: value + change for (name, value), change in zip(self.states.items(), changes)}
            before, earlier = slopes, before
        return found

    def _slopes(self, now) -> list[float]:
        return [eval(slope, {"__builtins__": {}}, now) for slope in self.slopes.values()]

    def _known(self, time: float, seen) -> dict:
        return self.known | self.states | {name: value(time) if callable(value) else value for name, value in seen.items()}


def rough(place: str):
    """By time (s), what a place sees on a rough road at 35 m/s: twice what is typical at 1.5 Hz, and once at 12 Hz."""

    def wave(name: str, time: float) -> float:
        phase = len(name)
        return 2.0 * sin(2.0 * pi * 1.5 * time + phase) + sin(2.0 * pi * 12.0 * time + 2.0 * phase)

    def at(name: str, typical: float, time: float) -> float:
        steady = {"speed": 35.0, "spin": 115.0, "rotation": 115.0 * time, **({name: typical} if name in STEADY else {})}
        if name == "load" or name == "deflection" and place == "tyre":
            return typical * max(1.0 + 0.4 * wave(name, time), 0.0)
        return steady.get(name, typical * wave(name, time))

    def seen(time: float) -> dict:
        known = {name: at(name, typical, time) for name, typical in PLACES[place].typical.items() if name != "motion"}
        motion = {name: at(name, typical, time) for name, typical in vars(places.MOTION).items()}
        return {**known, "motion": SimpleNamespace(**motion), "wheel": 0}

    return seen


REMEMBERING = [(place, name) for place, one in PLACES.items() for name, term in one.terms.items() if term.states]


@pytest.mark.parametrize(("place", "name"), REMEMBERING)
def test_what_a_term_remembers_is_integrated_in_the_steps_of_a_search_at_all_ends_of_its_settings(place, name):
    """What cannot be runs away, which no step of a tenth does."""
    shaping = [setting for setting in PLACES[place].terms[name].settings if setting.name not in ("place", "height", *FIRM)]
    for values in product(*((setting.plausible[0], setting.typical, setting.plausible[1]) for setting in shaping)):
        settings = {setting.name: value for setting, value in zip(shaping, values)}
        coarse, fine = (Moving(place, name, **settings).record(step, 1.0, rough(place)) for step in (COARSE, COARSE / 10.0))
        assert max(map(abs, coarse)) < 2.0 * max(map(abs, fine)), settings


def turning(side_speed: float = 0.0, yaw_rate: float = 0.05, speed: float = 20.0, roll_acceleration: float = 0.0) -> SimpleNamespace:
    return SimpleNamespace(side_speed=side_speed, yaw_rate=yaw_rate, speed=speed, roll=0.0, roll_acceleration=roll_acceleration)


def test_a_damper_behind_rubber_that_hardens_has_no_force_at_first_and_all_of_it_at_a_constant_velocity():
    moving = Moving("strut", "late_velocity_hardening", knee=0.001)
    assert moving.after(0.0, velocity=0.2) == pytest.approx(-0.2)
    assert moving.after(1.0, velocity=0.2) == pytest.approx(0.0, abs=1e-6)


def test_what_hardens_in_compression_has_its_size_there():
    """6.2832 * 10 Hz * 1 mm * (1 + (1/2)^2) less 0.12 m/s at typical motion; of what acts in rebound the size is that in rebound."""
    assert places.scale("strut", "late_velocity_hardening") == pytest.approx(abs(2.0 * pi * 10.0 * 0.001 * 1.25 - 0.12), rel=1e-3)
    assert places.scale("strut", "rebound_beyond") == pytest.approx(places.scale("strut", "bump_beyond"))
    assert places.scale("strut", "rebound_at_first") == pytest.approx(places.scale("strut", "bump_at_first"))


def test_rubber_that_hardens_is_twice_as_stiff_at_its_knee():
    """At a way of the knee the spring bears twice what it would bear if it were linear."""
    term, knee, frequency = PLACES["strut"].terms["late_velocity_hardening"], 0.002, 10.0
    known = {"way": knee, "knee": knee, "frequency": frequency, "velocity": 0.0, "min": min}
    assert eval(term.expression, {"__builtins__": {}}, known) == pytest.approx(2.0 * 2.0 * pi * frequency * knee, rel=1e-4)


def test_half_of_the_velocity_counts_while_a_wheel_is_thrown_up_by_the_threshold_and_none_at_a_constant_velocity():
    moving = Moving("strut", "bump_velocity_when_thrown", threshold=5.0)
    assert moving.after(0.1, velocity=lambda time: 5.0 * time) == pytest.approx(0.25, rel=1e-3)
    assert moving.after(0.5, velocity=0.5) == pytest.approx(0.0, abs=1e-6)
    assert moving.after(0.1, velocity=lambda time: -0.5 + 5.0 * time) == 0.0, "in rebound it is shut"


def test_ground_is_pressed_down_at_once_and_comes_up_as_the_wheel_rolls_on():
    moving = Moving("tyre", "pressed_down", angle=1.0)
    assert moving.after(0.1, deflection=0.03, rest=0.015, spin=70.0) == pytest.approx(1.0, abs=1e-3)
    assert moving.after(0.02, deflection=0.015, rest=0.015, spin=70.0) == pytest.approx(exp(-1.4), rel=0.01)
    assert moving.after(10.0, deflection=0.015, rest=0.015, spin=0.0) == pytest.approx(exp(-1.4), rel=0.01), "a wheel that stands stays down"


def test_a_mass_that_sways_goes_along_with_a_steady_bend_and_stays_behind_when_shaken():
    assert Moving("body", "swaying", damping_ratio=0.5).after(5.0, motion=turning()) == pytest.approx(0.0, abs=1e-3)
    shaken = Moving("body", "swaying", frequency=0.5, height=0.3)
    assert shaken.after(0.0, motion=turning(yaw_rate=0.0, roll_acceleration=2.0)) == pytest.approx(-0.6)


def test_rear_wheels_that_steer_along_push_the_other_way_below_a_speed():
    push = lambda speed: Moving("body", "steering_along", change=10.0).after(2.0, motion=turning(speed=speed))
    assert push(20.0) == pytest.approx(0.025) and push(10.0) == pytest.approx(0.0) and push(5.0) == pytest.approx(-0.05)


def test_what_goes_by_the_speed_has_a_quarter_of_it_at_half_of_the_speed():
    moment = lambda speed: Moving("body", "pitch_stiffness_of_speed").after(0.0, motion=SimpleNamespace(speed=speed, pitch=0.01))
    assert moment(20.0) == pytest.approx(4.0) and moment(10.0) == pytest.approx(1.0)


def test_a_differential_that_locks_holds_as_hard_in_any_quick_turn_and_less_in_a_slow_one():
    moment = lambda rate: Moving("body", "yaw_rate_direction", knee=0.02).after(0.0, motion=turning(yaw_rate=rate))
    assert moment(0.1) == pytest.approx(1.0, abs=1e-3) and moment(-2.0) == pytest.approx(-1.0)
    assert moment(0.002) == pytest.approx(0.1, rel=0.01)


def test_a_nose_that_is_damped_against_the_ground_stays_free_where_bounce_and_pitch_cancel_there():
    motion = lambda pitch_rate: SimpleNamespace(vertical_speed=0.12, pitch_rate=pitch_rate, front=1.2, rear=-1.5)
    assert Moving("body", "heave_damping_front").after(1.0, motion=motion(0.1)) == pytest.approx(0.0, abs=1e-9)
    assert Moving("body", "heave_damping_rear").after(1.0, motion=motion(0.1)) == pytest.approx(0.27)
