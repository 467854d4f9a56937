"""The kinds of blind trials, each drawn from its seed: what is hidden, how the data are spoilt, what the search is left with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ridecomfort.discrepancy.candidates import candidate
from ridecomfort.discrepancy.opening import UNCERTAIN
from ridecomfort.effects import library
from ridecomfort.vehicle.parameters import PARAMETERS

KAPPAS = (0.05, 0.1, 0.3, 1.0, 3.0)

STRONG = (0.3, 1.0, 3.0)

STRIDE = 13
"""By how many effects the turn of a seed begins later than that of the seed before: one round is not always of the first of the library. Odd,
so that kinds by turns alternate between seeds, too."""

FAINT = ("aerodynamic_lift", "anti_dive", "anti_squat", "bump_stop", "drivetrain_lag", "gear_shift", "rebound_stop",
         "tyre_enveloping", "tyre_progression", "wheel_compliance")  # fmt: skip
"""Effects whose plausible sizes, typically shaped, come up to no kappa of 0.3 (``score.level``) on such drives, bump stops on few of them (two
roads of 13); they are drawn alone only."""

MADE_UP = ("body_in_roll", "damper_by_travel", "damper_worn", "friction_by_travel", "propeller_shaft", "spring_cubic",
           "tyre_hysteresis", "tyre_oval", "damper_cavitation", "frequency_selective_damper", "joint_backlash", "orifice_damping",
           "powertrain_roll", "propshaft_imbalance", "rolling_radius_by_load", "side_load_friction", "slab_curl",
           "stroke_dependent_damper", "subframe_resonance", "tank_slosh", "toe_angle",
           "adaptive_damper", "air_spring_volume", "antiroll_bar_slack", "damper_foaming", "link_inertance",
           "loose_cargo", "panhard_jacking", "pulsing_brake_drag", "roll_centre_migration", "sidewall_bottoming", "steering_play",
           "trailer_sway", "tyre_payne", "tyre_sealant", "upper_body_racking", "wet_film", "wheel_wobble",
           "active_body_damping", "broken_coil", "engine_misfire", "force_toe", "hydraulic_bushing", "inertia_valve",
           "machine_hum", "polygonised_tyre", "roof_load", "rough_road_drag", "steering_resonance",
           "tender_spring", "tyre_bridging", "tyre_relaxing_rubber",
           "contact_damping", "inclined_inertia_axis", "rising_rate_linkage", "scanner_skew", "seat_rocking", "self_pumping_strut",
           "side_force_load_lag", "trailing_arm_arc",
           "antiroll_bar_bush_friction", "damper_cold_oil", "oncoming_lorries", "puddle_drag", "rear_axle_steering",
           "toe_link_friction",
           "balance_control_damper", "drag_link_steer", "gyroscopic_steer", "hydraulic_bump_stop", "lateral_runout", "latching_valve",
           "lorry_wake", "soft_ground", "trailer_porpoising",
           "active_roll_bars", "airless_tyre", "bent_arm", "hydraulic_interconnection",
           "ride_control_by_torque", "sticky_steering", "switched_air_chamber", "tie_rod_length", "worn_track_rod_end",
           "antiroll_bar_friction", "diagonal_dampers", "linked_struts",
           "differential_lock", "front_axle_skyhook", "roll_bar_hardening", "stability_control", "torque_vectoring",
           "underbody_suction")  # fmt: skip
"""Truths of which the library has nothing alike."""

SHAPED = {"friction_tanh": "suspension_friction", "friction_elastic": "suspension_friction", "damper_power": "damper_knee",
          "breakaway_friction": "suspension_friction", "bump_steer_by_load": "bump_steer", "tyre_flat_spot": "tyre_runout",
          "one_sided_load": "uneven_load", "bump_stop_creep": "bump_stop", "decoupled_mount": "powertrain_mounts",
          "friction_in_mount": "suspension_friction"}  # fmt: skip
"""Truths of another shape, and what the library has of their kind."""

OF_MEASUREMENT = {"gyroscope_delay": "gyroscope_delay", "imu_lever_arm": "imu_lever_arm", "road_bank": "road_bank",
                  "road_grade": "road_grade", "sensor_bandwidth": "sensor_bandwidth", "sensor_mount": "sensor_mount",
                  "sensor_sway": "sensor_sway", "instrument_on_foam": "sensor_mount", "instrument_post": "sensor_sway"}  # fmt: skip
"""Truths that are errors of an instrument or of the road's file and that alignment does not take out, and what the library has of their kind."""


@dataclass(frozen=True)
class Draw:
    """What a trial is made of. ``right``: the names that a verdict may give; ``missing``: what the library is left without;
    ``spoilt``: further arguments of ``trials.make``; ``settings``: of what only shapes an effect, by its name."""

    hidden: tuple[str, ...]
    kappa: float
    right: frozenset[str]
    missing: tuple[str, ...] = ()
    spoilt: Mapping[str, object] = field(default_factory=dict)
    settings: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    wrong: Mapping[str, float] = field(default_factory=dict)
    """Parameters of the true car, as multiples of what the vehicle's file says."""

    @property
    def there(self) -> frozenset[str]:
        """All names that would not be wrong: ``right`` and what is there in the background."""
        return self.right | frozenset(self.spoilt.get("background", ()))


def of_the_vehicle() -> list[str]:
    """Effects of the library that are none of an instrument or of the road's file."""
    return [name for name, entry in library.find().items() if not candidate(entry.effect).instrument]


def _plain(names: Sequence[str]) -> list[str]:
    return [name for name in names if name not in FAINT]


def _clean(rng, names: Sequence[str], number: int) -> Draw:
    name = names[number % len(names)]
    return Draw((name,), float(rng.choice(KAPPAS)), frozenset({name}))


def _messy(rng, names, number) -> Draw:
    name, *background = (str(one) for one in rng.choice(_plain(names), 3, replace=False))
    spoilt = {
        "background": background, "clock": float(rng.normal(0, 0.005)), "gain": float(rng.normal(0, 0.003)),
        "scanner": 0.0001, "aligned": True,
    }  # fmt: skip
    kappa = float(rng.choice(STRONG))
    spoilt |= {"foot": float(rng.uniform(0.0, 0.3)), "speed_noise": float(rng.uniform(0.0, 0.02))}
    return Draw((name,), kappa, frozenset({name}), spoilt=spoilt)


def _shaped(rng, names, number) -> Draw:
    name = list(SHAPED)[number % len(SHAPED)]
    return Draw((name,), float(rng.choice(STRONG)), frozenset({SHAPED[name]}))


def _set_otherwise(rng, names, number) -> Draw:
    """An effect shaped otherwise than is typical: at another clearance, knee, frequency or place."""
    able = [*_plain(names), "bump_stop"]  # with a smaller clearance more drives meet it
    known = {name: candidate(library.find()[name].effect).shapes for name in able}
    known = {name: shapes for name, shapes in known.items() if any(shape != shapes[0] for shape in shapes)}
    name = list(known)[number % len(known)]
    settings = {}
    for key in known[name][0]:
        tried = [shape[key] for shape in known[name]]
        settings[key.partition(".")[2]] = float(rng.uniform(min(tried), max(tried)))
    return Draw((name,), float(rng.choice(STRONG)), frozenset({name}), settings={name: settings})


def _several(count: int) -> Callable:
    def draw(rng, names, number) -> Draw:
        hidden = tuple(str(name) for name in rng.choice(_plain(names), count, replace=False))
        return Draw(hidden, float(rng.choice(STRONG[1:])), frozenset(hidden))

    return draw


def _outside(rng, names, number) -> Draw:
    """By turns a force that the library never had, and an effect taken out of it."""
    made_up = number % 2 == 0
    name = str(rng.choice(MADE_UP if made_up else _plain(names)))
    return Draw((name,), float(rng.choice(STRONG)), frozenset(), missing=() if made_up else (name,))


def _outside_messy(rng, names, number) -> Draw:
    spoilt = {"clock": float(rng.normal(0, 0.005)), "gain": float(rng.normal(0, 0.003)), "scanner": 0.0001, "aligned": True}
    return Draw((str(rng.choice(MADE_UP)),), float(rng.choice(STRONG)), frozenset(), spoilt=spoilt)


def _outside_beside(rng, names, number) -> Draw:
    """A force that the library never had, and an effect of the library."""
    name = str(rng.choice(_plain(names)))
    return Draw((str(rng.choice(MADE_UP)), name), float(rng.choice(STRONG[1:])), frozenset({name}))


def _wrong_file(rng, names, number) -> Draw:
    """One or two parameters that nothing calibrates are far off; by turns with an effect missing beside them and with none."""
    chosen = rng.choice([name for name in UNCERTAIN if PARAMETERS[name].unit != "m"], int(rng.integers(1, 3)), replace=False)
    wrong = {str(name): float(rng.choice([rng.uniform(0.5, 0.75), rng.uniform(1.4, 2.2)])) for name in chosen}
    hidden = (str(rng.choice(_plain(names))),) if number % 2 == 0 else ()
    return Draw(hidden, float(rng.choice(STRONG)) if hidden else 0.0, frozenset(hidden), wrong=wrong)


def _outside_wrong_file(rng, names, number) -> Draw:
    """A force that the library never had, and one or two parameters that nothing calibrates far off."""
    return Draw((str(rng.choice(MADE_UP)),), float(rng.choice(STRONG[1:])), frozenset(), wrong=_wrong_file(rng, names, 1).wrong)


def _of_measurement(rng, names, number) -> Draw:
    name = list(OF_MEASUREMENT)[number % len(OF_MEASUREMENT)]
    return Draw((name,), float(rng.choice(STRONG[:2])), frozenset({OF_MEASUREMENT[name]}), spoilt={"aligned": True})


def _null(**spoilt) -> Callable:
    return lambda rng, names, number: Draw((), 0.0, frozenset(), spoilt=spoilt)


KINDS: Mapping[str, Callable] = {
    "clean": _clean,
    "messy": _messy,
    "another shape": _shaped,
    "two": _several(2),
    "three": _several(3),
    "outside": _outside,
    "nothing": _null(),
    "path error": _null(path_error=0.06, aligned=True),
    "clock error, aligned": _null(clock=0.008, aligned=True),
    "clock error, left": _null(clock=0.008),
    "gain error": _null(gain=0.03),
    "scanner noise": _null(scanner=0.001),
    "outside, messy": _outside_messy,
    "another interpolation": _null(interpolation="linear"),
    "another setting": _set_otherwise,
    "wrong file": _wrong_file,
    "measurement": _of_measurement,
    "outside, beside the library": _outside_beside,
    "outside, beside a wrong file": _outside_wrong_file,
    "brisk foot": _null(foot=0.2, speed_noise=0.014),
    "brisk foot, clean speed": _null(foot=0.2),
}

SUSPECT = ("clock error, left", "gain error", "scanner noise")
"""Kinds in which the data are wrong and should be called so."""


def draw(kind: str, seed: int, number: int) -> Draw:
    """The trial ``number`` of its kind; effects take turns, the rest is drawn."""
    return KINDS[kind](np.random.default_rng([seed, number, list(KINDS).index(kind)]), of_the_vehicle(), number + STRIDE * seed)
