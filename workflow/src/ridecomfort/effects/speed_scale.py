"""A speed that is shown too high."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="speed_scale",
    sentence=(
        "Speed and distance are taken from the wheels with a wrong rolling radius: both are too large by a share, "
        "and place on the road is off by more the longer the drive."
    ),
    source="Kiencke and Nielsen (2005), Automotive Control Systems: speed from wheel rotation",
    port="sensor",
    parameters=(Parameter("scale", "1", 0.0, 0.005, (-0.05, 0.05), "share by which speed and distance are too large"),),
    order=2,
)


def act(drive, scale):
    return drive.assign(
        v_x=drive.v_x + scale * drive.v_x,
        s=drive.s + scale * (drive.s - drive.s[0].item()),
    )
