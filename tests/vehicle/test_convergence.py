"""The error of the step that the study uses, by halving it."""

from __future__ import annotations

import numpy as np

from ridecomfort import simulate

from tests.vehicle.roads import road, rough


def test_vertical_acceleration_is_within_half_a_percent_at_the_studys_step(car):
    course = simulate.prepare(
        road(300.0, height=rough, curvature=0.004 * np.sin(np.arange(0, 300.05, 0.1) / 30))
    )
    finest = simulate.run(course, car, speed=25.0, step=0.000125)

    def error(step, name):
        drive = simulate.run(course, car, speed=25.0, step=step)
        count = min(drive.time.size, finest.time.size) - 20
        difference = (drive[name].values - finest[name].values)[100:count]
        return np.sqrt(np.mean(difference**2)) / finest[name].values[100:count].std()

    assert simulate.STEP == 0.001
    at_step, at_half = error(0.001, "a_z"), error(0.0005, "a_z")
    assert at_step < 0.005
    assert at_step / at_half > 3.0
    for name in ("a_x", "a_y", "roll_rate", "pitch_rate"):
        assert error(0.001, name) < 0.02, name
