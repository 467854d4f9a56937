"""Where a force that is in no library may act, and the terms that it may be made of there."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from types import SimpleNamespace

import numpy as np

from ..effects.contract import Parameter
from .terms import (
    ANGLE, AT_ONCE, AXLES, CHANGING, FASTEST, LINEAR, OF_STRUCTURE, SIDE, WHIRL, WHOLE, State, Term, acting_beyond, at_first, below,
    coming_back, following, hardening, on_spring, pressed_down, remembering, running_out_aside, saturating, shape_setting, shared_slowly, sliding,
    steering_along, strained, swaying, swinging, turning, turning_as_heard, when_thrown,
)  # fmt: skip

FORCE = 30.0
"""N (or N m) that a term is probed with at typical motion."""

STRONGEST, STRONGEST_OF_TYRE = 1500.0, 6000.0
"""N (or N m) at typical motion beyond which a term is not plausible; at a tyre, which bears 4000 N at rest, more is."""

STRONGEST_OF_STRUCTURE = 3500.0
"""N, the same of a body that is not rigid, whose instrument may stand on something soft: it then moves by as much as it, the other way."""

STRONGEST_OF_LINKS = 600.0
"""N, the same of what links that are inclined by one, INCLINED, would make: steeper ones are not built."""

CORNERING, MASS, INCLINED = 8e4, 1500.0, 1000.0
"""N that a slip (or an angle of the wheels) of one would make at typical stiffness, that an acceleration of one stands for, and what a wheel
makes that moves aside, fore or aft as far as it rises."""


@dataclass(frozen=True)
class Place:
    """Where a force may act: its port, what an effect file calls what it sees, typical values of what it sees to scale terms by,
    the terms, what the port returns, how many N one of that stands for where it is none, and the strongest that a term may be (N)."""

    port: str
    arguments: tuple[str, ...]
    typical: Mapping[str, object]
    terms: Mapping[str, Term]
    results: tuple[str, ...] = ("force",)
    worth: Mapping[str, float] = field(default_factory=dict)
    strongest: float = STRONGEST


MOTION = SimpleNamespace(
    s=500.0, speed=20.0, side_speed=0.1, vertical_speed=0.04, roll=0.01, pitch=0.008, roll_rate=0.03, pitch_rate=0.02, yaw_rate=0.05,
    vertical_acceleration=0.6, roll_acceleration=0.4, pitch_acceleration=0.3, front=1.2, rear=-1.5,
)  # fmt: skip
"""Typical motion of the body (SI units)."""

PLACES: Mapping[str, Place] = {
    "strut": Place(
        "suspension",
        ("wheel", "deflection", "velocity", "stiffness", "damping", "force_x", "force_y"),
        {"deflection": 0.012, "velocity": 0.12, "stiffness": 28000.0, "damping": 2100.0, "force_x": 300.0, "force_y": 600.0},
        {
            "velocity_direction": Term("tanh(velocity / 0.005)", "N", beside="velocity"),
            "velocity_saturating": saturating("velocity", AXLES),
            "velocity_size": Term("abs(velocity)", "N s/m", beside="velocity"),
            "velocity_signed_square": Term("velocity * abs(velocity)", "N s2/m2", beside="velocity"),
            "velocity_cube": Term("velocity**3", "N s3/m3", beside="velocity"),
            "deflection_square": Term("deflection**2", "N/m2", beside="deflection"),
            "deflection_cube": Term("deflection**3", "N/m3", beside="deflection"),
            "deflection_size_times_velocity": Term("abs(deflection) * velocity", "N s/m2", beside="velocity"),
            "deflection_times_velocity": Term("deflection * velocity", "N s/m2", beside="velocity"),
            "bump_beyond": acting_beyond("max(deflection - clearance, 0.0)", 0.02, 0.005, 0.06),
            "rebound_beyond": acting_beyond("min(deflection + clearance, 0.0)", 0.02, 0.005, 0.06, in_rebound=True),
            "bump_damping_beyond": acting_beyond(
                "max(deflection - clearance, 0.0) * max(velocity, 0.0)", 0.015, 0.0, 0.05, unit="N s/m2", beside="velocity"
            ),
            "rebound_damping_beyond": acting_beyond(
                "min(deflection + clearance, 0.0) * min(velocity, 0.0)", 0.015, 0.0, 0.05, unit="N s/m2", beside="velocity", in_rebound=True
            ),
            "deflection_direction": Term("tanh(deflection / 0.002)", "N", beside="deflection"),
            "velocity_size_times_deflection_direction": Term("abs(velocity) * tanh(deflection / 0.002)", "N s/m", beside="velocity"),
            "deflection_size_times_direction": Term("abs(deflection) * tanh(velocity / 0.005)", "N/m", beside="velocity"),
            "deflection_of_sides": Term(f"deflection * {SIDE}", "N/m"),
            "velocity_of_sides": Term(f"velocity * {SIDE}", "N s/m"),
            "side_force": Term(f"force_y * {SIDE}", "1"),
            "forward_force": Term("force_x", "1"),
            "side_force_size_times_direction": Term("abs(force_y) * tanh(velocity / 0.005)", "1", beside="velocity"),
            "forward_force_size_times_direction": Term("abs(force_x) * tanh(velocity / 0.005)", "1", beside="velocity"),
            "side_force_size_times_velocity": Term("abs(force_y) * velocity", "s/m", beside="velocity"),
            "forward_force_size_times_velocity": Term("abs(force_x) * velocity", "s/m", beside="velocity"),
            "side_force_times_deflection": Term(f"deflection * force_y * {SIDE}", "1/m"),
            "velocity_times_recent": remembering("velocity", "N s2/m2", 1.0, 0.1, 10.0),
            "velocity_times_recent_travel": Term(
                "recent * velocity", "N s/m2", states=(State("recent", f"max({AT_ONCE} * (abs(deflection) - recent), -recent / time)", 0.012),),
                settings=(shape_setting("time", "s", 0.7, 0.1, 5.0, "time in which it forgets how far it travelled"),), beside="velocity",
            ),
            "deflection_times_recent": remembering("deflection", "N s/m2", 4.0, 0.5, 20.0),
            "sliding_direction": sliding("strain", "N", "velocity"),
            "sliding_damping": sliding("abs(velocity) * strain", "N s/m", "velocity"),
            "sliding_under_load": sliding("deflection * strain", "N/m", "strain"),
            "slow_velocity": below("slow", "velocity"),
            "late_velocity": below("slow - velocity"),
            "late_velocity_hardening": hardening(),
            "bump_velocity_when_thrown": when_thrown("max(velocity, 0.0)"),
            "bump_at_first": at_first("max(velocity, 0.0)", "velocity > 0.0"),
            "rebound_at_first": at_first("min(velocity, 0.0)", "velocity < 0.0", in_rebound=True),
            "swinging_deflection": swinging("deflection", 0.006, "deflection - way", "N/m", "force", AXLES, "deflection"),
        },
    ),
    "interconnection": Place(
        "interconnection",
        (
            "wheel", "deflection", "velocity", "deflection_along", "velocity_along", "deflection_across", "velocity_across",
            "deflection_opposite", "velocity_opposite",
        ),
        {"deflection": 0.012, "velocity": 0.12}
        | {f"{motion}_{other}": -size for other in ("along", "across", "opposite") for motion, size in (("deflection", 0.01), ("velocity", 0.1))},
        {
            "stiffness_along": Term("deflection_along", "N/m", parts=WHOLE, beside="deflection"),
            "damping_along": Term("velocity_along", "N s/m", parts=WHOLE, beside="velocity"),
            "slow_stiffness_along": shared_slowly("deflection", "deflection_along", "N/m", 0.02),
            "slow_damping_along": shared_slowly("velocity", "velocity_along", "N s/m", 0.2),
            "damping_saturating_along": saturating("(velocity - velocity_along)", WHOLE),
            "damping_across": Term("velocity_across", "N s/m", beside="velocity"),
            "stiffness_within_across": Term(
                "min(max(deflection - deflection_across, -play), play)", "N/m",
                settings=(shape_setting("play", "m", 0.004, 0.0005, 0.02, "difference of the struts to either side within which it acts"),),
                beside="(deflection - deflection_across)",
            ),
            "sliding_across": sliding("strain", "N", "(velocity - velocity_across)", "(velocity - velocity_across)"),
            "stiffness_opposite": Term("deflection_opposite", "N/m", parts=WHOLE, beside="deflection"),
            "damping_opposite": Term("velocity_opposite", "N s/m", parts=WHOLE, beside="velocity"),
            "damping_saturating_opposite": saturating("(velocity - velocity_opposite)", WHOLE),
        },
    ),
    "tyre": Place(
        "tyre_vertical",
        ("wheel", "deflection", "velocity", "stiffness", "rest", "rotation", "spin"),
        {"deflection": 0.016, "velocity": 0.15, "stiffness": 280000.0, "rest": 0.015, "rotation": 0.0, "spin": 70.0},
        {
            "deflection_square": Term("(deflection - rest)**2", "N/m2", beside="deflection"),
            "deflection_cube": Term("(deflection - rest)**3", "N/m3", beside="deflection"),
            "bump_beyond": acting_beyond("max(deflection - rest - clearance, 0.0)", 0.006, 0.001, 0.03),
            "velocity_direction": Term("tanh(velocity / 0.02)", "N", beside="velocity"),
            "velocity_signed_square": Term("velocity * abs(velocity)", "N s2/m2", beside="velocity"),
            "deflection_times_velocity": Term("(deflection - rest) * velocity", "N s/m2", beside="velocity"),
            "velocity_per_spin": Term("velocity / (1.0 + abs(spin) / 30.0)", "N s/m", beside="velocity"),
            "deflection_of_sides": Term(f"(deflection - rest) * {SIDE}", "N/m"),
            "velocity_of_sides": Term(f"velocity * {SIDE}", "N s/m"),
            "once_a_turn": turning(1),
            "once_a_turn_by_spin": turning(1, "spin**2", "kg m"),
            "twice_a_turn": turning(2),
            "thrice_a_turn": turning(3),
            "often_a_turn": turning_as_heard(),
            "often_a_turn_by_spin": turning_as_heard("spin**2", "kg m"),
            "sliding_direction": sliding("strain", "N", "velocity"),
            "slow_velocity": below("slow", "velocity"),
            "pressed_down": pressed_down(),
        },
        strongest=STRONGEST_OF_TYRE,
    ),
    "contact": Place(
        "tyre_planar",
        ("wheel", "slip_x", "slip_y", "load", "speed", "slope", "force_x"),
        {"slip_x": 0.003, "slip_y": 0.01, "load": 4000.0, "speed": 20.0, "slope": 0.01, "force_x": 300.0},
        {
            "pull_of_load": Term("load", "1", "pull"),
            "pull_of_load_on_sides": Term(f"load * {SIDE}", "1", "pull"),
            "pull_of_load_and_speed": Term("load * speed**2", "s2/m2", "pull"),
            "pull_of_slope": Term("load * slope", "1", "pull"),
            "pull_of_slope_size": Term("load * abs(slope)", "1", "pull"),
            "slip_of_load": Term("load", "1/N", "slip_x", beside="slip_x"),
            "side_slip": Term("slip_y", "1", "slip_y"),
            "side_slip_of_load": Term("slip_y * load", "1/N", "slip_y", beside="slip_y"),
            "side_slip_of_load_on_sides": Term(f"load * {SIDE}", "1/N", "slip_y", beside=SIDE),
            "side_slip_of_speed": Term("slip_y * speed", "s/m", "slip_y", beside="slip_y"),
            "side_slip_cube": Term("slip_y**3", "1", "slip_y", beside="slip_y"),
            "side_slip_of_sides": Term(SIDE, "1", "slip_y"),
            "side_slip_within": Term(
                "min(max(slip_y, -play), play)", "1", "slip_y",
                settings=(shape_setting("play", "1", 0.002, 0.0003, 0.02, "slip angle to either side within which it acts"),), beside="slip_y",
            ),
            "side_slip_swinging": swinging("slip_y", 0.01, "way", "1", "slip_y", AXLES, "slip_y"),
            "side_slip_late": Term(
                "late - slip_y", "1", "slip_y", states=(State("late", f"min(speed / length, {CHANGING}) * (slip_y - late)", 0.005),),
                settings=(shape_setting("length", "m", 0.5, 0.1, 3.0, "way over which the slip follows"),),
            ),
            "side_slip_of_late_load": Term(
                "slip_y * (late - load) / max(load, 400.0)", "1", "slip_y", states=(State("late", f"min(speed / length, {CHANGING}) * (load - late)", 3500.0),),
                settings=(shape_setting("length", "m", 0.5, 0.1, 3.0, "way over which the force follows the load"),),
            ),
            "side_slip_of_push": Term(f"force_x * {SIDE}", "1/N", "slip_y"),
            "pull_of_push_on_sides": Term(f"force_x * {SIDE}", "1", "pull"),
            "side_slip_once_a_turn": running_out_aside(),
        },
        ("slip_x", "slip_y", "pull"),
        {"slip_x": CORNERING, "slip_y": CORNERING},
    ),
    "links": Place(
        "kinematics",
        ("wheel", "deflection"),
        {"deflection": 0.012},
        {
            "recession": Term("1.0", "1", "recession"),
            "recession_of_deflection": Term("deflection", "1/m", "recession"),
            "scrub": Term("1.0", "1", "scrub"),
            "scrub_of_sides": Term(SIDE, "1", "scrub"),
            "scrub_of_deflection_on_sides": Term(f"deflection * {SIDE}", "1/m", "scrub"),
            "toe_of_deflection": Term("deflection", "rad/m", "toe"),
            "toe_of_deflection_on_sides": Term(f"deflection * {SIDE}", "rad/m", "toe"),
            "toe_of_deflection_square_on_sides": Term(f"deflection**2 * {SIDE}", "rad/m2", "toe", beside=f"deflection * {SIDE}"),
            "toe_late_on_sides": Term(
                f"{2 * pi:.4f} * frequency * (deflection - slow) * {SIDE}", "rad s/m", "toe",
                states=(State("slow", f"{2 * pi:.4f} * frequency * (deflection - slow)", 0.0107),),
                settings=(shape_setting("frequency", "Hz", 15.0, 3.0, FASTEST, "frequency up to which it goes by the speed of travel"),),
                beside=f"deflection * {SIDE}",
            ),
            "toe_dragged_on_sides": Term(
                f"(deflection - held) * {SIDE}", "rad/m", "toe",
                states=(State("held", "100.0 * (max(deflection - held - way, 0.0) + min(deflection - held + way, 0.0))", 0.008),),
                settings=(shape_setting("way", "m", 0.003, 0.0005, 0.01, "travel to either side until it slides"),),
                beside=f"deflection * {SIDE}",
            ),
        },
        ("recession", "toe", "scrub"),
        {"recession": INCLINED, "toe": CORNERING, "scrub": INCLINED},
        STRONGEST_OF_LINKS,
    ),
    "body": Place(
        "body",
        ("motion",),
        {"motion": MOTION},
        {
            "drag": Term("motion.speed**2", "N s2/m2", "force_x", WHOLE),
            "side_slip": Term("motion.speed * motion.side_speed", "N s2/m2", "force_y", WHOLE),
            "lift": Term("motion.speed**2", "N s2/m2", "force_z", WHOLE),
            "heave_damping": Term("motion.vertical_speed", "N s/m", "force_z", WHOLE),
            "heave_damping_of_speed": Term("motion.speed * motion.vertical_speed", "N s2/m2", "force_z", WHOLE, beside="motion.vertical_speed"),
            "heave_mass": Term("motion.vertical_acceleration", "kg", "force_z", WHOLE),
            "roll_damping": Term("motion.roll_rate", "N m s", "moment_x", WHOLE),
            "roll_stiffness": Term("motion.roll", "N m", "moment_x", WHOLE),
            "roll_saturating": Term(
                "motion.roll / (1.0 + abs(motion.roll) / knee)", "N m", "moment_x", WHOLE, settings=(ANGLE,), beside="motion.roll"
            ),
            "roll_cube": Term("motion.roll**3", "N m", "moment_x", WHOLE, beside="motion.roll"),
            "roll_stiffness_of_speed": Term("motion.speed**2 * motion.roll", "kg", "moment_x", WHOLE, beside="motion.roll"),
            "roll_rate_direction": Term("tanh(motion.roll_rate / 0.005)", "N m", "moment_x", WHOLE, beside="motion.roll_rate"),
            "roll_sliding": Term(
                "strain", "N m", "moment_x", WHOLE,
                (strained("motion.roll_rate", "grip"),),
                (shape_setting("grip", "rad", 0.002, 0.0003, 0.02, "angle over which the direction turns"),), beside="motion.roll_rate",
            ),
            "roll_inertia": Term("motion.roll_acceleration", "kg m2", "moment_x", WHOLE),
            "roll_of_turning": Term("motion.speed * motion.yaw_rate", "kg m", "moment_x", WHOLE),
            "roll_of_late_turning": following("motion.speed * motion.yaw_rate", 1.0, 0.1, "kg m", "moment_x", "motion.speed * motion.yaw_rate"),
            "lift_of_turning": Term("motion.speed * motion.yaw_rate", "kg", "force_z", WHOLE),
            "pitch_of_turning": Term("motion.speed * motion.yaw_rate", "kg m", "moment_y", WHOLE),
            "push_of_pitching": following("motion.pitch_rate", 0.02, 0.05, "N s", "force_x", above="height"),
            "pitch_damping": Term("motion.pitch_rate", "N m s", "moment_y", WHOLE),
            "pitch_stiffness": Term("motion.pitch", "N m", "moment_y", WHOLE),
            "pitch_stiffness_of_speed": Term("motion.speed**2 * motion.pitch", "kg", "moment_y", WHOLE, beside="motion.pitch"),
            "pitch_inertia": Term("motion.pitch_acceleration", "kg m2", "moment_y", WHOLE),
            "pitch_of_speed": Term("motion.speed**2", "kg", "moment_y", WHOLE),
            "yaw_damping": Term("motion.yaw_rate", "N m s", "moment_z", WHOLE),
            "yaw_rate_direction": Term(
                "tanh(motion.yaw_rate / knee)", "N m", "moment_z", WHOLE,
                settings=(shape_setting("knee", "rad/s", 0.02, 0.002, 0.2, "yaw rate above which it slips"),), beside="motion.yaw_rate",
            ),
            "yaw_of_side_slip": Term("motion.speed * motion.side_speed", "kg", "moment_z", WHOLE),
            "yaw_of_roll": Term("motion.roll", "N m", "moment_z", WHOLE),
            "side_force_of_roll": Term("motion.roll", "N", "force_y", WHOLE),
            "yaw_of_rolling": Term("motion.roll_acceleration", "kg m2", "moment_z", WHOLE),
            "roll_of_yawing": Term(
                f"{AT_ONCE} * (motion.yaw_rate - past)", "kg m2", "moment_x", WHOLE,
                (State("past", f"{AT_ONCE} * (motion.yaw_rate - past)", 0.047),),
            ),
            "roll_of_bounce": Term("motion.vertical_acceleration", "kg m", "moment_x", WHOLE),
            "lift_of_rolling": Term("motion.roll_acceleration", "kg m", "force_z", WHOLE),
            "pitch_of_bounce": Term("motion.vertical_acceleration", "kg m", "moment_y", WHOLE),
            "lift_of_pitching": Term("motion.pitch_acceleration", "kg m", "force_z", WHOLE),
            **{
                f"resonance_{axle}": on_spring(
                    f"motion.vertical_acceleration - motion.{axle} * motion.pitch_acceleration", 0.6, "kg", "force_z", f"motion.{axle}"
                )
                for axle in AXLES
            },
            **{
                f"heave_damping_{axle}": following(
                    f"motion.vertical_speed - motion.{axle} * motion.pitch_rate", 0.05, 0.02, "N s/m", "force_z", ahead=f"motion.{axle}"
                )
                for axle in AXLES
            },
            "sway_rear": on_spring("motion.speed * motion.yaw_rate", 1.0, "kg", "force_y", "motion.rear", (1.2, 0.4, 6.0)),
            "swaying": swaying(),
            "steering_along": steering_along(),
            "roll_resonance": on_spring("motion.roll_acceleration", 0.4, "kg m2", "moment_x"),
            "pitch_resonance": on_spring("motion.pitch_acceleration", 0.3, "kg m2", "moment_y", frequencies=(8.0, 3.0, 25.0)),
            "surge_above": on_spring("motion.pitch_acceleration", 0.3, "kg m", "force_x", frequencies=(8.0, 3.0, 25.0)),
            "shaking_up": coming_back("m", "N", "force_z", ahead="place"),
            "shaking_along": coming_back("m", "N", "force_x", above="height"),
            "shaking_in_roll": coming_back("m", "N m", "moment_x"),
            "shaking_in_yaw": coming_back("m", "N m", "moment_z"),
            "whirling": coming_back("m", "N", "force_z", parts=WHIRL, ahead="place", above="height"),
            "whirling_by_speed": coming_back("m", "N s2/m2", "force_z", "motion.speed**2", WHIRL, "place", "height"),
            "humming_up": coming_back("s", "N", "force_z", ahead="place"),
            "humming_along": coming_back("s", "N", "force_x", above="height"),
            "humming_in_roll": coming_back("s", "N m", "moment_x"),
            "humming_around": coming_back("s", "N", "force_z", parts=WHIRL, ahead="place", above="height"),
        },
        ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"),
    ),
    "steering": Place(
        "steer",
        ("angle", "speed", "force_y"),
        {"angle": 0.01, "speed": 20.0, "force_y": 1000.0},
        {
            "angle_late": Term(
                "late - angle", "1", "angle", WHOLE, (State("late", "(angle - late) / time", 0.008),),
                (shape_setting("time", "s", 0.05, 0.01, 0.5, "time that it is late by"),),
            ),
            "angle_after_play": Term(
                "held - angle", "1", "angle", WHOLE,
                (State("held", "100.0 * (max(angle - held - play, 0.0) + min(angle - held + play, 0.0))", 0.008),),
                (shape_setting("play", "rad", 0.001, 0.0001, 0.01, "angle to either side by which it does not follow"),),
            ),
            "angle_of_force": Term("force_y", "rad/N", "angle", WHOLE),
            "angle_swinging_with_force": swinging("force_y", 1000.0, "way", "rad/N", "angle", WHOLE),
            "angle_cube": Term("angle**3", "1/rad2", "angle", WHOLE, beside="angle"),
            "angle_of_speed": Term("angle * speed", "s/m", "angle", WHOLE, beside="angle"),
        },
        ("angle",),
        {"angle": CORNERING},
    ),
    "structure": Place(
        "flexing",
        ("motion", "x", "y", "z"),
        {"motion": MOTION, "x": 0.3, "y": 0.2, "z": 0.5},
        {
            "bending": on_spring(
                "motion.vertical_acceleration - x * motion.pitch_acceleration + y * motion.roll_acceleration", 0.6, "1", "a_z",
                frequencies=OF_STRUCTURE,
            ),
            "racking_aside": on_spring(
                "motion.speed * motion.yaw_rate - z * motion.roll_acceleration", 0.5, "1", "a_y", frequencies=OF_STRUCTURE
            ),
            "racking_along": on_spring("z * motion.pitch_acceleration", 0.2, "1", "a_x", frequencies=OF_STRUCTURE),
        },
        ("a_x", "a_y", "a_z"),
        {"a_x": MASS, "a_y": MASS, "a_z": MASS},
        strongest=STRONGEST_OF_STRUCTURE,
    ),
}  # fmt: skip


def parameter(term: str, part: str) -> str:
    """Name of a term's factor for one part of the car, or of one of its settings."""
    return f"{term}_{part}" if part else term


def settings(place: str, term: str) -> tuple[Parameter, ...]:
    """What shapes a term."""
    own = PLACES[place].terms[term]
    return (*own.settings, LINEAR) if own.beside else own.settings


def scale(place: str, term: str) -> float:
    """Size of a term with a factor of one at typical motion, in N or N m; of a slip, the force that it makes."""
    own = PLACES[place].terms[term]
    return _size(place, term, own.expression) * PLACES[place].worth.get(own.result, 1.0)


def at_typical(place: str, term: str, shaped: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """What a term with a factor of one returns at typical motion, in the unit of that per unit of the factor, and what it sees there by name;
    ``shaped``: what shapes it, where that is not as is typical."""
    own = PLACES[place].terms[term]
    known = _known(place, term, own.expression) | {setting.name: shaped[setting.name] for setting in own.settings if setting.name in shaped}
    seen = {name: known[name] for name in dict.fromkeys(re.findall(r"[a-z_]+", own.expression)) if name in PLACES[place].typical}
    seen |= {name: getattr(MOTION, name) for name in dict.fromkeys(re.findall(r"motion\.(\w+)", own.expression))}
    return _evaluated(own.expression, known), {name: abs(value) for name, value in seen.items() if not isinstance(value, SimpleNamespace)}


def _size(place: str, term: str, expression: str) -> float:
    return _evaluated(expression, _known(place, term, expression))


def _evaluated(expression: str, known: Mapping[str, object]) -> float:
    return abs(float(eval(expression, {"__builtins__": {}}, known)))  # an expression of this file, not of a user


def _known(place: str, term: str, expression: str) -> dict[str, object]:
    """What the ``expression`` of a term is evaluated with at typical motion."""
    own, typical = PLACES[place].terms[term], PLACES[place].typical
    known = {**typical, "wheel": 0, "tanh": np.tanh, "abs": abs, "max": max, "min": min}
    known |= {state.name: state.typical for state in own.states} | {one.name: one.typical for one in own.settings}
    if "clearance" in known or "rest" in expression:
        known |= {key: 2 * value for key, value in typical.items() if key != "rest"}
    if own.in_rebound:
        known |= {key: -known[key] for key in typical}
    return known


def expression(place: str, term: str, linear: bool, share: float | None = None) -> str:
    """The expression of a term, with its linear part where that is wanted: as a number for a ``share`` of the term that is known."""
    own = PLACES[place].terms[term]
    if not (own.beside and linear):
        return own.expression
    times = _size(place, term, own.expression) / _size(place, term, own.beside)
    if share is not None:
        return f"{own.expression} {'-' if share < 0 else '+'} {abs(share) * times:.4g} * {own.beside}"
    return f"{own.expression} + linear * {times:.4g} * {own.beside}".replace(" * 1 * ", " * ")
