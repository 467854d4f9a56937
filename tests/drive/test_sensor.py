"""A sensor stays where it was measured at the car, whatever the vehicle is calibrated to."""

from __future__ import annotations

import pytest

from ridecomfort.drive import sensor
from ridecomfort.vehicle import parameters

PLACE = {"behind_front_axle": 1.2, "above_wheel_centres": 0.9, "left": 0.1}


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.mark.parametrize(
    "changed", [{"cg_to_front_axle": 1.5}, {"cg_height": 0.6}, {"tyre_radial_stiffness": 250e3}, {"sprung_mass": 1700.0, "cg_height": 0.55}]
)
def test_what_lies_elsewhere_is_the_difference_of_its_places(car, changed):
    other = car.replace(**changed)
    forward, up = sensor.displacement({name: car[name] for name in sensor.TOLD_OF}, other)
    (x, _, z), (x_other, _, z_other) = sensor.sensor_place(car, **PLACE), sensor.sensor_place(other, **PLACE)
    assert (forward, up) == pytest.approx((x_other - x, z_other - z), abs=1e-12)


def test_a_softer_tyre_lets_the_car_down_by_its_load(car):
    """A quarter of the weight over the stiffness."""
    told_of = {name: car[name] for name in sensor.TOLD_OF}
    load = 9.80665 * (car["sprung_mass"] + 2 * car["unsprung_mass_front"] + 2 * car["unsprung_mass_rear"]) / 4
    down = load / 250e3 - load / car["tyre_radial_stiffness"]
    assert sensor.displacement(told_of, car.replace(tyre_radial_stiffness=250e3)) == pytest.approx((0.0, -down))


def test_a_drive_that_is_told_of_no_vehicle_or_of_this_one_keeps_its_place(car):
    other = car.replace(cg_height=0.7, cg_to_front_axle=1.1)
    assert sensor.displacement({}, other) == (0.0, 0.0)
    assert sensor.displacement({name: other[name] for name in sensor.TOLD_OF}, other) == (0.0, 0.0)
    assert sensor.displacement({"cg_height": 0.5}, other) == pytest.approx((0.0, -0.2))
