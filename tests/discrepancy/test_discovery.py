"""What a discovery writes is an effect like any other."""

from __future__ import annotations

from dataclasses import replace
from math import cos, exp, pi, sin, tanh
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import select
from ridecomfort.discrepancy.balance import total_shares
from ridecomfort.discrepancy.car import LONGEST
from ridecomfort.discrepancy.discovery import Discovery, heard_as, may_follow, proposed, terms_of
from ridecomfort.discrepancy.experiment import Candidate
from ridecomfort.discrepancy.form import effect_source, in_words, typically
from ridecomfort.discrepancy.places import PLACES, parameter, scale, settings
from ridecomfort.discrepancy.terms import AXLES, LINEAR, TURNING, WHEELS, WHOLE
from ridecomfort.discrepancy.turns import Line
from ridecomfort.discrepancy.verdict import Named
from ridecomfort.effects import library
from ridecomfort.effects.contract import PORTS

from .linear import Linear

KNOWN = {"tanh": tanh, "cos": cos, "sin": sin, "abs": abs, "max": max, "min": min}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("wheel", range(4))
def test_every_term_of_every_place_can_be_written_as_an_effect(place, wheel, tmp_path):
    where = PLACES[place]
    factors = {name: {part: 2.0 + k for k, part in enumerate(term.parts)} for name, term in where.terms.items()}
    for name, own in factors.items():
        (tmp_path / f"found_{name}.py").write_text(effect_source(f"found_{name}", place, {name: own}, "Found."))
    found = library.find(tmp_path)
    seen = {name: 0.7 for name in where.arguments} | {"wheel": wheel}
    if "motion" in seen:
        seen |= {"motion": SimpleNamespace(**{key: 0.1 + 0.2 * k for k, key in enumerate(vars(where.typical["motion"]))})}
    for name, term in where.terms.items():
        entry = found[f"found_{name}"]
        own = {WHOLE: {"": 1.0}, AXLES: {AXLES[wheel // 2]: 1.0}}.get(term.parts)
        states = {state.name: 0.3 + 0.1 * k for k, state in enumerate(term.states)}
        shape = {setting.name: setting.typical + 0.1 * (not setting.typical) for setting in settings(place, name) if setting is not LINEAR}
        worth = lambda expression: eval(expression, KNOWN, seen | states | shape)
        if term.parts == TURNING:
            own = {f"{WHEELS[wheel]}_cosine": cos(worth(term.turn)), f"{WHEELS[wheel]}_sine": sin(worth(term.turn))}
        elif term.after:
            own = {part: (cos if "cosine" in part else sin)(worth(term.turn)) for part in term.parts}
        before = {result: seen.get(result, 0.0) for result in where.results}
        expected = dict(before)
        for result, parts in term.by_result().items():
            value = sum(factors[name][part] * own[part] for part in parts if part in own) * worth(term.expression)
            expected[result] += value
            force = [value if axis == result else 0.0 for axis in ("force_x", "force_y", "force_z")]
            moments = np.cross([worth(term.ahead or "0.0"), 0.0, worth(term.above or "0.0")], force)
            expected |= {axis: expected[axis] + moment for axis, moment in zip(("moment_x", "moment_y", "moment_z"), moments) if moment}
        slopes = [worth(state.slope) for state in term.states]
        arguments = {key: seen[key] for key in where.arguments} | dict(zip(entry.effect.states, states.values()))
        shaped = {parameter(name, setting): value for setting, value in shape.items()}
        assert _tuple(entry.act(**arguments, **(entry.effect.values() | shaped))) == pytest.approx([*expected.values(), *slopes], rel=1e-5)
        assert _tuple(entry.act(**arguments, **entry.effect.neutral))[: len(expected)] == tuple(before.values())


def _tuple(found):
    return found if isinstance(found, tuple) else (found,)


@pytest.mark.parametrize("place", PLACES)
def test_every_term_has_a_size_at_typical_motion(place):
    assert all(scale(place, term) > 0 for term in PLACES[place].terms)


@pytest.mark.parametrize("place", PLACES)
def test_what_swings_at_a_frequency_of_its_own_is_tried_with_close_ones(place):
    """Between two that are a factor of two apart, as the ends of what is plausible and the middle were, it is not seen."""
    for candidate in terms_of(place, None, 0.31):
        name = candidate.name.partition(":")[2]
        own = {setting.name: setting for setting in settings(place, name)}
        if "damping_ratio" in own:
            key = next(key for key in candidate.shapes[0] if key.endswith("frequency"))
            tried = np.unique([shape[key] for shape in candidate.shapes])
            assert tuple(tried[[0, -1]]) == pytest.approx(own["frequency"].plausible) and own["frequency"].typical in tried
            assert np.max(tried[1:] / tried[:-1]) <= 1.35


def test_what_is_shaped_by_a_time_or_a_way_is_tried_with_short_and_long_ones():
    (late,) = (candidate for candidate in terms_of("steering", None, 0.31) if candidate.name == "steering:angle_late")
    times = sorted(shape["unknown_steering_angle_late.angle_late_time"] for shape in late.shapes)
    assert len(times) == 3 and times[0] < 0.6 * times[1] and times[1] < 0.6 * times[2]


@pytest.mark.parametrize("term", PLACES["structure"].terms)
def test_an_instrument_on_something_soft_that_moves_against_the_body_is_plausible(term):
    (candidate,) = (candidate for candidate in terms_of("structure", None, 0.31) if candidate.name == f"structure:{term}")
    assert all(size.lower < -1.0 < 1.0 < size.upper for size in candidate.sizes)


def test_a_form_is_said_with_its_sizes():
    assert in_words("strut", {"velocity_direction": {"front": 57.3, "rear": 48.0}}) == (
        "force = (57.3 N front and 48 N rear) tanh(velocity / 0.005)"
    )
    assert in_words("body", {"lift": {"": -0.5}}) == "force_z = (-0.5 N s2/m2) motion.speed**2"
    assert in_words("tyre", {"twice_a_turn": {"front_left_cosine": 60.0, "front_left_sine": -20.0}}) == (
        "force = (63.25 N front_left at -18 deg) cos(2.0 * rotation - angle)"
    )
    shaped = {"slow_velocity": {"frequency": 7.5, "linear": 0.0}}
    assert in_words("strut", {"slow_velocity": {"front": 57.3, "rear": 48.0}}, shaped) == (
        "force = (57.3 N s/m front and 48 N s/m rear) slow, slow' = 6.2832 * frequency * (velocity - slow), frequency = 7.5 Hz"
    )


def test_a_force_that_whirls_is_said_with_what_it_does_up_and_aside_and_after_which_way_it_comes_back():
    factors = {"up_cosine": 1.0, "up_sine": 2.0, "aside_cosine": 3.0, "aside_sine": -4.0}
    shaped = {"whirling": {"period": 0.62832, "place": -0.4, "height": -0.15}}
    turn, settings = "cos(6.283185 * motion.s / period - angle)", "period = 0.6283 m, place = -0.4 m, height = -0.15 m"
    assert in_words("body", {"whirling": factors}, shaped) == (
        f"force_z = (2.236 N up at 63 deg) {turn} at place, {settings}; force_y = (5 N aside at -53 deg) {turn} at place and height, {settings}"
    )


def test_a_form_is_told_with_its_size_at_typical_motion_of_what_it_sees():
    assert typically("strut", {"velocity_direction": {"front": 57.3, "rear": -48.0}}) == "57 N front and -48 N rear at velocity 0.12 m/s"
    toe = typically("links", {"toe_of_deflection_square_on_sides": {"front": 2.76, "rear": -2.5}})
    assert toe == "0.4 mrad front and -0.36 mrad rear at deflection 0.012 m"
    wave = typically("tyre", {"once_a_turn_by_spin": {"rear_left_cosine": 0.01, "rear_left_sine": 0.0}})
    assert wave == "49 N rear left at spin 70 rad/s"
    assert typically("body", {"drag": {"": -0.3}}) == "120 N at speed 20 m/s"
    both = typically("strut", {"velocity_direction": {"front": 57.3}, "velocity_signed_square": {"front": 9.0}})
    assert both.startswith("velocity direction: 57 N front at") and "; velocity signed square: " in both


@pytest.mark.parametrize(("clearance", "size"), [(0.015, 190), (0.002, 450), (0.03, 0)])
def test_of_a_stop_that_size_is_with_the_clearance_that_was_found(clearance, size):
    told = typically("strut", {"bump_damping_beyond": {"front": 8.59e4, "rear": 0.0}}, {"bump_damping_beyond": {"clearance": clearance}})
    assert told == f"{size} N front and 0 N rear at deflection 0.024 m, velocity 0.24 m/s"


@pytest.mark.parametrize("place", PLACES)
def test_every_term_has_a_size_in_words(place):
    for name, term in PLACES[place].terms.items():
        assert typically(place, {name: {part: 1.0 for part in term.parts}})


@pytest.mark.parametrize("angle", [-170.0, 0.0, 63.0])
def test_a_wave_in_words_is_the_sum_of_its_cosine_and_sine(angle):
    term, turns = PLACES["tyre"].terms["once_a_turn"], np.linspace(0.0, 7.0, 50)
    cosine, sine = 40.0 * np.cos(np.radians(angle)), 40.0 * np.sin(np.radians(angle))
    (part, (size, where)), *others = term.amplitudes({"rear_left_cosine": cosine, "rear_left_sine": sine}).items()
    assert part == "rear_left" and not others
    assert size * np.cos(turns - np.radians(where)) == pytest.approx(cosine * np.cos(turns) + sine * np.sin(turns))


def test_a_period_is_written_so_that_it_holds_for_kilometres_and_is_not_calibrated_to_another(tmp_path):
    source = effect_source("found", "body", {"shaking_along": {"cosine": 30.0, "sine": 5.0}}, "Found.", {"shaking_along": {"period": 1.9475177}})
    (tmp_path / "found.py").write_text(source)
    (period,) = (one for one in library.find(tmp_path)["found"].effect.parameters if one.name.endswith("period"))
    assert period.neutral == period.typical == 1.9475177 and period.plausible == pytest.approx((1.94713, 1.94791), abs=1e-5)


def test_what_comes_back_is_looked_for_where_it_was_heard_and_from_its_period_on():
    names = lambda line: {candidate.name for place in PLACES for candidate in terms_of(place, line, 0.31)}
    comes_back = {after: {f"{place}:{name}" for place in PLACES for name, term in PLACES[place].terms.items() if term.after == after} for after in "ms"}
    assert "body:whirling" in comes_back["m"] and "body:humming_up" in comes_back["s"]
    assert not names(None) & (comes_back["m"] | comes_back["s"])
    for unit, other in ("ms", "sm"):
        heard = Line("a_z", 0.21, unit, 1e-9, 0.002)
        assert names(heard) - names(None) == comes_back[unit] and not names(heard) & comes_back[other]
        for candidate in (one for one in terms_of("body", heard, 0.31) if one.name in comes_back[unit]):
            (period,) = (one for one in candidate.shaping if one.key.endswith("period"))
            assert all(shape[period.key] == 0.21 for shape in candidate.shapes)
            assert (period.lower, period.upper) == pytest.approx((0.208, 0.212))


def test_what_was_heard_may_turn_with_the_wheels_as_often_as_it_comes_back():
    """2 pi times 0.31 m are 1.948 m; a wheel that turns 0.9 times on them is of none of the whole numbers."""
    heard = Line("a_z", 2.0 * pi * 0.31 / 0.9, "m", 1e-9, 0.02)
    (own,) = (one for one in terms_of("tyre", heard, 0.31) if one.name == "tyre:often_a_turn")
    (order,) = own.shaping
    assert order.neutral == pytest.approx(0.9) and order.upper - order.lower == pytest.approx(2 * 0.9 * 0.02 / heard.period)
    assert [shape[order.key] for shape in own.shapes] == pytest.approx([0.9, (0.9 * order.lower) ** 0.5, (0.9 * order.upper) ** 0.5])
    assert not any(one.name.startswith("tyre:often") for one in terms_of("tyre", replace(heard, unit="s"), 0.31))


def test_wheels_that_run_out_aside_are_turned_by_angles_of_their_own_once_in_the_way_that_was_heard(tmp_path):
    factors = {"front_left_cosine": 0.001, "front_left_sine": 0.0, "rear_right_cosine": 0.0, "rear_right_sine": 0.002}
    form = {"side_slip_once_a_turn": factors}
    (tmp_path / "found.py").write_text(effect_source("found", "contact", form, "Found.", {"side_slip_once_a_turn": {"period": 2.0}}))
    found = library.find(tmp_path)["found"]
    sizes = {one.name: one.neutral for one in found.effect.parameters}
    sizes |= {f"side_slip_once_a_turn_{part}": size for part, size in factors.items()}
    of_wheel = lambda wheel, turn: found.act(wheel, 0.01, 0.004, 4000.0, 20.0, 0.0, 0.0, turn, **sizes)
    for turn in (0.0, 1.0, 4.0):
        aside = [of_wheel(wheel, turn)[1] - 0.004 for wheel in range(4)]
        assert aside == pytest.approx([0.001 * np.cos(turn), 0.0, 0.0, 0.002 * np.sin(turn)])
    assert of_wheel(0, 0.0)[-1] == pytest.approx(2 * np.pi * 1.01 * 20.0 / 2.0, rel=1e-6)


@pytest.mark.parametrize(("heard", "whole"), [(1.940, 1), (1.955, 1), (0.971, 2), (1.80, 0)])
def test_what_turns_each_wheel_aside_is_tried_once_a_turn_of_these_too_where_that_is_near(heard, whole):
    """Over 2 pi times 0.31 m or a half of it: along the road it is heard beside that, since wheels outside in bends turn faster."""
    (own,) = (one for one in terms_of("contact", Line("a_y", heard, "m", 1e-9, 0.004), 0.31) if one.name.endswith("once_a_turn"))
    (period,) = own.shaping
    expected = [heard] + ([2 * pi * 0.31 / whole] if whole else [])
    assert [shape[period.key] for shape in own.shapes] == pytest.approx(expected)
    assert all(period.lower <= value <= period.upper for value in expected)


def test_what_was_heard_is_there_as_anything_that_comes_back_so():
    """A tyre of 0.31 m rolls some percent less than its circumference."""
    twice = heard_as(Line("a_z", 0.98 * pi * 0.31, "m", 1e-9, 0.002), radius=0.31)
    assert set(twice.values()) == {1e-9} and {"tyre:twice_a_turn", "body:whirling"} <= set(twice)
    assert not {"tyre:once_a_turn", "tyre:once_a_turn_by_spin", "tyre:thrice_a_turn", "body:humming_up"} & set(twice)
    assert {name.partition(":")[0] for name in heard_as(Line("a_z", 0.05, "s", 1e-9, 0.002), radius=0.31)} == {"body"}
    assert heard_as(None, radius=0.31) == {}


def test_a_force_may_have_a_linear_part_of_its_own(tmp_path):
    """Dampers that are soft around rest: 500 N s/m less there, as stiff as before where they give 20 mm."""
    terms = {"deflection_size_times_velocity": {"front": 25000.0, "rear": 25000.0}}
    shaped = {"deflection_size_times_velocity": {"linear": -0.02 / 0.012}}
    source = effect_source("found", "strut", terms, "Found.", shaped)
    (tmp_path / "found.py").write_text(source)
    entry = library.find(tmp_path)["found"]
    force = lambda deflection: entry.act(0, deflection, 0.1, 0.0, 0.0, 0.0, 0.0, **entry.effect.values())
    assert force(0.0) == pytest.approx(-50.0, rel=1e-3) and force(0.02) == pytest.approx(0.0, abs=0.05)
    assert "(abs(deflection) * velocity - 0.02 * velocity)" in in_words("strut", terms, shaped)
    plain = effect_source("found", "strut", terms, "Found.", {"deflection_size_times_velocity": {"linear": 0.0}})
    assert "linear" not in plain


def test_what_a_low_pass_remembers_can_be_integrated_in_the_longest_steps():
    """The scheme of third order bears slopes of 0.545 per step on the real axis (Hairer and Wanner 1996, V.1)."""
    for place, term in (("strut", "slow_velocity"), ("strut", "late_velocity"), ("tyre", "slow_velocity")):
        (frequency,) = (one for one in settings(place, term) if one.name == "frequency")
        assert 2 * pi * frequency.plausible[1] * LONGEST < 0.545


def test_a_part_that_moves_on_a_spring_of_its_own_swings_at_its_frequency_and_is_rigid_below(tmp_path):
    """Free, it turns at 11 Hz; pushed along slowly, it weighs nothing beside the body that carries it already."""
    source = effect_source("found", "body", {"resonance_front": {"": 100.0}}, "Found.")
    (tmp_path / "found.py").write_text(source)
    act = library.find(tmp_path)["found"].act
    still = {"vertical_acceleration": 0.0, "pitch_acceleration": 0.0, "front": 1.2, "rear": -1.5, "speed": 20.0}
    lift, rate, step, places = 1e-3, 0.0, 1e-4, []
    for _ in range(10000):
        *_, rising, turning = act(SimpleNamespace(**still), lift, rate, 100.0, 11.0, 0.1)
        rate += step * turning
        lift += step * rate
        places.append(lift)
    crossings = sum(a > 0 >= b for a, b in zip(places, places[1:]))
    assert crossings == pytest.approx(11, abs=1)
    pushed = SimpleNamespace(**(still | {"vertical_acceleration": 1.0}))
    balance = -1.0 / (2 * pi * 11) ** 2
    assert abs(act(pushed, balance, 0.0, 100.0, 11.0, 0.1)[2]) < 0.1


def test_a_strut_remembers_how_fast_it_moved_of_late(tmp_path):
    """Behind a rough patch the force of a velocity fades within the time that is remembered."""
    terms = {"velocity_times_recent": {"front": 1000.0, "rear": 1000.0}}
    (tmp_path / "found.py").write_text(effect_source("found", "strut", terms, "Found.", {"velocity_times_recent": {"time": 2.0}}))
    entry = library.find(tmp_path)["found"]
    recent, step, forces = 0.0, 1e-3, []
    for speed in (0.3, 0.0):
        for _ in range(10000):
            recent += step * entry.act(0, 0.0, speed, 0.0, 0.0, 0.0, 0.0, recent, **entry.effect.values())[1]
            forces.append(entry.act(0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, recent, **entry.effect.values())[0])
    assert forces[9999] == pytest.approx(1000.0 * 0.1 * 0.3, rel=0.01)
    assert forces[11999] == pytest.approx(forces[9999] * exp(-1.0), rel=0.01)


@pytest.mark.parametrize(("term", "to_its_side"), [("rebound_at_first", -0.1), ("bump_at_first", 0.1)])
def test_a_valve_closes_in_the_course_of_a_stroke_to_one_side_and_is_open_again_at_once(term, to_its_side, tmp_path):
    shaped = {term: {"frequency": 2.0, "linear": 0.0}}
    (tmp_path / "found.py").write_text(effect_source("found", "strut", {term: {"front": 1000.0, "rear": 1000.0}}, "Found.", shaped))
    entry = library.find(tmp_path)["found"]
    closed, step, forces = 0.0, 1e-4, []
    for velocity, lasts in ((to_its_side, 0.1), (-to_its_side, 0.1), (to_its_side, 0.01)):
        for _ in range(round(lasts / step)):
            force, slope = entry.act(0, 0.0, velocity, 0.0, 0.0, 0.0, 0.0, closed, **entry.effect.values())
            closed += step * slope
            forces.append(force)
    assert forces[0] == pytest.approx(1000.0 * to_its_side)
    assert forces[999] == pytest.approx(forces[0] * exp(-2.0 * pi * 2.0 * 0.1), rel=0.01)
    assert set(forces[1000:2000]) == {0.0} and forces[2000] == pytest.approx(forces[0], rel=0.01)


@pytest.mark.parametrize(
    ("place", "seen", "terms"),
    [
        ("contact", (0, 0.0, 0.01, 4000.0, 20.0, 0.0, 0.0), {"side_slip_late": {"front": 1.0, "rear": 1.0}, "side_slip": {"front": -0.3, "rear": -0.3}}),
        ("steering", (0.01, 20.0, 2000.0), {"angle_of_force": {"": -1e-6}, "angle_late": {"": 1.0}}),
    ],
)
def test_a_form_of_several_terms_is_the_force_that_was_fitted_term_by_term(tmp_path, place, seen, terms):
    """Settled at what the place sees; a term sees what the one before it makes of a slip or an angle, as effects of one term each do."""
    port = PORTS[PLACES[place].port]
    for name, factors in terms.items():
        (tmp_path / f"unknown_{name}.py").write_text(effect_source(f"unknown_{name}", place, {name: factors}, "Found."))
    (tmp_path / "discovered.py").write_text(effect_source("discovered", place, terms, "Found."))

    def settled(names):
        chosen = library.choose(names, tmp_path)
        states = {entry.effect.name: np.zeros(len(entry.effect.states)) for entry, _ in chosen}
        for _ in range(3000):
            now = dict(zip(port.sees, seen))
            for entry, values in chosen:
                found = entry.act(*now.values(), *states[entry.effect.name], *values.values())
                results = found if isinstance(found, tuple) else (found,)
                states[entry.effect.name] += 1e-3 * np.array(results[len(port.returns) :])
                now |= {name: value for name, value in zip(port.returns, results) if name in now}
        return now

    together, one_by_one = settled(["discovered"]), settled([f"unknown_{name}" for name in terms])
    assert together == pytest.approx(one_by_one) and together != pytest.approx(dict(zip(port.sees, seen)))


def test_a_proposed_effect_acts_before_those_of_the_library_whatever_it_is_called(tmp_path):
    for name in ("unknown_steering", "discovered", "a_form"):
        (tmp_path / f"{name}.py").write_text(effect_source(name, "steering", {"angle_of_force": {"": -1e-6}}, "Found."))
        assert [entry.effect.name for entry, _ in library.choose(["steering_lag", name], tmp_path)] == [name, "steering_lag"]


def test_a_proposal_is_told_by_its_place_what_makes_such_a_force_and_what_it_removes():
    terms = {"bump_beyond": {"front": 9000.0, "rear": 9000.0}}
    found = Discovery("discovered", "strut", "suspension", terms, {"bump_beyond": {}}, "", 0.774, 0.916, 0.0015, "", {}, None)
    here = "here: stiffer in compression beyond the clearance (front and rear)"
    said = f"at the strut, such as a bump stop, a helper or tender spring; {here}. It removes 77 % on the fitted drives"
    assert found.words() == f"{said}, 92 % on drives held out."
    assert replace(found, held_out_share=float("nan")).words() == f"{said}."
    friction = Named("suspension_friction", (), "", 0.001, 0.3, 0.3, 0.0, (), {})
    beside = replace(found, beside=(friction,))
    assert "Together with suspension_friction it removes 77 % on the fitted drives" in beside.words()
    assert beside.json()["beside"] == ["suspension_friction"] and found.json()["beside"] == []
    assert beside.json()["own_share"] == pytest.approx(0.774 - 0.3) and found.json()["own_held_out_share"] == 0.916


def test_terms_of_a_force_act_at_one_place_and_effects_of_the_library_beside_them():
    follows = lambda accepted, other: may_follow(accepted, other, most=2)
    assert follows(["suspension_friction"], "strut:velocity_size") and follows(["strut:velocity_size"], "suspension_friction")
    assert follows(["strut:velocity_size", "suspension_friction"], "strut:deflection_cube")
    assert not follows(["suspension_friction", "strut:velocity_size"], "tyre:deflection_cube")
    full = ["strut:velocity_size", "strut:deflection_cube"]
    assert not follows(full, "strut:deflection_square") and follows(full, "suspension_friction")


def selected_beside(port, **truth):
    """What is selected where the second effect of a linear model is a term of a force at the strut, and the fifth one of the library, and the latter."""
    model, key = Linear(1, {f"{name}.size": value for name, value in truth.items()}), "unknown_strut_velocity_size.velocity_size_front"
    term, of_library = (model.candidates[k] for k in (2, 4))
    model.truth[key] = model.truth.pop("effect_2.size")
    model.columns = [{key if name == "effect_2.size" else name: column for name, column in own.items()} for own in model.columns]
    term = Candidate("strut:velocity_size", (replace(term.sizes[0], key=key),))
    model.candidates = (term, replace(of_library, port=port))
    selection = select.select(model, {"stiffness": 0.0}, most=3)
    assert set(selection.accepted) == {"strut:velocity_size", "effect_4"}
    return selection, model.candidates[1:]


def found_beside(port, **truth):
    """What is proposed of that."""
    selection, of_library = selected_beside(port, **truth)
    return proposed(selection, "found", of_library)


def test_effects_that_are_missing_too_are_told_beside_the_form_and_what_all_remove():
    found = found_beside("suspension", effect_2=1.5, effect_4=1.0)
    assert found.names_beside() == ["effect_4"] and set(found.terms) == {"velocity_size"} and "effect_4" not in found.source
    assert found.share == pytest.approx(1.0, abs=0.05) and found.held_out_share == pytest.approx(1.0, abs=0.1)
    size, *shape = found.json()["sizes"]
    assert (size["parameter"], size["unit"]) == ("velocity_size_front", "N s/m")
    assert size["interval"][0] < 1.5 < size["interval"][1] and all(one["interval"] is None for one in shape)
    assert size["is_plausible"] and not size["is_shaping"] and all(one["is_shaping"] for one in shape)
    assert found.json()["here"] == "firmer in compression than in rebound (front)" and f"here: {found.json()['here']}." in found.source
    nil = replace(found, sizes=({**found.sizes[0], "interval": (-1.0, 4.0)},))
    assert nil.json()["here"] == "" and "here:" not in nil.words()


@pytest.mark.parametrize(("factor", "names"), [(0.999, ["effect_4"]), (1.001, []), (np.nan, ["effect_4"])])
def test_what_makes_the_error_of_drives_held_out_larger_does_not_stand_beside_the_form(factor, names):
    selection, of_library = selected_beside("suspension", effect_2=1.5, effect_4=1.0)
    assert selection.accepted[-1] == "effect_4"
    before, last = selection.states[-2:]
    last = replace(last, held_out_squares=factor * before.held_out_squares)
    found = proposed(replace(selection, states=(*selection.states[:-1], last)), "found", of_library)
    assert found.names_beside() == names and set(found.terms) == {"velocity_size"}


def test_a_factor_that_is_nearly_nil_may_be_as_large_as_the_others_of_its_term(tmp_path):
    (tmp_path / "found.py").write_text(effect_source("found", "body", {"shaking_along": {"cosine": 40.0, "sine": -0.5}}, "Found."))
    cosine, sine, *_ = library.find(tmp_path)["found"].effect.parameters
    assert cosine.plausible == sine.plausible == (-120.0, 120.0)


def test_a_term_that_only_stood_in_for_others_is_not_in_the_form_and_yet_counts_for_what_all_remove():
    model = Linear(1, {"effect_2.size": 1.5, "effect_4.size": 1.0})
    terms = {"effect_2": "velocity_size", "effect_4": "deflection_cube"}
    keys = {f"{name}.size": f"unknown_strut_{term}.{term}_front" for name, term in terms.items()}
    model.truth = {keys[key]: value for key, value in model.truth.items()}
    model.columns = [{keys.get(name, name): column for name, column in own.items()} for own in model.columns]
    model.candidates = tuple(
        Candidate(f"strut:{term}", (replace(model.candidates[k].sizes[0], key=keys[f"effect_{k}.size"]),))
        for k, term in ((2, "velocity_size"), (4, "deflection_cube"))
    )
    selection = select.select(model, {"stiffness": 0.0}, most=3)
    both = proposed(selection, "found", ())
    assert set(both.terms) == set(terms.values())
    one = proposed(replace(selection, needless=frozenset({"strut:velocity_size"})), "found", ())
    assert set(one.terms) == {"deflection_cube"} and "velocity_size" not in one.source and one.share == both.share
    turn = selection.rounds[selection.accepted.index("strut:deflection_cube")]
    assert one.p_value == turn.p_value[turn.names.index("strut:deflection_cube")]
    assert proposed(replace(selection, needless=frozenset(selection.accepted)), "found", ()).place == ""


@pytest.mark.parametrize("seed", [1, 2])
def test_a_form_has_the_share_of_an_effect_of_the_library_that_stood_in_for_it(seed):
    """The effect does nearly what two terms, which are missing, do together: it comes first, takes most, and is left out in the end."""
    model = Linear(seed, {"effect_1.size": 2.0, "effect_2.size": 2.0})
    for columns in model.columns[2:]:  # those of all repeats are one
        columns["effect_0.size"] = columns["effect_0.size"] + columns["effect_1.size"] + columns["effect_2.size"]
    terms = {"effect_1": "velocity_size", "effect_2": "deflection_cube"}
    keys = {f"{name}.size": f"unknown_strut_{term}.{term}_front" for name, term in terms.items()}
    model.truth = {keys[key]: value for key, value in model.truth.items()}
    model.columns = [{keys.get(name, name): column for name, column in own.items()} for own in model.columns]
    of_library, *own = model.candidates[:3]
    own = (replace(one, name=f"strut:{terms[one.name]}", sizes=(replace(one.sizes[0], key=keys[one.sizes[0].key]),)) for one in own)
    model.candidates = (of_library, *own)
    selection = select.select(model, {"stiffness": 0.0}, most=3)
    assert selection.accepted[0] == "effect_0" and selection.needless == {"effect_0"} and len(selection.kept) == 2
    found = proposed(selection, "found", (of_library,))
    assert found.names_beside() == [] and (found.share, found.held_out_share) == pytest.approx(total_shares(selection))
    assert min(found.share, found.held_out_share) > 0.9


@pytest.mark.parametrize(("port", "names"), [("suspension", []), ("aero", ["effect_4"])])
def test_what_is_small_at_the_port_of_a_form_may_be_what_that_leaves_by_not_being_exact(port, names):
    found = found_beside(port, effect_2=4.0, effect_4=0.6)
    assert found.names_beside() == names
    assert (found.share > 0.98) == bool(names)
