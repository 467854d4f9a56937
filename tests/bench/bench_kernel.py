"""Speed of the vehicle: simulated seconds a second on one core, against the plain model and with effects."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from ridecomfort import simulate
from ridecomfort.effects import compose
from ridecomfort.vehicle import kernel, parameters, reference
from ridecomfort.vehicle.constants import constants, wheel_table
from tests.vehicle.roads import road, rough

CAR = Path(__file__).resolve().parents[2] / "config" / "vehicles" / "midsize.yaml"
EFFECTS = ("suspension_friction", "damper_asymmetry", "tyre_relaxation", "spring_progression", "aerodynamic_drag")
LENGTH, SPEED = 2000.0, 22.0


def bench() -> dict:
    """Seconds are of this process on one core, the least of several runs of a 2 km drive."""
    car = parameters.read(CAR)
    ground = road(LENGTH, height=rough, curvature=0.004 * np.sin(np.arange(0, LENGTH + 0.05, 0.1) / 50))
    course = simulate.prepare(ground)
    steps, seconds = _kernel(course, car)
    figures = {
        "kernel_step_s": simulate.STEP,
        "kernel_ns_per_step": seconds / steps * 1e9,
        "kernel_simulated_s_per_s": steps * simulate.STEP / seconds,
    }
    drive = simulate.run(course, car, speed=SPEED)
    base = _best(lambda: simulate.run(course, car, speed=SPEED))
    figures["run_simulated_s_per_s"] = float(drive.time[-1]) / base
    simulate.run(course, car, speed=SPEED, effects=EFFECTS)
    figures["five_effects_over_none"] = _best(lambda: simulate.run(course, car, speed=SPEED, effects=EFFECTS)) / base
    figures["no_effects_over_bare_kernel"] = _kernel(course, car)[1] / _kernel(course, car, kernel.drive)[1]
    figures["kernel_over_reference"] = _reference(course, car) / (seconds / steps)
    return figures


def _kernel(course, car, drive=None) -> tuple[int, float]:
    """Steps of a drive and the least time in s that a kernel needs for them, by default the one with no effects."""
    drive = drive or compose.compose([]).drive
    targets = np.stack([np.full(course.u.size, SPEED), np.zeros(course.u.size), course.curvature], axis=1)
    record, sensed = np.empty((20000, 11)), np.empty((6, 200000))

    def call():
        return drive(
            constants(car), wheel_table(car), course.surface, course.elevation, targets, 0.8, 4.0, LENGTH - 4.0,
            simulate.STEP, 10, (0.0, 0.0, 0.0), np.zeros(0), 0, record, sensed,
        )  # fmt: skip

    return call()[1], _best(call)


def _reference(course, car) -> float:
    """Seconds a step of the plain model."""
    targets = np.stack([np.full(course.u.size, SPEED), np.zeros(course.u.size), course.curvature], axis=1)
    start = time.process_time()
    _, sensed = reference.drive(
        car, course.surface, course.elevation, targets, 0.8, 4.0, 24.0, simulate.STEP, 10
    )
    return (time.process_time() - start) / sensed.shape[1]


def _best(call, repeats: int = 7) -> float:
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)
