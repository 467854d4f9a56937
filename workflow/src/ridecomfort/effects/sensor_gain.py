"""An instrument whose scale is off."""

import numpy as np

from ridecomfort.drive.record import felt
from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import SIGNALS

effect = Effect(
    name="sensor_gain",
    sentence="The instrument shows its signals too large by a share; an accelerometer shows gravity too large as well.",
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology: scale-factor errors",
    port="sensor",
    parameters=(
        Parameter("accelerometer", "1", 0.0, 0.02, (-0.1, 0.1), "share by which accelerations are too large"),
        Parameter("gyroscope", "1", 0.0, 0.02, (-0.1, 0.1), "share by which rates are too large"),
    ),
    order=2,
)


def act(drive, accelerometer, gyroscope):
    values = np.stack([drive[name].values for name in SIGNALS])
    force = felt(drive)
    scaled = values + np.concatenate([accelerometer * force, gyroscope * values[3:]])
    return drive.assign({name: drive[name].copy(data=row) for name, row in zip(SIGNALS, scaled, strict=True)})
