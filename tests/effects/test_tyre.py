"""Effects of tyre and wheel, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.effects.wave import wave
from ridecomfort.vehicle.ground import Surface

from tests.effects.whole import ENTRIES, act, drive
from tests.vehicle.roads import road, rough

STIFFNESS, REST = 280000.0, 0.0144


def vertical(name, deflection, *sizes, wheel=0, rotation=0.0, spin=0.0):
    return act(name)(wheel, deflection, 0.0, STIFFNESS, REST, rotation, spin, *sizes)


def planar(name, *more, slip_x=0.0, slip_y=0.0, load=4000.0, speed=20.0, slope=0.0, force_x=0.0, wheel=0):
    handed = [0.0] * len(ENTRIES[name].effect.also_sees)
    return act(name)(wheel, slip_x, slip_y, load, speed, slope, force_x, *handed, *more)


@pytest.mark.parametrize("wavelength", [2.0, 0.5, 0.3])
def test_enveloping_weakens_waves_by_the_sinc_of_contact_over_wavelength(wavelength):
    spacing, length = 0.005, 0.12
    u = np.arange(0.0, 6.0, spacing)
    elevation = np.repeat(np.cos(2 * np.pi * u / wavelength)[:, None], 3, axis=1)
    surface = Surface(0.0, 1 / spacing, -1.0, 1.0, False)
    place = wavelength * round(3.0 / wavelength)
    felt = 1.0 + act("tyre_enveloping")(0, place, 0.0, 1.0, 0.0, surface, elevation, length)
    assert felt == pytest.approx(np.sinc(length / wavelength), abs=2e-3)


def test_tyre_that_is_not_round_feels_a_wave_once_a_turn():
    turns = np.linspace(0.0, 2 * np.pi, 200, endpoint=False)
    felt = np.array([act("tyre_runout")(1, 0.0, 0.0, 0.0, turn, None, None, 4e-4, 0.0) for turn in turns])
    harmonics = np.abs(np.fft.rfft(felt)) / 100
    assert harmonics[1] == pytest.approx(4e-4)
    assert np.delete(harmonics, 1).max() < 1e-5 * harmonics[1]


def test_imbalance_is_mass_times_eccentricity_times_spin_squared():
    forces = [vertical("wheel_imbalance", REST, 0.012, 0.0, rotation=turn, spin=80.0)[1] for turn in np.linspace(0, 6.3, 1000)]
    assert max(forces) == pytest.approx(0.012 * 80.0**2, rel=1e-4)
    assert min(forces) == pytest.approx(-0.012 * 80.0**2, rel=1e-4)


def test_imbalance_shakes_the_car_at_the_frequency_of_its_wheels(car):
    seen = drive(road(400.0), car, effects=["wheel_imbalance"], speed=25.0)
    spectrum = np.abs(np.fft.rfft(seen.a_z.values[-1000:] * np.hanning(1000)))
    peak = np.fft.rfftfreq(1000, 0.01)[spectrum.argmax()]
    assert peak == pytest.approx(25.0 / car["tyre_radius"] / (2 * np.pi), abs=0.1)


def test_imbalance_loads_the_tyre_by_what_the_wheel_moves(car):
    """By the rolling resistance, a share of the load. F lifts a wheel between tyre and strut, whose load falls by (k + i w c) F / (k + k_s +
    i w (c + c_s) - m w2); the two wheels are a phase of 2.4 apart."""
    share, imbalance, speed = 0.04, 0.05, 22.0
    resisting, shaken = {"rolling_resistance": {"coefficient": share}}, {"wheel_imbalance": {"front": imbalance, "rear": 0.0}}
    both, shaken, resisting, none = (
        drive(road(300.0), car, effects=effects, speed=speed).a_x.values[-600:-20] for effects in (resisting | shaken, shaken, resisting, {})
    )
    added = (both - resisting) - (shaken - none)
    turns = speed / car["tyre_radius"]
    tyre = car["tyre_radial_stiffness"] + 1j * turns * car["tyre_radial_damping"]
    strut = car["spring_stiffness_front"] + 1j * turns * car["damping_front"]
    force = imbalance * turns**2 * abs(1 + np.exp(2.4j))
    load = force * abs(tyre / (tyre + strut - car["unsprung_mass_front"] * turns**2))
    mass = car["sprung_mass"] + 2 * (car["unsprung_mass_front"] + car["unsprung_mass_rear"])
    wave = np.exp(-1j * turns * 0.01 * np.arange(added.size)) * np.hanning(added.size)
    assert 4 * abs(added @ wave) / added.size == pytest.approx(share * load / mass, rel=0.05)


def test_progressive_tyre_keeps_rest_and_lifts_off_without_force():
    total = lambda x: STIFFNESS * x + vertical("tyre_progression", x, 3.5)
    assert total(REST) == pytest.approx(STIFFNESS * REST)
    assert total(0.0) == 0.0
    rate = (total(0.03 + 1e-6) - total(0.03 - 1e-6)) / 2e-6
    assert rate == pytest.approx(STIFFNESS * (1 + 3.5 * (2 * 0.03 - REST)))


def test_soft_tyre_lets_its_corner_sink(car):
    forces = [vertical("tyre_pressure_loss", REST, 0.3, 0.0, 0.0, 0.0, wheel=wheel) for wheel in range(4)]
    assert forces == pytest.approx([-0.3 * STIFFNESS * REST, 0.0, 0.0, 0.0])
    seen = drive(road(200.0), car, effects=["tyre_pressure_loss"], speed=15.0).isel(time=-1)
    assert seen["roll"] < -1e-4, "the left side is down"
    assert seen["pitch"] > 1e-4, "the nose is down"


def test_cornering_stiffness_over_load_is_a_parabola():
    loads = np.linspace(1000.0, 9000.0, 9)
    slips = np.array([planar("cornering_degression", 0.35, 4000.0, slip_x=0.01, slip_y=0.02, load=load)[:2] for load in loads])
    stiffness = loads * slips[:, 1] / 0.02
    assert stiffness == pytest.approx(loads * (1 - 0.35 * (loads / 4000.0 - 1)))
    assert (slips[:, 0] == 0.01).all()


@pytest.mark.parametrize("speed", [5.0, 30.0])
def test_slip_builds_up_over_the_relaxation_length_at_any_speed(speed):
    length, step, travelled, state = 0.5, 1e-5, 0.0, (0.0, 0.0)
    slips = planar("tyre_relaxation", *state, 0.3, length, slip_y=0.04, speed=speed)
    while travelled < length:
        slips = planar("tyre_relaxation", *state, 0.3, length, slip_y=0.04, speed=speed)
        state = state[0] + step * slips[3], state[1] + step * slips[4]
        travelled += speed * step
    assert state[1] == pytest.approx(0.04 * (1 - np.exp(-1)), rel=2e-3)
    assert slips[0] == slips[2] == 0.0


@pytest.mark.parametrize("speed", [5.0, 30.0, -5.0])
def test_rolling_radius_shrinks_by_its_share_of_the_load(speed):
    """A wheel that turns as fast as that radius asks for has no slip."""
    share, load, radius = 4e-6, 6000.0, 0.32
    smaller = radius * (1 - share * (load - 4000.0))
    slip = (speed / smaller * radius - speed) / abs(speed)
    slip_x, slip_y, pull = planar("tyre_rolling_radius", share, slip_x=slip, slip_y=0.02, load=load, speed=speed)
    assert slip_x == pytest.approx(0.0, abs=1e-4)
    assert (slip_y, pull) == (0.02, 0.0)
    assert planar("tyre_rolling_radius", share, load=load, speed=0.0)[0] == 0.0


def test_rolling_radius_that_goes_by_the_load_jolts_the_car_with_the_inertia_of_its_wheels(car):
    """On waves of the wheelbase all loads swing alike: a_x is -J v / (R^2 m) times the radius lost per load times the rate of all loads, which
    carry the body as it heaves and the axles, which follow the road."""
    share, speed, height = 2e-5, 4.0, 0.005
    turns = 2 * np.pi / car["wheelbase"]
    ground = road(200.0, height=lambda u, v: height * np.sin(turns * u) + 0 * v)
    effects = {"tyre_rolling_radius": {"per_load": share}}
    there, without = (drive(ground, car, effects=own, speed=speed).isel(time=slice(-1000, None)) for own in (effects, []))
    unsprung = 2 * (car["unsprung_mass_front"] + car["unsprung_mass_rear"])
    axles = -height * (turns * speed) ** 2 * np.sin(turns * (without.s.values + car["cg_to_front_axle"]))
    loads = car["sprung_mass"] * without.a_z.values + unsprung * axles
    per_rate = car["wheel_spin_inertia"] * speed / (car["tyre_radius"] ** 2 * (car["sprung_mass"] + unsprung))
    foreseen = -per_rate * share * np.gradient(loads, 0.01)
    added = (there.a_x - without.a_x).values
    wave = np.exp(-1j * turns * without.s.values) * np.hanning(added.size)
    assert (added @ wave) / (foreseen @ wave) == pytest.approx(1.0, abs=0.1)


def test_rolling_resistance_is_a_share_of_the_load_against_the_motion():
    assert planar("rolling_resistance", 0.012)[2] == pytest.approx(-48.0)
    assert planar("rolling_resistance", 0.012, speed=-20.0)[2] == pytest.approx(48.0)
    assert planar("rolling_resistance", 0.012, speed=0.0)[2] == 0.0


def test_rolling_resistance_slows_the_car_by_its_share_of_gravity(car):
    ground = road(100.0)
    slowed, free = (drive(ground, car, effects=effects, speed=20.0) for effects in ({"rolling_resistance": {"coefficient": 0.012}}, []))
    lost = (slowed.v_x - free.v_x).sel(time=0.2, method="nearest").item()
    assert lost == pytest.approx(-0.012 * 9.81 * 0.2, rel=0.12)


def test_local_slope_pushes_back_with_its_part_of_the_load(car):
    """On waves of the wheelbase all wheels climb at once and the plane under them stays level."""
    assert planar("tyre_local_slope", 1.0, slope=0.03)[2] == pytest.approx(-120.0)
    wavelength, height, speed = car["wheelbase"], 0.002, 5.0
    ground = road(120.0, height=lambda u, v: height * np.sin(2 * np.pi * u / wavelength) + 0 * v)
    there, without = (drive(ground, car, effects=effects, speed=speed) for effects in (["tyre_local_slope"], []))
    added = (there.a_x - without.a_x).values[-1000:]
    steepest = height * 2 * np.pi / wavelength
    assert np.sqrt(2) * added.std() == pytest.approx(9.81 * steepest, rel=0.15)


@pytest.mark.parametrize("frequency", [2.0, 15.0, 40.0])
def test_wheel_on_bushings_passes_on_the_force_of_a_spring_and_a_mass(frequency):
    """Force on the body over that of the tyre: (k + i w c) / (k + i w c - m w2)."""
    compliance, mass, ratio, step = 2e-6, 45.0, 0.1, 1e-5
    turns = 2 * np.pi * frequency
    time = np.arange(0.0, round(2.0 * frequency) / frequency, step)
    place, rate, passed = 0.0, 0.0, np.empty(time.size)
    for k, tyre in enumerate(np.cos(turns * time)):
        _, _, pull, speed, acceleration = planar("wheel_compliance", place, rate, compliance, 0.0, mass, ratio, force_x=tyre)
        passed[k] = tyre + pull
        rate += step * acceleration
        place += step * rate
    last = slice(-round(1 / frequency / step), None)
    measured = 2 * np.mean(passed[last] * np.exp(-1j * turns * time[last]))
    held = 1 / compliance + 1j * turns * 2 * ratio * np.sqrt(mass / compliance)
    assert abs(measured - held / (held - mass * turns**2)) < 0.02 * abs(measured)


@pytest.mark.parametrize("mass", [45.0, 120.0])
@pytest.mark.parametrize("cause", [{"tyre_rolling_radius": {"per_load": 2e-5}}, {"tyre_local_slope": {"share": 1.0}}])
def test_wheels_on_bushings_move_against_the_body_that_they_shake(car, mass, cause):
    """On waves of half the wheelbase, on which all wheels are pushed alike. With V of the body, v of a wheel against it, a tyre that holds
    back by Z (V + v) and bushings by K v, s = i w: (M s + 4 Z) V + 4 (Z + m s) v = 4 f and (Z + m s) V + (m s + K + Z) v = f."""
    compliance, ratio, frequency = 2e-6, 0.1, 12.0
    car = car.replace(pitch_inertia=40000.0)
    wavelength = car["wheelbase"] / 2
    ground = road(150.0, 0.02, height=lambda u, v: 5e-4 * np.sin(2 * np.pi * u / wavelength) + 0 * v)
    bushings = {"wheel_compliance": {"front": compliance, "rear": compliance, "mass": mass, "damping_ratio": ratio}}
    place = 0.0, 0.0, car["tyre_radius"] - car["cg_height"]

    def shaken(effects):
        seen = drive(ground, car, effects=effects, speed=frequency * wavelength, step=0.0005, sensor=place)
        seen = seen.isel(time=(seen.s > 60.0) & (seen.s < 60.0 + 60 * wavelength))
        return np.mean((seen.a_x - seen.a_x.mean()).values * np.exp(-2j * np.pi * seen.s.values / wavelength))

    s = 2j * np.pi * frequency
    total = car["sprung_mass"] + 2 * (car["unsprung_mass_front"] + car["unsprung_mass_rear"])
    slip = car["longitudinal_slip_stiffness"] / car["tyre_reference_load"] * total * 9.81 / 4
    tyre = slip / (frequency * wavelength + slip * car["tyre_radius"] ** 2 / (s * car["wheel_spin_inertia"]))
    bushing = 2 * ratio * np.sqrt(mass / compliance) + 1 / compliance / s
    matrix = [[total * s + 4 * tyre, 4 * (tyre + mass * s)], [tyre + mass * s, mass * s + bushing + tyre]]
    expected = np.linalg.solve(matrix, [4.0, 1.0])[0] * (total * s + 4 * tyre) / 4
    found = shaken(cause | bushings) - shaken(bushings)
    assert abs(found / (shaken(cause) - shaken({})) - expected) < 0.1 * abs(expected)


@pytest.mark.parametrize("speed", [3.0, 5.0, 15.0])
@pytest.mark.parametrize("sizes", [{}, {"front": 6e-6, "rear": 6e-6, "mass": 15.0}, {"front": 5e-7, "rear": 5e-7}])
def test_a_wheel_on_bushings_is_integrated_at_any_speed_in_the_steps_of_a_search(car, speed, sizes):
    """The slip of a slow wheel damps it the more the slower it is: unless its mass is taken for larger, a_x was 8 m/s2 off at 4 m/s."""
    surface = road(60.0, height=rough)
    coarse, fine = (drive(surface, car, effects={"wheel_compliance": sizes}, speed=speed, step=step) for step in (0.002, 0.0005))
    off = np.std(coarse.a_x.values[:-5] - np.interp(coarse.s.values[:-5], fine.s, fine.a_x))
    assert off < 0.25 * float(fine.a_x.std())


@pytest.mark.parametrize("mass", [30.0, 45.0, 120.0])
@pytest.mark.parametrize("ratio", [0.1, 0.4])
@pytest.mark.parametrize("speed", [10.0, 15.0, 25.0])
def test_wheels_on_bushings_of_any_stiffness_do_in_the_steps_of_a_search_what_they_do_in_fine_ones(car, mass, ratio, speed):
    surface, steps = road(100.0, height=rough), (0.002, 0.0005)
    base = {step: drive(surface, car, speed=speed, step=step).a_x for step in steps}
    for swing in (400.0, 300.0, 250.0, 210.0, 180.0, 150.0, 120.0):
        compliance = 1.0 / (mass * swing**2)
        sizes = {"front": compliance, "rear": compliance, "mass": mass, "damping_ratio": ratio}
        coarse, fine = (
            (drive(surface, car, effects={"wheel_compliance": sizes}, speed=speed, step=step).a_x - base[step]).values[100:].std() for step in steps
        )
        assert coarse == pytest.approx(fine, rel=0.2), swing


def test_tiny_compliance_does_in_proportion_to_itself():
    small, smaller = (planar("wheel_compliance", 1e-5, 0.1, c, 0.0, 45.0, 0.1, force_x=100.0) for c in (2e-8, 1e-8))
    assert small[2] == pytest.approx(2 * smaller[2])
    assert small[0] == pytest.approx(2 * smaller[0])


def test_fast_sine_is_a_sine():
    angles = np.linspace(-1000.0, 1000.0, 20011)
    assert [wave(angle) for angle in angles] == pytest.approx(np.sin(angles), abs=4e-6)
