"""Another effect of a user: links that rise to the middle of the car more, or less, than the parameters say."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="inclined_links",
    sentence="Links that rise to the middle of the car lead a wheel out as it rises and press it down by a part of its side force.",
    source="Milliken and Milliken (1995), Race Car Vehicle Dynamics",
    port="kinematics",
    parameters=(
        Parameter("front", "1", 0.0, 0.05, (-0.3, 0.4), "way out of a front wheel per compression"),
        Parameter("rear", "1", 0.0, 0.05, (-0.3, 0.4), "way out of a rear wheel per compression"),
    ),
)


def act(wheel, deflection, front, rear):
    out = front if wheel < 2 else rear
    return 0.0, 0.0, out if wheel % 2 == 0 else -out
