"""An instrument that is not mounted straight."""

import numpy as np

from ridecomfort.drive.record import felt
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="imu_tilt",
    sentence=(
        "The axes of the instrument are turned against those of the body: its signals mix, and a part of gravity "
        "that nobody takes out stays in the level ones."
    ),
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology; axes and angles of ISO 8855:2011",
    port="sensor",
    parameters=(
        Parameter("roll", "rad", 0.0, 0.01, (-0.1, 0.1), "how much the instrument is rolled, left side up"),
        Parameter("pitch", "rad", 0.0, 0.02, (-0.1, 0.1), "how much the instrument is pitched, nose down"),
        Parameter("yaw", "rad", 0.0, 0.02, (-0.1, 0.1), "how much the instrument is turned to the left"),
    ),
    symmetric=False,
    order=1,
)


def act(drive, roll, pitch, yaw):
    values = np.stack([drive[name].values for name in SIGNALS])
    force = felt(drive)
    change = turned(roll, pitch, yaw).T - np.eye(3)
    moved = values + np.concatenate([change @ force, change @ values[3:]])
    return drive.assign({name: drive[name].copy(data=row) for name, row in zip(SIGNALS, moved, strict=True)})


def turned(roll, pitch, yaw):
    """Axes of the instrument as columns in the body's: turned by yaw, then pitch, then roll."""
    (a, b, c), (d, e, f) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_z = np.array([[c, -f, 0.0], [f, c, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[b, 0.0, e], [0.0, 1.0, 0.0], [-e, 0.0, b]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, a, -d], [0.0, d, a]])
    return about_z @ about_y @ about_x
