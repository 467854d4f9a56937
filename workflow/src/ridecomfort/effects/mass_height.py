"""A centre of gravity that lies higher or lower than the parameters say."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="mass_height",
    sentence="The sprung mass lies higher than the parameters say, which leans the car more in bends and under braking.",
    source="Gillespie (1992), Fundamentals of Vehicle Dynamics; ISO 10392:2011 for how it is measured",
    port="vehicle",
    parameters=(Parameter("shift", "m", 0.0, 0.05, (-0.2, 0.3), "how much higher the centre of gravity lies"),),
)


def act(vehicle, shift):
    return vehicle.replace(cg_height=vehicle["cg_height"] + shift)
