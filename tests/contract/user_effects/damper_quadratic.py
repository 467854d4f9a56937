"""An effect as a user may keep it in a folder of his own: dampers with a share of quadratic damping."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_quadratic",
    sentence="Oil that is pushed through an orifice resists with the square of its speed.",
    source="Dixon (2007), The Shock Absorber Handbook",
    port="suspension",
    parameters=(Parameter("coefficient", "N s2/m2", 0.0, 800.0, (0.0, 4000.0), "force over the square of speed"),),
    dissipative=True,
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, coefficient):
    return coefficient * velocity * abs(velocity)
