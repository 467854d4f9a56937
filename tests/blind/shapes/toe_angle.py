"""Wheels of an axle that are turned against each other."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="toe_angle",
    sentence=(
        "The wheels of an axle point inwards or outwards: their side forces cancel only while both bear the same "
        "load, so that a road which loads them unequally shakes the car sideways."
    ),
    source=(
        "Reimpell, Stoll and Betzler (2001), The Automotive Chassis: toe-in and running straight; Gillespie (1992), "
        "Fundamentals of Vehicle Dynamics; made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("front", "1", 0.0, 0.005, (-0.025, 0.025), "what the slip of the left front wheel gains and of the right one loses"),
        Parameter("rear", "1", 0.0, 0.005, (-0.025, 0.025), "what the slip of the left rear wheel gains and of the right one loses"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, front, rear):
    toe = front if wheel < 2 else rear
    return slip_x, slip_y + toe if wheel % 2 == 0 else slip_y - toe, 0.0
