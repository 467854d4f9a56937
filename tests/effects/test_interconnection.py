"""Forces that several struts take part in: which strut is which, by what is the same with it."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate

from tests.vehicle.roads import road, rough

STIFFNESS = 8000.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A user's folder with springs that answer to the deflections of all struts."""
    folder = tmp_path_factory.mktemp("effects")
    (folder / "joined_springs.py").write_text(
        '"""Springs that answer to the deflections of all struts."""\n'
        "from ridecomfort.effects.contract import Effect, Parameter\n\n"
        'effect = Effect("joined_springs", "Springs answer to the deflections of all struts.", "a user", "interconnection",\n'
        '    tuple(Parameter(name, "N/m", 0.0, 1e3, (-1e5, 1e5), "per deflection") for name in ("own", "along", "across", "opposite")))\n\n\n'
        "def act(wheel, deflection, velocity, deflection_along, velocity_along, deflection_across, velocity_across,\n"
        "        deflection_opposite, velocity_opposite, own, along, across, opposite):\n"
        "    return own * deflection + along * deflection_along + across * deflection_across + opposite * deflection_opposite\n"
    )
    return folder


def run(folder, surface, car, **stiffness):
    sizes = dict.fromkeys(("own", "along", "across", "opposite"), 0.0) | stiffness
    return simulate.run(surface, car, speed=15.0, effects={"joined_springs": sizes}, effects_folder=folder)


def largest(one, other):
    """The largest difference of two drives in shares of the range of a signal."""
    return max(float(np.abs(one[key] - other[key]).max() / max(np.ptp(other[key].values), 1e-9)) for key in ("a_z", "pitch_rate"))


def test_springs_against_the_strut_across_are_an_anti_roll_bar(folder, car):
    surface = road(120.0, height=lambda u, v: rough(u, v, seed=4))
    joined = run(folder, surface, car, own=STIFFNESS, across=-STIFFNESS)
    stiffer = {f"anti_roll_stiffness_{axle}": car[f"anti_roll_stiffness_{axle}"] + STIFFNESS * car[f"track_{axle}"] ** 2 for axle in ("front", "rear")}
    with_bar, without = (simulate.run(surface, other, speed=15.0) for other in (car.replace(**stiffer), car))
    away = float(np.abs(with_bar.roll_rate - without.roll_rate).max())
    np.testing.assert_allclose(joined.roll_rate, with_bar.roll_rate, rtol=0, atol=1e-9 * away)


def test_where_both_sides_are_alike_the_diagonal_is_the_other_axle_and_across_the_strut_itself(folder, car):
    surface = road(120.0, height=lambda u, v: 0.01 * np.sin(2 * np.pi * u / 9.0) + 0 * v)
    along, opposite = run(folder, surface, car, along=STIFFNESS), run(folder, surface, car, opposite=STIFFNESS)
    own, across = run(folder, surface, car, own=STIFFNESS), run(folder, surface, car, across=STIFFNESS)
    assert largest(along, opposite) < 1e-9 and largest(own, across) < 1e-9
    assert largest(along, own) > 0.05


def test_where_sides_move_against_one_another_the_diagonal_undoes_what_is_along(folder, car):
    surface = road(120.0, height=lambda u, v: 0.004 * v * np.sin(2 * np.pi * u / 9.0))
    alone, both, along = run(folder, surface, car), run(folder, surface, car, along=STIFFNESS, opposite=STIFFNESS), run(folder, surface, car, along=STIFFNESS)
    away = lambda one: float(np.abs(one.roll_rate - alone.roll_rate).max())
    assert away(both) < 1e-3 * away(along)


def test_springs_that_answer_to_the_other_axle_make_pitch_softer_than_bounce(folder, car):
    """What the sum of front and rear deflections makes beside what springs of as much would make: pitch is left as it was, bounce stiffened."""
    length = lambda u, v: 0.004 * np.sin(2 * np.pi * u / (2.0 * car["wheelbase"])) + 0 * v
    surface = road(120.0, height=length)
    joined, stiff, alone = run(folder, surface, car, own=STIFFNESS, along=STIFFNESS), run(folder, surface, car, own=2 * STIFFNESS), run(folder, surface, car)
    rms = lambda one: float(one.pitch_rate[200:].std())
    assert abs(rms(joined) - rms(alone)) < 0.2 * abs(rms(stiff) - rms(alone))
