"""Effects between body and wheel, against closed forms. Cycles x = X sin(omega t) unless said otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters

from tests.effects.whole import ENTRIES, act
from tests.vehicle.roads import road, rough

STIFFNESS, DAMPING = 30000.0, 2000.0


def force(name, deflection, velocity, *sizes, wheel=0, force_x=0.0):
    """What the effect adds to the force of the strut, and the slopes of its states where it has any."""
    seen = wheel, deflection, velocity, STIFFNESS, DAMPING, force_x, 0.0
    if not ENTRIES[name].effect.also_sees:
        return act(name)(*seen, *sizes)
    _, damper, *slopes = act(name)(*seen, DAMPING * velocity, *sizes)
    return (damper - DAMPING * velocity, *slopes) if slopes else damper - DAMPING * velocity


def dampers(velocity, state, chosen):
    """Force in N of a strut's damper with effects of the library, and the slope of the state of the last, if it has one."""
    damper, slopes = DAMPING * velocity, []
    for entry, sizes in chosen:
        states = [state] * len(entry.effect.states)
        _, damper, *slopes = entry.act(0, 0.0, velocity, STIFFNESS, DAMPING, 0.0, 0.0, damper, *states, *sizes.values())
    return damper, *slopes


def cycle(amplitude, frequency, count=20000):
    """Deflection, velocity and step in s of one cycle."""
    time = np.arange(count) / count / frequency
    turns = 2 * np.pi * frequency
    return amplitude * np.sin(turns * time), amplitude * turns * np.cos(turns * time), 1.0 / count / frequency


def lost(name, amplitude, frequency, *sizes):
    """Energy in J that a cycle takes."""
    x, v, step = cycle(amplitude, frequency)
    return sum(force(name, a, b, *sizes) * b * step for a, b in zip(x, v, strict=True))


def lost_to_friction(amplitude, frequency, presliding):
    """Energy in J that the second of two cycles takes from 120 N of friction."""
    x, v, step = cycle(amplitude, frequency)
    state, energy = 0.0, 0.0
    for number in range(2):
        for deflection, velocity in zip(x, v, strict=True):
            found, slope = force("suspension_friction", deflection, velocity, state, 120.0, 100.0, presliding)
            state += step * slope
            energy += number * step * velocity * found
    return energy


def test_coulomb_friction_loses_four_times_force_times_amplitude():
    assert lost_to_friction(0.02, 2.0, 0.0) == pytest.approx(4 * 120.0 * 0.02, rel=2e-3)


def test_friction_that_gives_before_it_slides_loses_as_much_less_as_it_gives():
    """Dahl's F' = (v - |v| F / F_c) F_c / d over x = X sin(omega t), in closed form: 4 F_c (X - d tanh(X / d))."""
    give, amplitude = 0.002, 0.02
    expected = 4 * 120.0 * (amplitude - give * np.tanh(amplitude / give))
    assert lost_to_friction(amplitude, 1.0, give) == pytest.approx(expected, rel=0.02)


def test_coulomb_friction_does_not_depend_on_speed_once_it_slides():
    assert force("suspension_friction", 0.0, 0.05, 7.0, 120.0, 100.0, 0.0)[0] == 120.0
    assert force("suspension_friction", 0.0, -0.5, 7.0, 120.0, 100.0, 0.0, wheel=3)[0] == -100.0


@pytest.mark.parametrize(("speed", "roughness"), [(3.0, 16e-6), (20.0, 0.8e-6)])
@pytest.mark.parametrize("friction", [300.0, 500.0])
def test_struts_that_stick_hold_light_wheels_alike_in_the_steps_of_a_search_and_in_fine_ones(repository, speed, roughness, friction):
    van = parameters.read(repository / "config" / "vehicles" / "van.yaml")
    ground = road(60.0, height=lambda u, v: rough(u, v, roughness=roughness))
    sizes = {"suspension_friction": {"front": friction, "rear": friction}}
    coarse, fine = (simulate.run(ground, van, speed=speed, effects=sizes, step=step).a_z.values for step in (0.002, 0.0005))
    shared = slice(0, min(coarse.size, fine.size))
    assert np.std(coarse[shared] - fine[shared]) < 0.1 * fine.std()


def test_asymmetric_dampers_keep_their_mean_and_split_it():
    share = 0.4
    bump = DAMPING * 0.1 + force("damper_asymmetry", 0.0, 0.1, share, 0.0)
    rebound = -DAMPING * 0.1 + force("damper_asymmetry", 0.0, -0.1, share, 0.0)
    assert -rebound / bump == pytest.approx((1 + share) / (1 - share))
    assert lost("damper_asymmetry", 0.02, 2.0, share, 0.0) == pytest.approx(0.0, abs=1e-9)


def test_asymmetric_dampers_draw_the_body_down_by_the_mean_of_speed():
    x, v, _ = cycle(0.02, 2.0)
    mean = np.mean([force("damper_asymmetry", a, b, 0.4, 0.0) for a, b in zip(x, v, strict=True)])
    assert mean == pytest.approx(-0.4 * DAMPING * 0.02 * 2 * np.pi * 2.0 * 2 / np.pi, rel=1e-6)


def test_degressive_dampers_have_two_slopes():
    speeds = np.array([-0.5, -0.3, -0.05, 0.05, 0.3, 0.5])
    total = np.array([DAMPING * v + force("damper_knee", 0.0, v, 0.6, 0.0, 0.1) for v in speeds])
    expected = DAMPING * np.sign(speeds) * np.where(np.abs(speeds) < 0.1, np.abs(speeds), 0.1 + 0.4 * (np.abs(speeds) - 0.1))
    assert total == pytest.approx(expected)


def test_degressive_dampers_lose_what_their_curve_says():
    """Against the integral over the angle of the cycle of the speed beyond the knee."""
    peak, knee = 0.02 * 2 * np.pi * 4.0, 0.1
    angle = np.arccos(knee / peak)
    beyond = peak * (angle + np.sin(2 * angle) / 2) - 2 * knee * np.sin(angle)
    expected = -0.6 * DAMPING * 2 * 0.02 * beyond
    assert lost("damper_knee", 0.02, 4.0, 0.6, 0.0, knee) == pytest.approx(expected, rel=1e-4)


def test_progressive_spring_has_the_rate_that_grows_with_compression():
    growth, step = 5.0, 1e-5
    for place in (-0.1, 0.0, 0.06):
        ends = [force("spring_progression", place + side * step, 0.0, growth, 0.0) for side in (-1, 1)]
        rate = STIFFNESS + (ends[1] - ends[0]) / (2 * step)
        assert rate == pytest.approx(STIFFNESS * (1 + growth * place))


def test_progressive_spring_never_pulls_itself_apart():
    deflections = np.linspace(-0.5, 0.2, 1000)
    total = [STIFFNESS * x + force("spring_progression", x, 0.0, 5.0, 0.0) for x in deflections]
    assert np.diff(total).min() > -1e-9
    assert lost("spring_progression", 0.3, 1.0, 5.0, 0.0) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("name", "sign"), [("bump_stop", 1.0), ("rebound_stop", -1.0)])
def test_stops_store_the_energy_of_a_spring_beyond_the_clearance(name, sign):
    stiffness, clearance, end = 80000.0, 0.04, 0.07
    x = np.linspace(0.0, end, 20001)
    energy = np.trapezoid([sign * force(name, sign * a, 0.0, 0.0, stiffness, 0.0, clearance, wheel=2) for a in x], x)
    assert energy == pytest.approx(0.5 * stiffness * (end - clearance) ** 2, rel=1e-5)
    assert force(name, -sign * end, 0.0, 0.0, stiffness, 0.0, clearance, wheel=2) == 0.0


@pytest.mark.parametrize("frequency", [1.0, 12.0, 40.0])
def test_damper_on_a_mount_is_a_maxwell_element(frequency):
    """Complex stiffness i omega c k / (k + i omega c) of damper and mount in series."""
    compliance, step = 4e-6, 2e-5
    turns = 2 * np.pi * frequency
    cycles = int(np.ceil(0.1 * frequency)) + 1
    time = np.arange(0.0, cycles / frequency, step)
    deflection, state, total = np.exp(1j * turns * time), 0.0, np.empty(time.size, complex)
    for k, velocity in enumerate(1j * turns * deflection):
        extra, slope = force("top_mount", 0.0, velocity.real, state, compliance, 0.0)
        total[k] = DAMPING * velocity.real + extra
        state += step * slope
    last = slice(-round(1 / frequency / step), None)
    measured = 2 * np.mean(total[last] * np.exp(-1j * turns * time[last]))
    expected = 1j * turns * DAMPING / (1 + 1j * turns * DAMPING * compliance)
    assert abs(measured - expected) < 0.01 * abs(expected)


@pytest.mark.parametrize("share", [0.3, 0.7])
@pytest.mark.parametrize("lost", [0.3, 0.9])
def test_dampers_that_are_degressive_and_asymmetric_brake_whatever_they_do(share, lost):
    chosen = library.choose({"damper_asymmetry": {"front": share}, "damper_knee": {"front": lost}})
    for velocity in (-2.0, -0.3, -0.05, 0.05, 0.3, 2.0):
        curve = DAMPING * np.sign(velocity) * (min(abs(velocity), 0.1) + (1 - lost) * max(abs(velocity) - 0.1, 0.0))
        assert dampers(velocity, 0.0, chosen)[0] == pytest.approx(curve * (1 - share * np.sign(velocity)))


@pytest.mark.parametrize("compliance", [2e-6, 1e-5])
@pytest.mark.parametrize("lost", [0.6, 0.9])
@pytest.mark.parametrize("knee", [0.03, 0.1, 0.5])
@pytest.mark.parametrize("frequency", [5.0, 12.0, 20.0])
def test_degressive_dampers_on_mounts_take_the_energy_of_damper_and_spring_in_series(compliance, lost, knee, frequency):
    """The spring's force F grows by the motion that the damper, whose speed F tells by its curve, leaves: F' = (v - v_damper(F)) / compliance."""
    chosen = library.choose({"damper_knee": {"front": lost, "knee": knee}, "top_mount": {"front": compliance}})
    step, turns = 1e-4, 2 * np.pi * frequency
    time = np.arange(0.0, 4.0 / frequency, step)
    state, spring, found, expected = 0.0, 0.0, 0.0, 0.0
    for number, velocity in enumerate(0.6 * np.cos(turns * time)):
        force, slope = dampers(velocity, state, chosen)
        state += step * slope
        beyond = max(abs(spring) / DAMPING - knee, 0.0)
        spring += step / compliance * (velocity - np.sign(spring) * (abs(spring) / DAMPING + beyond * (1 / (1 - lost) - 1)))
        if number > time.size / 2:
            found += force * velocity * step
            expected += spring * velocity * step
    assert found == pytest.approx(expected, rel=0.2)


def test_links_take_part_of_the_braking_and_driving_force():
    """The share of the load transfer h F that links at the tangent t take over the wheelbase."""
    assert force("anti_dive", 0.0, 0.0, 0.08, 0.15, force_x=-3000.0) == pytest.approx(240.0)
    assert force("anti_dive", 0.0, 0.0, 0.08, 0.15, force_x=-2000.0, wheel=3) == pytest.approx(-300.0)
    assert force("anti_dive", 0.0, 0.0, 0.08, 0.15, force_x=500.0) == 0.0
    assert force("anti_squat", 0.0, 0.0, 0.05, 0.1, force_x=2000.0, wheel=2) == pytest.approx(200.0)
    assert force("anti_squat", 0.0, 0.0, 0.05, 0.1, force_x=2000.0) == pytest.approx(-100.0)
    assert force("anti_squat", 0.0, 0.0, 0.05, 0.1, force_x=-2000.0, wheel=2) == 0.0
