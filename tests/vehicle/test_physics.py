"""Statics, energy, cornering, steering and traction of the vehicle against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.vehicle import reference
from ridecomfort.vocabulary import STANDARD_GRAVITY as G

from tests.vehicle.roads import road


def watched(car, ground, speed, *, friction=1.0, step=0.002, end=None):
    """What the plain model does at every step of a drive."""
    course = simulate.prepare(ground)
    targets = np.stack([np.full(course.u.size, speed), np.zeros(course.u.size), course.curvature], axis=1)
    seen = []
    end = course.u[-1] - 4.0 if end is None else end
    reference.drive(car, course.surface, course.elevation, targets, friction, 4.0, end, step, 10, watch=seen.append)
    return {name: np.array([moment[name] for moment in seen]) for name in seen[0]}


def test_at_rest_on_level_ground_every_force_is_its_static_value(car):
    drive = watched(car, road(40.0), 10.0)
    total = car["sprung_mass"] + 2 * car["unsprung_mass_front"] + 2 * car["unsprung_mass_rear"]
    rear = car["sprung_mass"] * G * car["cg_to_front_axle"] / car["wheelbase"] / 2
    assert np.abs(drive["acceleration"]).max() < 1e-9
    assert drive["load"].sum(axis=1) == pytest.approx(total * G)
    assert drive["suspension"][-1, 2:] == pytest.approx([rear, rear])


@pytest.mark.parametrize("slope", [0.07, -0.05])
def test_on_a_grade_the_axles_carry_what_moments_demand(car, slope):
    drive = watched(car, road(160.0, height=lambda u, v: slope * u + 0 * v), 10.0)
    height, radius, base = car["cg_height"], car["tyre_radius"], car["wheelbase"]
    moment = car["sprung_mass"] * (car["cg_to_front_axle"] + slope * height)
    moment += 2 * car["unsprung_mass_front"] * slope * radius
    moment += 2 * car["unsprung_mass_rear"] * (base + slope * radius)
    assert drive["load"][-1, 2:].sum() == pytest.approx(moment * G / base, rel=1e-3)
    assert drive["force_x"][-1].sum() == pytest.approx(0.0, abs=20.0)
    assert -drive["pitch"][-1] == pytest.approx(slope, abs=4e-3)


@pytest.mark.parametrize("bank", [0.05, -0.05])
@pytest.mark.parametrize("roll_centres", [(0.0, 0.0), (0.06, 0.10), (0.3, 0.3)])
def test_on_a_bank_the_lower_side_carries_more(car, bank, roll_centres):
    """By the moment about the road of all weights: of the body at its centre of gravity, of the wheels at their own centres."""
    car = car.replace(**dict(zip(("roll_centre_height_front", "roll_centre_height_rear"), roll_centres)))
    drive = watched(car, road(120.0, height=lambda u, v: bank * v + 0 * u), 10.0)
    load = drive["load"][-1]
    moment = (load[0] - load[1] + load[2] - load[3]) * car["track_front"] / 2
    lean = drive["roll"][-1] - bank
    arm = car["cg_height"] - (car["roll_centre_height_front"] + car["roll_centre_height_rear"]) / 2
    expected = -car["sprung_mass"] * G * (car["cg_height"] * bank + arm * lean)
    expected -= 2 * (car["unsprung_mass_front"] + car["unsprung_mass_rear"]) * G * car["tyre_radius"] * bank
    assert moment == pytest.approx(expected, rel=0.005)


@pytest.mark.parametrize("bank", [0.05, -0.05])
@pytest.mark.parametrize("roll_centres", [(0.0, 0.0), (0.06, 0.10)])
def test_on_a_bank_the_body_leans_down_it_by_its_weight_over_the_roll_stiffness(car, bank, roll_centres):
    """Against the road by m g arm (bank + lean) over springs and bars in series with the tyres, and what the links and the wheels' own weight put on the tyres alone."""
    car = car.replace(**dict(zip(("roll_centre_height_front", "roll_centre_height_rear"), roll_centres)))
    drive = watched(car, road(120.0, height=lambda u, v: bank * v + 0 * u), 10.0)
    half = np.array([car["track_front"], car["track_rear"]]) / 2
    springs = 2 * half**2 * [car["spring_stiffness_front"], car["spring_stiffness_rear"]]
    springs += [car["anti_roll_stiffness_front"], car["anti_roll_stiffness_rear"]]
    tyres = 2 * half**2 * car["tyre_radial_stiffness"]
    rear = car["cg_to_front_axle"] / car["wheelbase"]
    weight = car["sprung_mass"] * G * np.array([1 - rear, rear])
    tilting = np.sum(weight * (car["cg_height"] - np.array(roll_centres)))
    stiffness = springs * tyres / (springs + tyres)
    wheels = 2 * G * car["tyre_radius"] * np.array([car["unsprung_mass_front"], car["unsprung_mass_rear"]])
    links = np.sum((weight * roll_centres + wheels) * stiffness / tyres)
    expected = bank * (tilting + links) / (stiffness.sum() - tilting)
    assert drive["roll"][-1] - bank == pytest.approx(expected, rel=0.01)


def undamped(car):
    return car.replace(damping_front=0.0, damping_rear=0.0, tyre_radial_damping=0.0)


def bump(u, v):
    return np.where((u > 10) & (u < 12), 0.01 * np.sin(np.pi * (u - 10) / 2) ** 2, 0.0) + 0 * v


def test_energy_of_the_undamped_car_neither_grows_nor_fades(car):
    free = undamped(car)
    drive = watched(free, road(420.0, height=bump), 20.0, friction=1e-9, step=0.002)
    mass_matrix = reference.Car(free).mass_matrix
    wheels = reference.Car(free)
    q = drive["speeds"].copy()
    q[:, 0] -= q[0, 0]
    kinetic = 0.5 * np.einsum("ti,ij,tj->t", q, mass_matrix, q)
    kinetic += 0.5 * np.sum(wheels.wheel_mass * drive["wheel_v"] ** 2, axis=1)
    stored = 0.5 * np.sum(wheels.spring * drive["travel"] ** 2 + 0.5 * wheels.bar * drive["twist"] ** 2, axis=1)
    stored += 0.5 * wheels.tyre_stiffness * np.sum((drive["deflection"] - wheels.pressed) ** 2, axis=1)
    tilt = np.sum(wheels.held * wheels.arm) * drive["roll"] ** 2
    stored -= 0.5 * (tilt + wheels.held.sum() * wheels.wheel_height * drive["pitch"] ** 2)
    energy = (kinetic + stored)[1000:]
    assert energy.mean() > 1.0
    quarter = len(energy) // 4
    assert energy[-quarter:].mean() == pytest.approx(energy[:quarter].mean(), rel=2e-3)


@pytest.mark.parametrize("radius", [80.0, -150.0])
def test_steady_cornering_is_that_of_the_single_track_model(car, radius):
    """Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge: steering and side slip of the
    linear single-track model; slip stiffness in proportion to load makes it neutral."""
    speed = 9.0
    drive = watched(car, road(160.0, curvature=1.0 / radius), speed)
    front, base = car["cg_to_front_axle"], car["wheelbase"]
    centripetal = speed**2 / radius
    per_load = car["cornering_stiffness"] / car["tyre_reference_load"]
    slip = centripetal / G / per_load
    assert drive["speeds"][-1, 2] == pytest.approx(speed / radius, rel=5e-3)
    assert drive["angle"][-1] == pytest.approx(base / radius, rel=0.03)
    side_slip = drive["speeds"][-1, 1] / drive["speeds"][-1, 0]
    assert side_slip == pytest.approx((base - front) / radius - slip, rel=0.05, abs=2e-4)


@pytest.mark.parametrize("roll_centres", [(0.0, 0.0), (0.06, 0.10), (0.3, 0.3)])
def test_load_transfer_in_a_bend_balances_the_moment_about_the_road(car, roll_centres):
    car = car.replace(**dict(zip(("roll_centre_height_front", "roll_centre_height_rear"), roll_centres)))
    radius, speed = 120.0, 14.0
    drive = watched(car, road(200.0, curvature=1.0 / radius), speed)
    side = drive["acceleration"][-1, 1] + drive["speeds"][-1, 2] * drive["speeds"][-1, 0]
    wheels = reference.Car(car)
    moment = np.sum(wheels.y * drive["load"][-1])
    lean = car["sprung_mass"] * G * np.mean(wheels.arm) * drive["roll"][-1]
    inertia = side * (car["sprung_mass"] * car["cg_height"] + wheels.wheel_mass.sum() * wheels.radius)
    assert -moment == pytest.approx(inertia + lean, rel=0.005)


def test_yaw_answers_to_steering_as_that_of_the_single_track_model(car):
    """Frequency response of the yaw rate to the angle of the front wheels, and of the speed sideways, of a car that hardly rolls
    (Mitschke and Wallentowitz 2014, Dynamik der Kraftfahrzeuge: M (dv/dt + V r) and I dr/dt of the forces at the axles)."""
    upright = {"cg_height": 0.2} | {f"roll_centre_height_{axle}": 0.0 for axle in ("front", "rear")}
    upright |= {f"anti_roll_stiffness_{axle}": 300000.0 for axle in ("front", "rear")}
    speed, frequencies, u = 20.0, (0.5, 1.0), np.arange(0.0, 150.05, 0.1)
    bends = 5e-4 * sum(np.sin(2 * np.pi * frequency / speed * u) for frequency in frequencies)
    drive = watched(car.replace(**upright), road(150.0, curvature=bends), speed)

    place = np.array([car["cg_to_front_axle"], car["cg_to_front_axle"] - car["wheelbase"]])
    wheels = 2 * np.array([car["unsprung_mass_front"], car["unsprung_mass_rear"]])
    half = np.array([car["track_front"], car["track_rear"]]) / 2
    mass, inertia = car["sprung_mass"] + wheels.sum(), car["yaw_inertia"] + np.sum(wheels * (place**2 + half**2))
    load = G * (car["sprung_mass"] * np.abs(place[::-1]) / car["wheelbase"] + wheels)
    stiffness = car["cornering_stiffness"] / car["tyre_reference_load"] * load
    damping = np.array([[stiffness.sum(), stiffness @ place], [stiffness @ place, stiffness @ place**2]]) / speed
    damping[0, 1] += mass * speed

    time = 0.002 * np.arange(len(drive["angle"]))
    waves = [np.exp(2j * np.pi * frequency * time) for frequency in frequencies]
    basis = np.stack([part for wave in waves for part in (wave.real, -wave.imag)] + [np.ones(len(time))], axis=1)
    signals = np.stack([drive["angle"], drive["speeds"][:, 1], drive["speeds"][:, 2]], axis=1)
    parts = np.linalg.lstsq(basis[time > 2.0], signals[time > 2.0], rcond=None)[0]
    for number, frequency in enumerate(frequencies):
        angle, aside, yaw_rate = parts[2 * number] + 1j * parts[2 * number + 1]
        balance = 2j * np.pi * frequency * np.diag([mass, inertia]) + damping
        expected = np.linalg.solve(balance, stiffness[0] * np.array([1.0, place[0]]))
        assert abs(yaw_rate / angle - expected[1]) < 0.02 * abs(expected[1])
        assert abs(aside / angle - expected[0]) < 0.03 * abs(expected[0])


def test_a_brake_stops_a_wheel_and_does_not_turn_it_back(car):
    """Wheels that stand slide with the friction of the road; of what is asked for their brakes do no more than that."""
    ground, friction = road(120.0), 0.3
    speed = np.sqrt(25.0**2 - 2 * 3.0 * np.clip(ground.u.values - 30.0, 0.0, 60.0))
    drive = watched(car, ground, speed, friction=friction)
    assert drive["spin"].min() >= -1e-12
    stands = (np.abs(drive["spin"]) < 1e-12).all(axis=1, where=[True, True, False, False])
    assert stands.sum() > 100
    sliding = drive["force_x"][stands][-1, :2] / drive["load"][stands][-1, :2]
    assert sliding == pytest.approx(-friction * car["tyre_friction"], rel=1e-6)


@pytest.mark.parametrize(("start", "end", "front"), [(10.0, 14.0, "drive_share_front"), (18.0, 10.0, "brake_share_front")])
def test_axles_drive_and_brake_by_their_shares(car, start, end, front):
    """What is asked for beside that goes into the spin of the wheels."""
    ground = road(80.0)
    drive = watched(car, ground, np.linspace(start, end, ground.u.size))
    now = len(drive["force_x"]) // 2
    acceleration, force = drive["acceleration"][now, 0], drive["force_x"][now]
    total = car["sprung_mass"] + 2 * car["unsprung_mass_front"] + 2 * car["unsprung_mass_rear"]
    spinning = 2 * car["wheel_spin_inertia"] / car["tyre_radius"] ** 2 * acceleration
    assert acceleration * (end - start) > 0 and abs(acceleration) > 0.5
    assert force.sum() == pytest.approx(total * acceleration, rel=0.01)
    asked = force.sum() + 2 * spinning
    assert force[:2].sum() + spinning == pytest.approx(car[front] * asked, abs=0.01 * abs(asked))
    assert force[0] == pytest.approx(force[1]) and force[2] == pytest.approx(force[3])
