"""Natural frequencies and frequency response against an independent linear half-car, and of roll against a closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from ridecomfort import simulate

from tests.vehicle.roads import road


def half_car(car):
    """Mass, damping and stiffness of heave, pitch and the two axles, and how the road drives them.

    Written from the textbook (Mitschke and Wallentowitz 2014), not from the library: the car
    slides on ice, so its speed is free and the wheels' inertia joins that of pitching.
    """
    a, b = car["cg_to_front_axle"], car["wheelbase"] - car["cg_to_front_axle"]
    wheels = 2 * np.array([car["unsprung_mass_front"], car["unsprung_mass_rear"]])
    springs = 2 * np.array([car["spring_stiffness_front"], car["spring_stiffness_rear"]])
    dampers = 2 * np.array([car["damping_front"], car["damping_rear"]])
    tyre, tyre_damping = 2 * car["tyre_radial_stiffness"], 2 * car["tyre_radial_damping"]
    total, arm = car["sprung_mass"] + wheels.sum(), car["cg_height"] - car["tyre_radius"]
    pitch = car["pitch_inertia"] + wheels.sum() * arm**2 - (wheels.sum() * arm) ** 2 / total
    mass = np.diag([car["sprung_mass"], pitch, *wheels])

    def suspension(rates):
        matrix = np.zeros((4, 4))
        for axle, (x, rate) in enumerate(zip((a, -b), rates, strict=True)):
            stretch = np.array([-1.0, x, 0.0, 0.0])
            stretch[2 + axle] = 1.0
            matrix += rate * np.outer(stretch, stretch)
        return matrix

    stiffness = suspension(springs) + np.diag([0, -car["sprung_mass"] * 9.80665 * arm, tyre, tyre])
    damping = suspension(dampers) + np.diag([0, 0, tyre_damping, tyre_damping])
    return mass, damping, stiffness, (tyre, tyre_damping), (a, -b)


def response(car, frequency, speed):
    """Acceleration up and pitch rate for road waves of 1 m amplitude under the centre of gravity."""
    mass, damping, stiffness, (tyre, tyre_damping), places = half_car(car)
    s = 2j * np.pi * frequency
    heights = np.exp(s * np.array(places) / speed)
    push = np.concatenate([[0, 0], (tyre + s * tyre_damping) * heights])
    # The level part of the load on the slope under the car pushes at the height of the wheel centres.
    arm = car["cg_height"] - car["tyre_radius"]
    push[1] = car["sprung_mass"] * 9.80665 * arm * (heights[0] - heights[1]) / (places[0] - places[1])
    heave, pitch, *_ = np.linalg.solve(s**2 * mass + s * damping + stiffness, push)
    return s**2 * heave, s * pitch


@pytest.mark.parametrize("frequency", [0.8, 1.4, 3.0, 8.0, 12.0, 20.0])
def test_frequency_response_is_that_of_the_linear_model(car, frequency):
    speed, amplitude = 20.0, 0.0005
    wave = 2 * np.pi * frequency / speed
    ground = road(320.0, 0.02, height=lambda u, v: amplitude * np.sin(wave * u) + 0 * v)
    drive = simulate.run(ground, car, speed=speed, friction=1e-9).isel(time=slice(400, -50))
    phase = np.exp(1j * wave * drive.s.values)
    basis = np.stack([phase.real, phase.imag, np.ones(phase.size)], axis=1)
    for name, expected in zip(("a_z", "pitch_rate"), response(car, frequency, speed), strict=True):
        cosine, sine, _ = np.linalg.lstsq(basis, drive[name].values, rcond=None)[0]
        found = (sine + 1j * cosine) / amplitude
        assert abs(found - expected) / abs(expected) < 0.01, name


def test_undamped_natural_frequencies_are_the_eigenvalues(car):
    free = car.replace(damping_front=0.0, damping_rear=0.0, tyre_radial_damping=0.0)
    mass, _, stiffness, *_ = half_car(free)
    expected = np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2 * np.pi)

    def step(u, v):
        return np.where(u > 10, 0.002, 0.0) + 0 * v

    drive = simulate.run(road(2600.0, height=step), free, speed=25.0, friction=1e-9).isel(time=slice(200, None))
    window = np.hanning(drive.time.size)
    frequencies = np.fft.rfftfreq(16 * drive.time.size, 0.01)
    power = sum(
        np.abs(np.fft.rfft(drive[name].values * window, 16 * drive.time.size)) ** 2
        for name in ("a_z", "pitch_rate")
    )
    for natural in expected:
        near = np.abs(frequencies - natural) < 0.02 * natural
        peak = frequencies[near][np.argmax(power[near])]
        assert peak == pytest.approx(natural, rel=0.006)


def test_undamped_roll_has_the_frequency_of_the_body_on_springs_bars_and_tyres(car):
    """Springs and bars in series with the tyres, less what the weight of the leaning body takes off. On ice the body rolls about its own centre;
    the wheels are so light that what they take part is a third of a percent."""
    free = car.replace(damping_front=0.0, damping_rear=0.0, tyre_radial_damping=0.0, unsprung_mass_front=6.0, unsprung_mass_rear=6.0)
    half = np.array([car["track_front"], car["track_rear"]]) / 2
    springs = 2 * half**2 * [car["spring_stiffness_front"], car["spring_stiffness_rear"]]
    springs += [car["anti_roll_stiffness_front"], car["anti_roll_stiffness_rear"]]
    tyres = 2 * half**2 * car["tyre_radial_stiffness"]
    rear = car["cg_to_front_axle"] / car["wheelbase"]
    arms = car["cg_height"] - np.array([car["roll_centre_height_front"], car["roll_centre_height_rear"]])
    weight = car["sprung_mass"] * 9.80665 * np.array([1 - rear, rear])
    stiffness = np.sum(springs * tyres / (springs + tyres) - weight * arms)

    def one_side_up(u, v):
        return np.where((u > 10) & (u < 12), 0.01 * np.sin(np.pi * (u - 10) / 2) ** 2, 0.0) * v

    drive = simulate.run(road(620.0, height=one_side_up), free, speed=20.0, friction=1e-9).isel(time=slice(200, None))
    frequencies = np.fft.rfftfreq(16 * drive.time.size, 0.01)
    amplitude = np.abs(np.fft.rfft(drive["roll_rate"].values * np.hanning(drive.time.size), 16 * drive.time.size))
    found = frequencies[np.argmax(np.where(frequencies < 5.0, amplitude, 0.0))]
    assert found == pytest.approx(np.sqrt(stiffness / car["roll_inertia"]) / (2 * np.pi), rel=0.01)
