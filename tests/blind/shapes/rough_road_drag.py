"""Drag of a tyre that climbs more than it gets back."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="rough_road_drag",
    sentence=(
        "A tyre that rolls over unevenness loses energy going up and coming down: beside the push of the slope itself its axle is "
        "held back in proportion to load and to the slope without its sign."
    ),
    source="Wong (2008), Theory of Ground Vehicles: rolling resistance over roughness of the road; form and sizes made for blind trials",
    port="tyre_planar",
    parameters=(
        Parameter("share", "1", 0.0, 0.15, (0.0, 0.6), "drag over load and unsigned slope"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, share):
    return slip_x, slip_y, -share * load * abs(slope) * min(max(speed, -1.0), 1.0)
