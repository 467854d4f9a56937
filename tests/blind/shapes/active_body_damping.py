"""Actuators that hold the body against its own motion (skyhook)."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="active_body_damping",
    sentence=(
        "An active chassis pushes against the speed of the body itself, up and down, in roll and in pitch, as if dampers hung "
        "from the sky. What the actuators push against, the wheels, is left out."
    ),
    source="Karnopp, Crosby and Harwood (1974), Vibration control using semi-active force generators; sizes made for blind trials",
    port="body",
    parameters=(
        Parameter("heave", "N s/m", 0.0, 2000.0, (0.0, 12000.0), "force per vertical speed"),
        Parameter("roll", "N m s/rad", 0.0, 500.0, (0.0, 6000.0), "moment per roll rate"),
        Parameter("pitch", "N m s/rad", 0.0, 3000.0, (0.0, 20000.0), "moment per pitch rate"),
    ),
    dissipative=True,
)


def act(motion, heave, roll, pitch):
    return 0.0, 0.0, -heave * motion.vertical_speed, -roll * motion.roll_rate, -pitch * motion.pitch_rate, 0.0
