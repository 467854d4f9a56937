"""Front and rear springs that are joined by pipes."""

from ridecomfort.effects.contract import Effect, Parameter
from ridecomfort.vocabulary import STANDARD_GRAVITY

effect = Effect(
    name="hydraulic_interconnection",
    sentence=(
        "The fluid of the front springs is joined to that of the rear ones by pipes along the car: what a bump adds to the force of "
        "one axle flows in part to the other, which evens out pitch and leaves bounce as it was. What the wheels feel is left out."
    ),
    source=(
        "Moulton and Best (1979), From Hydrolastic to Hydragas suspension, Proc. IMechE 193:15; Heissing and Ersoy (2011), Chassis "
        "Handbook; sizes made for blind trials"
    ),
    port="body",
    parameters=(
        Parameter("share", "1", 0.0, 0.15, (0.0, 0.45), "part of the difference of the axles' forces that changes axle"),
        Parameter("pipe", "s", 0.03, 0.03, (0.01, 0.15), "time in which the fluid flows"),
    ),
    states=("difference",),
)


def act(motion, difference, share, pipe):
    base = motion.front - motion.rear
    weight = motion.sprung_mass * STANDARD_GRAVITY / base
    front = motion.suspension_front + weight * motion.rear
    rear = motion.suspension_rear - weight * motion.front
    return 0.0, 0.0, 0.0, 0.0, share * base * difference, 0.0, (front - rear - difference) / pipe
