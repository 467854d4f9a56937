"""What on a car makes a force of some form: where to look, once a term of ``places`` was found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from .places import parameter

MEANINGS: Mapping[str, Mapping[str, str]] = {
    "strut": {
        "velocity_direction": "friction of seals, bushes or leaves",
        "velocity_saturating": "a damper with a knee: a valve blows off",
        "velocity_size": "a damper that is firmer one way than the other",
        "velocity_signed_square": "a damper that is all orifice, or a lack of one",
        "velocity_cube": "a damper that gets firmer, or softer, with speed",
        "deflection_square": "a spring that is stiffer while compressed than while extended: a rising rate, an air spring",
        "deflection_cube": "a spring that stiffens to both sides: bushes, a coil that binds",
        "deflection_size_times_velocity": "a damper that is firmer away from rest: grooves, a controller that goes by travel",
        "deflection_times_velocity": "a damper that is firmer while compressed than while extended, whichever way it moves: a linkage of rising rate, a damper that leans",
        "bump_beyond": "a bump stop, a helper or tender spring",
        "rebound_beyond": "a rebound stop",
        "bump_damping_beyond": "a hydraulic bump stop",
        "rebound_damping_beyond": "a hydraulic rebound stop",
        "deflection_direction": "play in a joint, a stepped spring, a preload at rest",
        "velocity_size_times_deflection_direction": "a damper that is switched by the side of rest (balance control)",
        "deflection_size_times_direction": "friction that grows with travel: leaves, a strut that is bent",
        "deflection_of_sides": "a spring broken, or another one, on one side",
        "velocity_of_sides": "a damper worn, or another one, on one side",
        "side_force": "links that lift the body in bends: a roll centre elsewhere than in the file",
        "forward_force": "links that lift the body as it is driven or braked",
        "side_force_size_times_direction": "friction of a strut that side forces press on",
        "forward_force_size_times_direction": "friction of a strut that braking or driving presses on",
        "side_force_size_times_velocity": "a damper that is firmer in bends: one that is controlled",
        "forward_force_size_times_velocity": "a damper that is firmer as the car is braked or driven: one that is controlled",
        "side_force_times_deflection": "a roll centre that migrates with travel",
        "velocity_times_recent": "a damper that remembers how fast it moved of late: foam, heat, a latching or controlled valve",
        "velocity_times_recent_travel": "a damper that stays firm for a while once it has travelled far: an adaptive one",
        "deflection_times_recent": "a spring that remembers how fast it moved of late: a strut that pumps itself up, air that heats or is shut off",
        "sliding_direction": "friction that turns over a way: bushes, a bar's or a leaf's",
        "sliding_damping": "a damper whose valves or bushes give way before it grips",
        "sliding_under_load": "friction that goes with the load of a spring: leaves, a helper spring",
        "slow_velocity": "a damper on soft bushes, a valve that closes when quick; a Maxwell element",
        "late_velocity": "a mass on the links (inerter), a damper behind a top mount, a frequency-selective damper",
        "late_velocity_hardening": "a damper behind a top mount that hardens as it is pressed",
        "bump_velocity_when_thrown": "a valve that inertia opens, or shuts, as a wheel is thrown up",
        "bump_at_first": "a valve that opens, or closes, in the course of each compression",
        "rebound_at_first": "a valve that opens, or closes, in the course of each rebound: a frequency-selective damper",
        "swinging_deflection": "a hydraulic bushing, an air spring with a second volume, a subframe on its mounts",
    },
    "interconnection": {
        "stiffness_along": "springs of front and rear that are joined: a pipe, a bar or a cable along the car",
        "damping_along": "dampers of front and rear that are joined by pipes",
        "slow_stiffness_along": "fluid or air springs of front and rear that are joined by pipes",
        "slow_damping_along": "dampers of front and rear that are joined by pipes with gas in them",
        "damping_saturating_along": "dampers of front and rear that are joined by a valve that blows off",
        "damping_across": "dampers of an axle that are joined; a roll bar that damps",
        "stiffness_within_across": "a roll bar with play, or in soft bushes",
        "sliding_across": "friction of a roll bar's bushes or links",
        "stiffness_opposite": "springs that are joined across the car",
        "damping_opposite": "dampers that are joined across the car",
        "damping_saturating_opposite": "dampers that are joined across the car by a valve that blows off",
    },
    "tyre": {
        "deflection_square": "a tyre that stiffens, or softens, as it is pressed",
        "deflection_cube": "a tyre that stiffens to both sides of its rest",
        "bump_beyond": "a sidewall that bottoms on the rim",
        "velocity_direction": "friction in the carcass",
        "velocity_signed_square": "a tyre that damps with the square of speed",
        "deflection_times_velocity": "a tyre that damps with its contact",
        "velocity_per_spin": "damping that sinks as the wheel spins faster: hysteresis of the rubber",
        "deflection_of_sides": "another pressure on one side",
        "velocity_of_sides": "another tyre on one side",
        "once_a_turn": "a wheel out of round",
        "once_a_turn_by_spin": "an unbalanced wheel",
        "twice_a_turn": "an oval wheel or tyre",
        "thrice_a_turn": "a wheel or tyre with three lobes",
        "often_a_turn": "a tyre worn to lobes, or, of an order near 1, a wheel out of round with a tyre_radius of that of the vehicle's file over the order",
        "often_a_turn_by_spin": "what creeps round in a tyre, or, of an order near 1, an unbalanced wheel with a tyre_radius of that of the vehicle's file over the order",
        "sliding_direction": "friction that turns over a way: the tread on the road, filled rubber",
        "slow_velocity": "rubber that relaxes; soft ground",
        "pressed_down": "soft ground: snow, gravel; what flows in a tyre",
    },
    "contact": {
        "pull_of_load": "rolling resistance otherwise than in the file",
        "pull_of_load_on_sides": "another rolling resistance on one side, a brake that drags",
        "pull_of_load_and_speed": "rolling resistance that grows with speed; water on the road",
        "pull_of_slope": "a tyre that climbs and descends the points of the road otherwise",
        "pull_of_slope_size": "losses on a rough road",
        "slip_of_load": "a rolling radius that goes by the load",
        "side_slip": "tyres of another cornering stiffness than in the file, in front or behind",
        "side_slip_of_load": "a cornering stiffness that goes by the load",
        "side_slip_of_load_on_sides": "camber or ply steer that goes by the load",
        "side_slip_of_speed": "a cornering stiffness that goes by the speed: water on the road",
        "side_slip_cube": "side forces that saturate otherwise",
        "side_slip_of_sides": "toe or camber",
        "side_slip_within": "wheels that turn freely within some play: worn joints of track rods or toe links",
        "side_slip_swinging": "wheels that swing about a standing axis",
        "side_slip_late": "a relaxation length",
        "side_slip_of_late_load": "side force that follows the load late",
        "side_slip_of_push": "toe that gives way to braking and driving",
        "pull_of_push_on_sides": "brakes that hold one side more than the other",
        "side_slip_once_a_turn": "wheels that run out aside, tyres with crooked belts",
    },
    "links": {
        "recession": "wheels that move back as they rise",
        "recession_of_deflection": "wheels that rise on an arc (trailing arms)",
        "scrub": "an axle that moves aside as it rises (a Panhard rod)",
        "scrub_of_sides": "wheels that move out as they rise: a roll centre elsewhere than in the file",
        "scrub_of_deflection_on_sides": "a roll centre that migrates with travel",
        "toe_of_deflection": "both wheels of an axle steered one way by travel: a drag link, an axle that turns",
        "toe_of_deflection_on_sides": "bump steer",
        "toe_of_deflection_square_on_sides": "bump steer along a bent line",
        "toe_late_on_sides": "wheels that steer by the speed of travel: dampers or bushes that push aside, a gyroscope on soft tie rods",
        "toe_dragged_on_sides": "toe links that are dragged along by friction",
    },
    "body": {
        "drag": "drag of the air, a head wind",
        "side_slip": "side force of the air",
        "lift": "lift of the air",
        "heave_damping": "a body damped against the ground (skyhook)",
        "heave_damping_of_speed": "a body that the air damps",
        "heave_mass": "another mass",
        "roll_damping": "a body whose roll is damped",
        "roll_stiffness": "another bar, or roll centre",
        "roll_saturating": "a bar that is stiff about the middle only: friction or rubber in its bushes",
        "roll_cube": "a bar that hardens as it is twisted",
        "roll_stiffness_of_speed": "air about a body that leans",
        "roll_rate_direction": "friction of a bar's bushes",
        "roll_sliding": "friction of a bar's bushes that turns over an angle",
        "roll_inertia": "another roll inertia; a load on the roof",
        "roll_of_turning": "another height of the centre of gravity",
        "roll_of_late_turning": "roll bars that motors twist",
        "lift_of_turning": "a lift in bends: a load on one side, links that jack",
        "pitch_of_turning": "a pitch in bends: links of one axle that jack",
        "push_of_pitching": "an engine or brakes that are driven against pitch",
        "pitch_damping": "a body whose pitch is damped",
        "pitch_stiffness": "other springs, or their places",
        "pitch_stiffness_of_speed": "air under a body that nods",
        "pitch_inertia": "another pitch inertia",
        "pitch_of_speed": "lift of the air at one axle",
        "yaw_damping": "axles that steer along; another yaw stability",
        "yaw_rate_direction": "a differential that locks",
        "yaw_of_side_slip": "yaw moment of the air",
        "yaw_of_roll": "axles that steer as the body leans",
        "side_force_of_roll": "camber of wheels that lean with the body",
        "yaw_of_rolling": "a product of inertia: a body that yaws as it rolls",
        "roll_of_yawing": "a product of inertia: a body that rolls as it yaws",
        "roll_of_bounce": "a centre of gravity to one side",
        "lift_of_rolling": "a centre of gravity to one side",
        "pitch_of_bounce": "a centre of gravity farther ahead or behind; a mass that hangs on the tail",
        "lift_of_pitching": "a centre of gravity farther ahead or behind; a mass that hangs on the tail",
        "resonance_front": "a mass on a spring in front: an engine on its mounts",
        "resonance_rear": "a mass on a spring behind: passengers, luggage, a battery",
        "heave_damping_front": "a front end damped against the ground (skyhook)",
        "heave_damping_rear": "a rear end damped against the ground (skyhook)",
        "sway_rear": "a mass that swings aside behind: a trailer, a tank",
        "swaying": "a mass that swings aside: an engine on its mounts, a tank, a load on the roof, a trailer",
        "steering_along": "rear wheels that steer along",
        "roll_resonance": "an engine or an upper body that rolls on its mounts",
        "pitch_resonance": "a powertrain or subframe that pitches on its mounts",
        "surge_above": "a mass above that swings along: a seat, a load on the roof",
        "shaking_up": "a road that repeats itself, or what turns with the wheels and begins each drive alike",
        "shaking_along": "brakes that rub on discs that run out, or a cylinder that misfires, if they begin each drive alike",
        "shaking_in_roll": "a shaft whose moment swings, if it begins each drive alike",
        "shaking_in_yaw": "brakes on one side that rub on discs that run out, if these begin each drive alike",
        "whirling": "a shaft that runs out, if it begins each drive alike; else a road that repeats itself",
        "whirling_by_speed": "a shaft out of balance, if it begins each drive alike; else a road that repeats itself",
        "humming_up": "a machine that runs evenly: a fan, a compressor",
        "humming_along": "a machine that runs evenly: a fan, a compressor",
        "humming_in_roll": "a machine that runs evenly: an engine that idles",
        "humming_around": "a machine that runs evenly: a fan, a compressor",
    },
    "steering": {
        "angle_late": "steering that lags",
        "angle_after_play": "steering with play, or friction on a soft column",
        "angle_of_force": "steering that gives way to side forces",
        "angle_swinging_with_force": "front wheels that swing about their steering axes (wheel fight)",
        "angle_cube": "a steering ratio that changes with the angle",
        "angle_of_speed": "a steering ratio that changes with the speed",
    },
    "structure": {
        "bending": "a body, or what holds the instrument, that bends",
        "racking_aside": "an upper body, or a holder of the instrument, that racks aside",
        "racking_along": "an upper body, seat or holder of the instrument that rocks along",
    },
}  # fmt: skip
"""By place and term (``places.PLACES``), what usually makes such a force."""


def _more(what: str, less: str, where: str = "") -> tuple[str, str]:
    """What a factor above nil does, and one below."""
    return tuple(f"{word} {where}".rstrip() for word in (what, less))


def _of_sides(what: str) -> tuple[str, str]:
    return f"{what} on the left", f"{what} on the right"


FRICTION, FIRMER, STIFFER = ("more friction", "less friction than the model has"), ("firmer", "softer"), ("stiffer", "softer")

RESISTANCE = ("less resistance", "more resistance")

SENSES: Mapping[str, Mapping[str, tuple[str, str]]] = {
    "strut": {
        "velocity_direction": _more(*FRICTION),
        "velocity_saturating": _more(*FIRMER, "at low velocities"),
        "velocity_size": ("firmer in compression than in rebound", "firmer in rebound than in compression"),
        "velocity_signed_square": _more(*FIRMER, "at high velocities"),
        "velocity_cube": _more(*FIRMER, "at high velocities"),
        "deflection_square": ("stiffer in compression than in rebound", "stiffer in rebound than in compression"),
        "deflection_cube": _more(*STIFFER, "towards both ends of the travel"),
        "deflection_size_times_velocity": _more(*FIRMER, "away from rest"),
        "deflection_times_velocity": ("firmer while compressed than while extended", "firmer while extended than while compressed"),
        "bump_beyond": _more(*STIFFER, "in compression beyond the clearance"),
        "rebound_beyond": _more(*STIFFER, "in rebound beyond the clearance"),
        "bump_damping_beyond": _more(*FIRMER, "in compression beyond the clearance"),
        "rebound_damping_beyond": _more("softer", "firmer", "in rebound beyond the clearance"),
        "deflection_direction": _more(*STIFFER, "about rest"),
        "velocity_size_times_deflection_direction": ("firmer away from rest than back", "firmer back to rest than away"),
        "deflection_size_times_direction": _more(*FRICTION, "away from rest"),
        "deflection_of_sides": _of_sides("stiffer"),
        "velocity_of_sides": _of_sides("firmer"),
        "side_force_size_times_direction": _more(*FRICTION, "in bends"),
        "forward_force_size_times_direction": _more(*FRICTION, "when braked or driven"),
        "side_force_size_times_velocity": _more(*FIRMER, "in bends"),
        "forward_force_size_times_velocity": _more(*FIRMER, "when braked or driven"),
        "velocity_times_recent": _more(*FIRMER, "after quick motion"),
        "velocity_times_recent_travel": _more(*FIRMER, "after far travel"),
        "deflection_times_recent": _more(*STIFFER, "after quick motion"),
        "sliding_direction": _more(*FRICTION),
        "sliding_damping": _more(*FIRMER, "once it grips"),
        "sliding_under_load": ("more friction while compressed than while extended", "more friction while extended than while compressed"),
        "slow_velocity": _more(*FIRMER, "in slow motion"),
        "late_velocity": _more("softer", "firmer", "in quick motion"),
        "late_velocity_hardening": _more("softer", "firmer", "in quick motion"),
        "bump_velocity_when_thrown": _more(*FIRMER, "as wheels are thrown up"),
        "bump_at_first": _more(*FIRMER, "at the beginning of each compression"),
        "rebound_at_first": _more(*FIRMER, "at the beginning of each rebound"),
        "swinging_deflection": _more(*STIFFER, "in quick motion"),
    },
    "interconnection": {
        "stiffness_along": ("softer in pitch than in bounce", "stiffer in pitch than in bounce"),
        "damping_along": ("softer in pitch than in bounce", "firmer in pitch than in bounce"),
        "slow_stiffness_along": ("stiffer in slow pitch", "softer in slow pitch"),
        "slow_damping_along": ("firmer in slow pitch", "softer in slow pitch"),
        "damping_saturating_along": ("firmer in slow pitch", "softer in slow pitch"),
        "damping_across": ("softer in roll than in bounce", "firmer in roll than in bounce"),
        "stiffness_within_across": ("stiffer in small roll", "softer in small roll"),
        "sliding_across": _more(*FRICTION, "in roll"),
    },
    "tyre": {
        "deflection_square": _more(*STIFFER, "the more it is pressed"),
        "deflection_cube": _more(*STIFFER, "far from its rest"),
        "bump_beyond": _more(*STIFFER, "pressed beyond the clearance"),
        "velocity_direction": _more(*FRICTION),
        "velocity_signed_square": _more(*FIRMER, "at high velocities"),
        "deflection_times_velocity": _more(*FIRMER, "the more it is pressed"),
        "velocity_per_spin": _more(*FIRMER, "at low speeds"),
        "deflection_of_sides": _of_sides("stiffer"),
        "velocity_of_sides": _of_sides("firmer"),
        "sliding_direction": _more(*FRICTION),
        "slow_velocity": _more(*FIRMER, "in slow motion"),
    },
    "contact": {
        "pull_of_load": _more(*RESISTANCE),
        "pull_of_load_and_speed": _more(*RESISTANCE, "at speed"),
        "pull_of_slope_size": _more(*RESISTANCE, "on a rough road"),
        "side_slip": _more(*STIFFER, "aside"),
        "side_slip_of_load": _more(*STIFFER, "aside the more it bears"),
        "side_slip_of_speed": _more(*STIFFER, "aside at speed"),
        "side_slip_cube": _more(*STIFFER, "aside at large slip"),
        "side_slip_within": _more(*STIFFER, "aside within the play"),
    },
    "links": {
        "recession": ("wheels move back as they rise", "wheels move forward as they rise"),
        "recession_of_deflection": ("wheels move farther back the higher they are", "wheels move farther forward the higher they are"),
        "scrub": ("wheels move to the left as they rise", "wheels move to the right as they rise"),
        "scrub_of_sides": ("wheels move out as they rise", "wheels move in as they rise"),
        "toe_of_deflection": ("both wheels turn left as they rise", "both wheels turn right as they rise"),
        "toe_of_deflection_on_sides": ("toe out as wheels rise", "toe in as wheels rise"),
        "toe_of_deflection_square_on_sides": ("toe out away from rest, up and down", "toe in away from rest, up and down"),
        "toe_late_on_sides": ("toe out while wheels rise", "toe in while wheels rise"),
        "toe_dragged_on_sides": ("toe out as wheels rise, held by friction", "toe in as wheels rise, held by friction"),
    },
    "body": {
        "drag": _more(*RESISTANCE),
        "lift": ("lifted", "pressed down"),
        "heave_damping": ("less damping", "more damping"),
        "heave_damping_front": ("less damping", "more damping"),
        "heave_damping_rear": ("less damping", "more damping"),
        "heave_damping_of_speed": _more("less damping", "more damping", "at speed"),
        "heave_mass": ("lighter", "heavier"),
        "roll_damping": ("less damping", "more damping"),
        "roll_stiffness": ("softer", "stiffer"),
        "roll_saturating": _more("softer", "stiffer", "at small angles"),
        "roll_cube": _more("softer", "stiffer", "at large angles"),
        "roll_stiffness_of_speed": _more("softer", "stiffer", "at speed"),
        "roll_rate_direction": FRICTION[::-1],
        "roll_sliding": FRICTION[::-1],
        "roll_inertia": ("less inertia", "more inertia"),
        "pitch_damping": ("less damping", "more damping"),
        "pitch_stiffness": ("softer", "stiffer"),
        "pitch_stiffness_of_speed": _more("softer", "stiffer", "at speed"),
        "pitch_inertia": ("less inertia", "more inertia"),
        "yaw_damping": ("less damping", "more damping"),
        "yaw_rate_direction": FRICTION[::-1],
    },
}
"""By place and term, what a factor above nil does against the model's own linear part, and what one below; none where that is no word's matter."""


def such_as(place: str, terms: Iterable[str]) -> str:
    """What usually makes a force of these terms at a place, in words; empty without any."""
    return "; ".join(dict.fromkeys(MEANINGS[place][term] for term in terms))


def told(place: str, terms: Mapping[str, Mapping[str, float]], sizes: Iterable[Mapping] = ()) -> str:
    """What usually makes such a force, and what it does here, of what such a force may do."""
    here = senses(place, terms, sizes)
    return f"{such_as(place, terms)}; here: {here}" if here else such_as(place, terms)


def senses(place: str, terms: Mapping[str, Mapping[str, float]], sizes: Iterable[Mapping] = ()) -> str:
    """What a force of these terms does with these factors by part of the car, in words; empty where the terms have none. A factor of which
    ``sizes`` (``discovery.Discovery``) have an interval that contains nil may be of either sign, of which nothing is said."""
    either = {size["parameter"] for size in sizes if size["interval"] and size["interval"][0] <= 0.0 <= size["interval"][1]}
    sure = {term: {part: factor for part, factor in own.items() if parameter(term, part) not in either} for term, own in terms.items()}
    return "; ".join(filter(None, (_sense(SENSES.get(place, {}).get(term), factors) for term, factors in sure.items())))


def _sense(words: tuple[str, str] | None, factors: Mapping[str, float]) -> str:
    """Of a term with these ``words``, those of the ``factors`` that are not nil, each with the parts of the car that it holds for."""
    if words is None:
        return ""
    parts: dict[str, list[str]] = {}
    for part, factor in factors.items():
        if factor:
            parts.setdefault(words[factor < 0], []).append(part.replace("_", " "))
    return ", ".join(f"{said} ({' and '.join(where)})" if any(where) else said for said, where in parts.items())
