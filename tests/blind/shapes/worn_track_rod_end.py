"""Play in the joints that hold a wheel's toe."""

from ridecomfort.effects.contract import Effect, Parameter

TURNING = 0.012
"""s in which a tyre's own moment turns its wheel through the play."""

effect = Effect(
    name="worn_track_rod_end",
    sentence=(
        "A worn end of a track rod, or of a rear toe link, leaves its wheel free over a small angle: the tyre turns it until it "
        "rolls without slip or the play is used up, so that it gives no side force to small slip and flutters from end to end."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: wear of joints; Pacejka (2012), Tire and Vehicle Dynamics: "
        "aligning torque, shimmy with clearance; sizes made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("front", "rad", 0.0, 0.002, (0.0, 0.012), "play of a front wheel to either side"),
        Parameter("rear", "rad", 0.0, 0.0015, (0.0, 0.012), "play of a rear wheel to either side"),
    ),
    states=("turned",),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, turned, front, rear):
    play = front if wheel < 2 else rear
    wanted = min(max(slip_y, -play), play)
    return slip_x, slip_y - turned, 0.0, (wanted - turned) / TURNING
