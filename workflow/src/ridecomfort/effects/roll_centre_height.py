"""Roll centres that lie higher or lower than the parameters say."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="roll_centre_height",
    sentence=(
        "The roll centres lie higher than the parameters say: the links take more of the side force, and the body "
        "rolls less."
    ),
    source="Reimpell, Stoll and Betzler (2001), The Automotive Chassis; Gillespie (1992), Fundamentals of Vehicle Dynamics",
    port="vehicle",
    parameters=(
        Parameter("front", "m", 0.0, 0.04, (-0.2, 0.3), "how much higher the front roll centre lies"),
        Parameter("rear", "m", 0.0, 0.04, (-0.2, 0.3), "how much higher the rear roll centre lies"),
    ),
)


def act(vehicle, front, rear):
    return vehicle.replace(
        roll_centre_height_front=vehicle["roll_centre_height_front"] + front,
        roll_centre_height_rear=vehicle["roll_centre_height_rear"] + rear,
    )
