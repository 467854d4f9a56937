"""The error of the step that the study uses, by halving it."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate

from tests.vehicle.roads import road, rough


@pytest.mark.parametrize("roughness", [16e-6, 128e-6], ids=["class B", "between C and D, wheels lift off"])
def test_vertical_acceleration_is_within_half_a_percent_at_the_studys_step(car, roughness):
    def height(u, v):
        return rough(u, v, roughness=roughness)

    bends = 0.004 * np.sin(np.arange(0, 300.05, 0.1) / 30)
    course = simulate.prepare(road(300.0, height=height, curvature=bends))
    finest = simulate.run(course, car, speed=25.0, step=0.000125)

    def error(step, name):
        drive = simulate.run(course, car, speed=25.0, step=step)
        count = min(drive.time.size, finest.time.size) - 20
        difference = (drive[name].values - finest[name].values)[100:count]
        return np.sqrt(np.mean(difference**2)) / finest[name].values[100:count].std()

    assert simulate.STEP == 0.001
    at_step, at_half = error(0.001, "a_z"), error(0.0005, "a_z")
    assert at_step < 0.005
    assert at_step / at_half > 2.0
    for name in ("a_x", "a_y", "roll_rate", "pitch_rate"):
        assert error(0.001, name) < 0.02, name
