"""A road scanned askew."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vehicle import ground

effect = Effect(
    name="scanner_skew",
    sentence=(
        "The scanner was mounted a little turned, so that its lines do not lie square across the road: what it shows on the "
        "left lies further on in truth and what it shows on the right nearer, and a car meets them one after the other."
    ),
    source=(
        "Glennie (2007), Rigorous 3D error analysis of kinematic scanning LIDAR systems, Journal of Applied Geodesy 1:147: "
        "boresight angles; Sayers and Karamihas (1998), The Little Book of Profiling; made for blind trials"
    ),
    port="road",
    parameters=(Parameter("skew", "rad", 0.0, 0.06, (-0.6, 0.6), "angle by which the lines are turned against the road"),),
    symmetric=False,
)


def act(wheel, u, v, height, rotation, surface, elevation, skew):
    return ground.height(surface, elevation, u - skew * v, v) - height
