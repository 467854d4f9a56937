"""Suction under a body that nods."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="underbody_suction",
    sentence=(
        "Air under a body that nods is squeezed where the nose is low: the nearer it comes to the road, the more it is drawn down, "
        "with the square of the speed, as if the springs were softer against pitching."
    ),
    source=(
        "Katz (2006), Race Car Aerodynamics: ground effect and pitch sensitivity; Hucho and Sovran (1993), Aerodynamics of road "
        "vehicles, Annual Review of Fluid Mechanics 25:485; made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("suction", "kg/rad", 0.0, 25.0, (-150.0, 150.0), "nose-down moment over square of the speed and angle of pitch"),
        Parameter("time", "s", 0.05, 0.05, (0.01, 0.2), "time in which the flow follows"),
    ),
    states=("angle",),
)


def act(motion, angle, suction, time):
    return 0.0, 0.0, 0.0, 0.0, suction * motion.speed**2 * min(max(angle, -0.1), 0.1), 0.0, (motion.pitch - angle) / time
