"""The level part of a wheel's load where the road under it is inclined."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="tyre_local_slope",
    sentence=(
        "The road pushes a wheel along its normal: where the road under one wheel rises, part of the load pushes "
        "back. The base model knows only the slope of the plane under all four."
    ),
    source="Pacejka (2012), Tire and Vehicle Dynamics: effective road plane",
    port="tyre_planar",
    parameters=(Parameter("share", "1", 0.0, 1.0, (0.0, 1.5), "share of the local slope that the load leans on"),),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, share):
    return slip_x, slip_y, -share * load * slope
