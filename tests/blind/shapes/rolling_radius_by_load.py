"""Tyres that roll on a smaller radius the more they bear."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="rolling_radius_by_load",
    sentence=(
        "The effective rolling radius of a tyre shrinks as its load grows, while its wheel turns on at the same pace: "
        "the slip changes with every change of load and jerks the car fore and aft."
    ),
    source=(
        "Zegelaar (1998), The dynamic response of tyres to brake torque variations and road unevennesses, TU Delft; "
        "Pacejka (2012), Tire and Vehicle Dynamics: effective rolling radius; made for blind trials"
    ),
    port="tyre_planar",
    parameters=(
        Parameter("front", "1", 0.0, 0.15, (0.0, 0.75), "loss of effective radius over growth of deflection, front"),
        Parameter("rear", "1", 0.0, 0.15, (0.0, 0.75), "loss of effective radius over growth of deflection, rear"),
        Parameter("stiffness", "N/m", 250000.0, 250000.0, (150000.0, 350000.0), "load over deflection"),
        Parameter("radius", "m", 0.32, 0.32, (0.28, 0.36), "effective radius at the mean load"),
        Parameter("mean_load", "N", 3900.0, 3900.0, (2500.0, 6000.0), "load at which the radius is that of the base model"),
    ),
)


def act(wheel, slip_x, slip_y, load, speed, slope, force_x, front, rear, stiffness, radius, mean_load):
    share = front if wheel < 2 else rear
    return slip_x - share * (load - mean_load) / (stiffness * radius), slip_y, 0.0
