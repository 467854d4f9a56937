"""Dampers with a bypass that closes in a long rebound."""

from ridecomfort.effects.contract import Effect, Parameter

OPENING = 0.01
"""s in which the bypass opens again in bump."""

EDGE = 0.01
"""m/s of rebound at which the pressure closes the bypass in full."""

effect = Effect(
    name="frequency_selective_damper",
    sentence=(
        "A bypass is open at the start of every rebound and closes while the pressure lasts: quick rebounds of the "
        "wheels are damped less, long ones of the body in full."
    ),
    source=(
        "Heissing and Ersoy (2011), Chassis Handbook: frequency-selective damping; Koni FSD, European patent EP 1 442 "
        "227; made for blind trials"
    ),
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.5, (0.0, 0.95), "share of the rebound damping that the open bypass takes, front"),
        Parameter("rear", "1", 0.0, 0.5, (0.0, 0.95), "share of the rebound damping that the open bypass takes, rear"),
        Parameter("time", "s", 0.08, 0.08, (0.03, 0.3), "time in which the bypass closes"),
    ),
    states=("closed",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, closed, front, rear, time):
    share = front if wheel < 2 else rear
    wanted = min(max(-velocity / EDGE, 0.0), 1.0)
    slope = (wanted - closed) / (time if wanted > closed else OPENING)
    return -share * damping * min(velocity, 0.0) * (1.0 - closed), slope
