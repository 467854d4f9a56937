"""Effects of and on the body, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.vehicle.motion import BodyMotion
from ridecomfort.vocabulary import STANDARD_GRAVITY as G

from tests.effects.whole import act, drive
from tests.vehicle.roads import road

AT_REST = BodyMotion(**dict.fromkeys(BodyMotion._fields, 0.0))._replace(sprung_mass=1440.0, front=1.4, rear=-1.4)


def test_payload_obeys_the_parallel_axis_theorem(car):
    """Against the same car and its load as a cloud of point masses."""
    mass, ahead, height, radius = 300.0, -1.2, 0.9, 0.4
    loaded = act("payload")(car, mass, ahead, height, radius)
    inertias = np.array([car[f"{axis}_inertia"] for axis in ("roll", "pitch", "yaw")])
    weights, points = [], []
    for weight, centre, own in (
        (car["sprung_mass"], (0.0, 0.0, car["cg_height"]), inertias),
        (mass, (ahead, 0.0, height), np.full(3, mass * radius**2)),
    ):
        half = np.sqrt(np.maximum((own.sum() / 2 - own) * 3 / weight, 0.0))
        for axis in range(3):
            for side in (-1.0, 1.0):
                point = np.array(centre)
                point[axis] += side * half[axis]
                weights.append(weight / 6)
                points.append(point)
    weights, points = np.array(weights), np.array(points)
    centre = weights @ points / weights.sum()
    squares = weights @ (points - centre) ** 2
    assert loaded["sprung_mass"] == pytest.approx(weights.sum())
    assert loaded["cg_height"] == pytest.approx(centre[2])
    assert loaded["cg_to_front_axle"] == pytest.approx(car["cg_to_front_axle"] - centre[0])
    expected = squares.sum() - squares
    assert [loaded[f"{axis}_inertia"] for axis in ("roll", "pitch", "yaw")] == pytest.approx(expected)


def test_payload_of_a_car_of_point_mass_axes_is_representable(car):
    """The cloud of the test above exists: no inertia is larger than the other two together."""
    inertias = sorted(car[f"{axis}_inertia"] for axis in ("roll", "pitch", "yaw"))
    assert inertias[2] < inertias[0] + inertias[1]


def test_heights_move_by_what_they_are_told(car):
    assert act("mass_height")(car, 0.05)["cg_height"] == pytest.approx(car["cg_height"] + 0.05)
    moved = act("roll_centre_height")(car, 0.04, -0.02)
    assert moved["roll_centre_height_front"] == pytest.approx(car["roll_centre_height_front"] + 0.04)
    assert moved["roll_centre_height_rear"] == pytest.approx(car["roll_centre_height_rear"] - 0.02)


@pytest.mark.parametrize("frequency", [2.0, 9.0, 25.0])
def test_engine_on_mounts_is_a_mass_on_a_spring_under_a_moving_foot(frequency):
    """What it adds to its own rigid inertia: force -m (T - 1) a, T the transmissibility of its mounts."""
    mass, natural, ratio, step = 180.0, 10.0, 0.15, 2e-5
    turns = 2 * np.pi * frequency
    time = np.arange(0.0, round(2.0 * frequency) / frequency, step)
    lift, rate, forces = 0.0, 0.0, np.empty(time.size)
    for k, foot in enumerate(np.cos(turns * time)):
        motion = AT_REST._replace(vertical_acceleration=foot)
        _, _, forces[k], _, pitch, _, lift_rate, acceleration = act("powertrain_mounts")(
            motion, lift, rate, mass, 1.1, natural, ratio
        )
        assert pitch == pytest.approx(-1.1 * forces[k])
        rate += step * acceleration
        lift += step * rate
    last = slice(-round(1 / frequency / step), None)
    measured = 2 * np.mean(forces[last] * np.exp(-1j * turns * time[last]))
    r = frequency / natural
    transmissibility = (1 + 2j * ratio * r) / (1 - r**2 + 2j * ratio * r)
    assert abs(measured + mass * (transmissibility - 1)) < 0.02 * abs(measured)


def test_bending_rings_at_its_frequency_and_dies_with_its_damping():
    natural, ratio, step = 24.0, 0.04, 1e-5
    bend, rate, seen = 0.0, 1.0, []
    weight = AT_REST._replace(suspension_front=1440.0 * G / 2, suspension_rear=1440.0 * G / 2)
    for _ in range(50000):
        *_, felt, slope, acceleration = act("body_bending")(weight, 0.0, 0.0, 0.0, bend, rate, 1.5, natural, ratio, 1.15)
        seen.append(felt)
        rate += step * acceleration
        bend += step * rate
    seen = np.array(seen)
    crossings = np.flatnonzero((seen[:-1] < 0) & (seen[1:] >= 0))
    period = np.diff(crossings).mean() * step
    assert 1 / period == pytest.approx(natural * np.sqrt(1 - ratio**2), rel=1e-3)
    peaks = [seen[a:b].max() for a, b in zip(crossings[:-1], crossings[1:], strict=True)]
    decrement = np.log(np.array(peaks[:-1]) / peaks[1:]).mean()
    assert decrement == pytest.approx(2 * np.pi * ratio / np.sqrt(1 - ratio**2), rel=1e-3)


def test_bending_is_not_felt_at_a_node_nor_driven_at_one():
    pushed = AT_REST._replace(suspension_front=1440.0 * G / 2 + 1000.0, suspension_rear=1440.0 * G / 2)
    at = lambda x, node: act("body_bending")(pushed, x, 0.0, 0.0, 0.0, 0.0, 1.5, 24.0, 0.04, node)[2]
    assert at(0.0, 1.15) == pytest.approx(1.5 * 1000.0 / 1440.0 * (1 - (1.4 / 1.15) ** 2))
    assert at(1.15, 1.15) == pytest.approx(0.0, abs=1e-12)
    assert at(0.0, 1.4) == pytest.approx(0.0, abs=1e-12)


def test_drag_slows_the_car_as_its_closed_form_says(car):
    area, speed = 0.66, 30.0
    force, *_, pitch, _ = act("aerodynamic_drag")(AT_REST._replace(speed=speed), area, 0.1)
    assert force == pytest.approx(-0.5 * 1.2 * area * speed**2)
    assert pitch == pytest.approx(0.1 * force)
    there, free = (drive(road(100.0), car, effects=e, speed=speed) for e in ({"aerodynamic_drag": {"area": area}}, []))
    lost = (there.v_x - free.v_x).sel(time=0.2, method="nearest").item()
    mass = car["sprung_mass"] + 2 * (car["unsprung_mass_front"] + car["unsprung_mass_rear"])
    mass += 4 * car["wheel_spin_inertia"] / car["tyre_radius"] ** 2
    assert lost == pytest.approx(0.2 * force / mass, rel=0.12)


def test_lift_acts_at_the_axles():
    _, _, up, _, pitch, _ = act("aerodynamic_lift")(AT_REST._replace(speed=30.0), 0.15, 0.2)
    assert up == pytest.approx(540.0 * 0.35)
    assert pitch == pytest.approx(-540.0 * (0.15 * 1.4 - 0.2 * 1.4))


def test_wind_pushes_with_its_part_of_the_pressure():
    """With the wind nearly across: half the density, area, wind times the speed of the air."""
    _, side, _, _, _, yaw = act("crosswind")(AT_REST._replace(speed=30.0, s=15.0), 5.0, 4.0, 60.0, 5.0, 0.5)
    assert side == pytest.approx(0.6 * 5.0 * 9.0 * np.hypot(30.0, 9.0))
    assert yaw == pytest.approx(0.5 * side)


@pytest.mark.parametrize(("name", "sizes", "height"), [
    ("road_grade", {"grade": 0.03}, lambda u, v: 0.03 * u + 0 * v),
    ("road_bank", {"bank": 0.02}, lambda u, v: 0.02 * v + 0 * u),
])  # fmt: skip
def test_missing_grade_and_bank_are_as_if_the_road_had_them(car, name, sizes, height):
    late = {"time": slice(2000, 2400)}
    added = drive(road(400.0), car, effects={name: sizes}, speed=15.0).isel(late)
    real = drive(road(400.0, height=height), car, speed=15.0).isel(late)
    for key, limit in (("a_x", 1e-3), ("a_y", 1e-3), ("roll", 1e-5), ("pitch", 1e-4)):
        assert np.abs(added[key] - real[key]).max() < limit


def test_uneven_load_is_a_mass_beside_the_middle_of_a_body_that_bounces_and_rolls():
    """The forces that a point mass needs beyond those that it needs in the middle, turned round; its own inertia is that of the file."""
    mass, aside, bounce, roll = 75.0, 0.35, 1.3, 0.7
    there = mass * np.array([bounce + aside * roll + G, aside * (bounce + G)])
    middle = mass * np.array([bounce + G, 0.0])
    motion = AT_REST._replace(vertical_acceleration=bounce, roll_acceleration=roll)
    _, _, lift, lean, *_ = act("uneven_load")(motion, mass * aside)
    assert [lift, lean] == pytest.approx(list(middle - there))


def test_a_driver_alone_leans_the_car_by_its_weight_over_its_roll_stiffness(car):
    shift = 75.0 * 0.35
    lean = drive(road(300.0), car, effects={"uneven_load": {"shift": shift}}, speed=15.0)["roll"].values[-1]
    stiffness = 0.0
    for axle in ("front", "rear"):
        half = car[f"track_{axle}"] ** 2 / 2
        strut, tyre = half * car[f"spring_stiffness_{axle}"] + car[f"anti_roll_stiffness_{axle}"], half * car["tyre_radial_stiffness"]
        stiffness += strut * tyre / (strut + tyre)
    stiffness -= car["sprung_mass"] * G * (car["cg_height"] - (car["roll_centre_height_front"] + car["roll_centre_height_rear"]) / 2)
    assert lean == pytest.approx(-shift * G / stiffness, rel=0.05)
