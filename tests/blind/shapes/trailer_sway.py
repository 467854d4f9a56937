"""A trailer that sways."""

from ridecomfort.effects.contract import Effect, Parameter

GYRATION = 1.5
"""m; radius of gyration of the trailer about its centre of gravity."""

AHEAD = 0.12
"""m by which its centre of gravity lies ahead of its axle."""

BELOW = 0.15
"""m by which the ball lies below the centre of gravity of the car's body."""

effect = Effect(
    name="trailer_sway",
    sentence=(
        "A trailer swings about the tow ball at about half a hertz, the longer the faster it is drawn, and pushes the "
        "tail of the car from side to side."
    ),
    source="Mitschke and Wallentowitz (2014), Dynamik der Kraftfahrzeuge: car and trailer; Darling, Tilley and Gao (2009), Experimental investigation of car-trailer stability; made for blind trials",
    port="body",
    parameters=(
        Parameter("mass", "kg", 0.0, 700.0, (0.0, 2000.0), "mass of the trailer"),
        Parameter("length", "m", 4.0, 4.0, (2.0, 6.0), "from the ball to the axle of the trailer"),
        Parameter("overhang", "m", 1.0, 1.0, (0.6, 1.4), "from the rear axle of the car to the ball"),
        Parameter("cornering", "N/rad/kg", 60.0, 60.0, (30.0, 100.0), "cornering stiffness of the trailer's tyres over its mass"),
    ),
    states=("angle", "yaw_rate"),
)


def act(motion, angle, rate, mass, length, overhang, cornering):
    pace = max(abs(motion.speed), 2.0)
    ball = motion.rear - overhang
    to_mass = length - AHEAD
    aside = motion.side_speed + ball * motion.yaw_rate - motion.speed * angle - length * rate
    tyres = -cornering * aside / pace
    drawn = motion.speed * motion.yaw_rate
    turn = (to_mass * drawn - length * tyres) / (GYRATION * GYRATION + to_mass * to_mass)
    force = -mass * (drawn - to_mass * turn - tyres)
    return 0.0, force, 0.0, BELOW * force, 0.0, ball * force, rate - motion.yaw_rate, turn
