"""A cross slope that the road's file leaves out."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="road_bank",
    sentence=(
        "The road tilts to the side more than its file says, as when a scan was levelled. The base model feels every "
        "cross slope that is in the heights of the road; this adds one that is not."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="road",
    parameters=(
        Parameter("bank", "1", 0.0, 0.02, (-0.12, 0.12), "cross slope that is missing, positive with the left side up"),
    ),
    symmetric=False,
)


def act(wheel, u, v, height, rotation, surface, elevation, bank):
    return bank * v
