"""Roll bars with motors that hold the body level in bends."""

from ridecomfort.effects.contract import Effect, Parameter

MOST = 2500.0
"""N m; all that the motors of both bars can do."""

effect = Effect(
    name="active_roll_bars",
    sentence=(
        "Motors in the roll bars twist them against the lean that a controller expects of the side acceleration, which it takes "
        "from speed and yaw rate: the body leans less in bends, a little late, and rolls as before over bumps."
    ),
    source=(
        "Konik, Bartz, Baernthol, Bruns and Wimmer (2000), Dynamic Drive: the new active roll stabilization system from the BMW "
        "Group, AVEC 2000; Heissing and Ersoy (2011), Chassis Handbook; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("share", "1", 0.0, 0.6, (0.0, 1.0), "part of the leaning moment that the motors take"),
        Parameter("lever", "m", 0.44, 0.44, (0.3, 0.7), "height of the centre of gravity above the roll axis that the controller knows"),
        Parameter("time", "s", 0.08, 0.08, (0.03, 0.3), "time in which the motors follow"),
    ),
    states=("moment",),
)


def act(motion, moment, share, lever, time):
    asked = share * motion.sprung_mass * lever * motion.speed * motion.yaw_rate
    return 0.0, 0.0, 0.0, -moment, 0.0, 0.0, (min(max(asked, -MOST), MOST) - moment) / time
