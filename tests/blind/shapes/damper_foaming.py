"""Dampers whose oil foams."""

from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    name="damper_foaming",
    sentence=(
        "Fast strokes beat gas into the oil of a twin-tube damper, which then damps less until the foam has settled "
        "again: a damper is weaker after a rough patch than before it."
    ),
    source="Dixon (2007), The Shock Absorber Handbook: emulsified damper oil; Duym, Stiens and Reybrouck (1997), Evaluation of shock absorber models; made for blind trials",
    port="suspension",
    parameters=(
        Parameter("front", "1", 0.0, 0.35, (0.0, 0.9), "share of the damping of a front damper that is lost in full foam"),
        Parameter("rear", "1", 0.0, 0.45, (0.0, 0.9), "share of the damping of a rear damper that is lost in full foam"),
        Parameter("onset", "m/s", 0.15, 0.15, (0.05, 0.6), "rms speed of strokes at which half of the foam is there"),
        Parameter("memory", "s", 2.0, 2.0, (0.3, 10.0), "time in which foam builds up and settles"),
    ),
    states=("beaten",),
)


def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, beaten, front, rear, onset, memory):
    share = front if wheel < 2 else rear
    foam = beaten / (beaten + onset * onset)
    return -share * foam * damping * velocity, (velocity * velocity - beaten) / memory
