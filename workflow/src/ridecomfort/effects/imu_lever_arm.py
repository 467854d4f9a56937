"""An instrument that sits elsewhere than its file says."""

import numpy as np

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="imu_lever_arm",
    sentence=(
        "The instrument sits some way from its known place and feels the rotation of the body there: by default a "
        "roof taken for the centre of gravity."
    ),
    source="Titterton and Weston (2004), Strapdown Inertial Navigation Technology; a' = a + alpha x r + omega x (omega x r)",
    port="sensor",
    parameters=(
        Parameter("x", "m", 0.0, -0.3, (-2.5, 2.5), "how far ahead of its known place it sits"),
        Parameter("y", "m", 0.0, 0.2, (-1.0, 1.0), "how far to the left of its known place it sits"),
        Parameter("z", "m", 0.0, 0.9, (-1.0, 1.5), "how far above its known place it sits"),
    ),
    symmetric=False,
)


def act(drive, x, y, z):
    from scipy.interpolate import CubicSpline  # here: it takes half a second, and the library is read at every start

    rates = np.stack([drive[name].values for name in ("roll_rate", "pitch_rate", "yaw_rate")], axis=1)
    turning = CubicSpline(drive.time.values, rates)(drive.time.values, 1)
    arm = np.broadcast_to([x, y, z], rates.shape)
    moved = np.cross(turning, arm) + np.cross(rates, np.cross(rates, arm))
    return drive.assign({name: drive[name] + moved[:, i] for i, name in enumerate(("a_x", "a_y", "a_z"))})
