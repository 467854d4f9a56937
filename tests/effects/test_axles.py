"""A size that an effect has for an axle, or for a wheel, acts there and nowhere else."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

from ridecomfort.effects import library
from ridecomfort.effects.contract import PORTS

WHEELS = {
    "front": [0, 1], "rear": [2, 3], "front_left": [0], "front_right": [1], "rear_left": [2], "rear_right": [3],
}  # fmt: skip

SIZES = [
    (name, size.name)
    for name, entry in library.find().items()
    if PORTS[entry.effect.port].per_wheel
    for size in entry.effect.parameters
    if size.name in WHEELS
]

SCALES = {"deflection": 0.1, "velocity": 0.5, "slip_x": 0.05, "slip_y": 0.05, "slope": 0.05, "force_x": 2e3, "force_y": 2e3, "spin": 60.0}
"""How large what a port sees may be, 1 where nothing is said: beyond the clearance of every stop."""

POSITIVE = {"stiffness": 3e4, "damping": 2e3, "load": 4e3, "speed": 20.0, "rest": 0.014}


def answers(name, sizes):
    """What an effect with these sizes, and none beside them, returns at each wheel, (wheel, answer), for the same ten moments."""
    act, effect, rng = library.find()[name].act, library.find()[name].effect, np.random.default_rng(1)
    own = {parameter.name: parameter.neutral for parameter in effect.parameters} | sizes
    taken = [argument for argument in inspect.signature(act).parameters if argument != "wheel" and argument not in own]
    moments = [{argument: SCALES.get(argument, 1.0) * rng.normal() for argument in taken} for _ in range(10)]
    moments = [own | moment | {argument: POSITIVE[argument] for argument in taken if argument in POSITIVE} for moment in moments]
    return np.array([[act(wheel=wheel, **moment) for moment in moments] for wheel in range(4)]).reshape(4, -1)


def test_there_are_such_effects_at_every_port_that_knows_an_axle():
    ports = {library.find()[name].effect.port for name, _ in SIZES}
    assert ports == {"road", "kinematics", "suspension", "tyre_vertical", "tyre_planar"} and len(SIZES) > 25


@pytest.mark.parametrize(("name", "size"), SIZES)
def test_a_size_acts_at_the_wheels_that_it_is_named_after(name, size):
    high = next(parameter.plausible[1] for parameter in library.find()[name].effect.parameters if parameter.name == size)
    changed = (answers(name, {size: 0.5 * high}) != answers(name, {})).any(axis=1)
    assert list(np.flatnonzero(changed)) == WHEELS[size]
