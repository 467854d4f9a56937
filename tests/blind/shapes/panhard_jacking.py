"""A rod across the car that holds the rear axle."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="panhard_jacking",
    sentence=(
        "A Panhard rod that does not lie level lifts the tail in bends to one side and draws it down in those to the "
        "other; when the tail goes up and down the rod pushes it sideways."
    ),
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics: Panhard bar; Heissing and Ersoy (2011), Chassis Handbook; made for blind trials",
    port="body",
    parameters=(
        Parameter("inclination", "1", 0.0, 0.1, (-0.4, 0.4), "tangent of the rod's inclination, rising to the right"),
        Parameter("mount", "m", -0.45, -0.45, (-0.6, 0.6), "place of its end on the body, to the left of the middle"),
        Parameter("cornering", "N/rad", 90000.0, 90000.0, (50000.0, 160000.0), "cornering stiffness of the rear axle"),
    ),
    symmetric=False,
)


def act(motion, inclination, mount, cornering):
    pace = max(abs(motion.speed), 3.0)
    held = motion.sprung_mass * motion.front / (motion.front - motion.rear) * motion.speed * motion.yaw_rate
    rising = motion.vertical_speed - motion.rear * motion.pitch_rate + mount * motion.roll_rate
    aside = -cornering * inclination * rising / pace
    lift = inclination * (held + aside)
    return 0.0, aside, lift, mount * lift, -motion.rear * lift, motion.rear * aside
