"""Air springs with a second volume behind an orifice."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="air_spring_volume",
    sentence=(
        "An air spring shares its air with a second volume through an orifice: slow travel is held by all of the air, "
        "fast travel by that of the bellows alone, which is stiffer, and in between the orifice damps."
    ),
    source="Quaglia and Sorli (2001), Air suspension dimensionless analysis and design procedure, Vehicle System Dynamics 35; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.3, (0.0, 2.0), "growth of the stiffness of a front spring from slow to fast"),
        Parameter("rear", "1", 0.0, 0.4, (0.0, 2.0), "growth of the stiffness of a rear spring from slow to fast"),
        Parameter("time", "s", 0.08, 0.08, (0.02, 1.0), "time in which the pressures come to equal"),
    ),
    states=("slow",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, slow, front, rear, time):
    share = front if wheel < 2 else rear
    return share * stiffness * (deflection - slow), (deflection - slow) / time
