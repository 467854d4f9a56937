"""A grade that the road's file leaves out."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="road_grade",
    sentence=(
        "The road climbs more than its file says, as when a scan was levelled. The base model feels every grade that "
        "is in the heights of the road; this adds one that is not."
    ),
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="road",
    parameters=(Parameter("grade", "1", 0.0, 0.03, (-0.15, 0.15), "rise per metre of road that is missing"),),
)


def act(wheel, u, v, height, rotation, surface, elevation, grade):
    return grade * u
