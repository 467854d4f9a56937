"""What a force that is in no library may be made of: terms, what they remember, and what shapes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, degrees, hypot, pi

from ..effects.contract import Parameter
from ..effects.lag import SHORTEST
from ..vocabulary import STANDARD_GRAVITY

FASTEST = round(1.0 / (2.0 * pi * SHORTEST), 1)
"""Hz up to which a low-pass can be integrated. One that is faster differs from the slower one by damping, or by the size of its factor,
which are fitted anyway."""

AXLES = ("front", "rear")

WHOLE = ("",)

WHEELS = ("front_left", "front_right", "rear_left", "rear_right")

TURNING = tuple(f"{wheel}_{wave}" for wheel in WHEELS for wave in ("cosine", "sine"))
"""Parts of what comes and goes as a wheel turns, from an angle of its own."""

WAVES = ("cosine", "sine")
"""The same of what comes and goes for the whole car."""

WHIRL = ("up_cosine", "up_sine", "aside_cosine", "aside_sine")
"""The same of a force on the body that does so up and down and from side to side."""

AT_ONCE = 100.0
"""Per second, at which what a stroke has closed opens after its end."""

CHANGING = 1.0 / SHORTEST
"""Per second, at which a speed is followed whose change is wanted: the quickest that is integrated in steps of up to 2 ms."""

SIDE = "(1.0 - 2.0 * (wheel % 2))"
"""1 on the left, -1 on the right: what calibration, whose parameters are those of axles, cannot take up of a single wheel."""

LINEAR = Parameter("linear", "1", 0.0, 0.0, (-3.0, 3.0), "linear part beside it, in shares of it at typical motion")
"""What lets a force take the place of a spring or damper of a vehicle, of which calibration changes no more than is plausible."""


def shape_setting(name: str, unit: str, typical: float, lower: float, upper: float, meaning: str) -> Parameter:
    """What shapes a term, from its ``typical`` value on."""
    return Parameter(name, unit, typical, typical, (lower, upper), meaning)


@dataclass(frozen=True)
class State:
    """What a force remembers: its ``name``, its ``slope`` (an expression, per second), and a ``typical`` value."""

    name: str
    slope: str
    typical: float


@dataclass(frozen=True)
class Term:
    """A part of a force: its ``expression`` in what the place sees, its own ``states`` and ``settings``, the ``unit`` of its factor, the
    ``result`` it adds to, and the ``parts`` of a car that have a factor of their own (one axle's, a wheel's, or the whole car's). A force
    on the body acts ``ahead`` of the centre of gravity and ``above`` it (m, expressions) where that is given. ``beside``: what it may be
    linear in, too; ``turn``: the angle that the parts of TURNING, WAVES or WHIRL are cosine and sine of; ``after``: the unit of the
    ``period``, m of way or s of time, after which it comes back, where it is looked for only once such a period was heard; ``often``: how
    often it comes in a turn of a wheel, of what turns with one; ``in_rebound``: whether it is nil in compression."""

    expression: str
    unit: str
    result: str = "force"
    parts: tuple[str, ...] = AXLES
    states: tuple[State, ...] = ()
    settings: tuple[Parameter, ...] = ()
    ahead: str = ""
    above: str = ""
    beside: str = ""
    turn: str = ""
    after: str = ""
    often: int = 0
    in_rebound: bool = False

    def written(self, expression: str) -> str:
        """An ``expression`` of it, with the wave that it comes and goes as if it does."""
        return f"{expression} * cos({self.turn} - angle)".removeprefix("1.0 * ") if self.turn else expression

    def amplitudes(self, factors: Mapping[str, float]) -> dict[str, tuple[float, float]]:
        """By part of what comes and goes, the amplitude of its wave and the angle in degrees at which that is largest, of the ``factors`` of its
        cosines and sines, as far as these are given."""
        pairs = {cosine.removesuffix("cosine").strip("_"): (cosine, sine) for cosine, sine in zip(self.parts[::2], self.parts[1::2])}
        own = {part: [factors.get(name, 0.0) for name in pair] for part, pair in pairs.items() if set(pair) & set(factors)}
        return {part: (hypot(cosine, sine), degrees(atan2(sine, cosine))) for part, (cosine, sine) in own.items()}

    def arms(self, result: str) -> dict[str, tuple[str, str]]:
        """By the arm of a force, the moment that it makes about the centre of gravity, and with which sign."""
        arms = {("force_y", self.ahead): ("moment_z", "+"), ("force_z", self.ahead): ("moment_y", "-")}
        arms |= {("force_x", self.above): ("moment_y", "+"), ("force_y", self.above): ("moment_x", "-")}
        return {arm: moment for (force, arm), moment in arms.items() if arm and force == result}

    def by_result(self) -> dict[str, tuple[str, ...]]:
        """The parts by the result that they add to."""
        return {self.result: self.parts} if self.parts != WHIRL else {"force_z": self.parts[:2], "force_y": self.parts[2:]}


def below(expression: str, beside: str = "") -> Term:
    """Velocity through a low-pass of first order, ``slow``: what creeps beside a spring; without the velocity itself, what gives way in
    series with a damper."""
    frequency = shape_setting("frequency", "Hz", 10.0, 1.0, FASTEST, "frequency that it follows up to")
    return Term(
        expression, "N s/m", states=(State("slow", f"{2 * pi:.4f} * frequency * (velocity - slow)", 0.1),), settings=(frequency,), beside=beside
    )


def hardening() -> Term:
    """What a damper loses as rubber in series with it gives ``way``, which hardens as it is pressed."""
    frequency = shape_setting("frequency", "Hz", 10.0, 3.0, 15.0, "frequency that it follows up to while it is hardly pressed")
    knee = shape_setting("knee", "m", 0.002, 0.0003, 0.01, "way at which it is twice as stiff")
    turns, harder = f"{2 * pi:.4f} * frequency", "min((way / knee)**2, 4.0)"
    force = f"{turns} * way * (1.0 + {harder})"
    no_quicker = f"max({SHORTEST} * {turns} * (1.0 + 3.0 * {harder}), 1.0)"
    slope = f"(velocity - {force}) / {no_quicker}"
    return Term(f"{force} - velocity", "N s/m", states=(State("way", slope, 0.001),), settings=(frequency, knee))


def when_thrown(part: str) -> Term:
    """A ``part`` of the velocity that counts while this rises quickly, as with a valve that the inertia of a mass in it opens."""
    threshold = shape_setting("threshold", "m/s2", 5.0, 1.0, 20.0, "acceleration at which half of it counts")
    rises = f"max({CHANGING} * (velocity - past), 0.0)"
    return Term(
        f"{part} * (1.0 - 1.0 / (1.0 + ({rises} / threshold)**2))", "N s/m", states=(State("past", f"{CHANGING} * (velocity - past)", 0.08),),
        settings=(threshold,), beside="velocity",
    )  # fmt: skip


def pressed_down() -> Term:
    """What is ``pressed`` down at once where a wheel bears more than at rest, and comes up as it rolls on: in shares of the deflection at rest."""
    angle = shape_setting("angle", "rad", 1.0, 0.3, 5.0, "angle that a wheel turns until it has come up")
    wanted = "(max(deflection / rest, 0.0) - 1.0 - pressed)"
    pressed = State("pressed", f"{wanted} * ({1.5 * AT_ONCE} if {wanted} > 0.0 else abs(spin) / angle)", 0.5)
    return Term("pressed", "N", states=(pressed,), settings=(angle,), beside="deflection")


def at_first(part: str, is_there: str, in_rebound: bool = False) -> Term:
    """A ``part`` of the velocity that counts in full at the beginning of each stroke to a side and less and less in its course, as if a valve
    were ``closed``; it opens at once while the velocity is not to that side."""
    frequency = shape_setting("frequency", "Hz", 3.0, 0.5, 20.0, "frequency of strokes up to which it is lost")
    closed = State("closed", f"{2 * pi:.4f} * frequency * (1.0 - closed) if {is_there} else -{AT_ONCE} * closed", 0.4)
    return Term(f"{part} * (1.0 - closed)", "N s/m", states=(closed,), settings=(frequency,), beside="velocity", in_rebound=in_rebound)


def shared_slowly(own: str, others: str, unit: str, typical: float) -> Term:
    """What two struts make of the difference (typically ``typical``) between this one's ``own`` motion and the ``others``, as far as fluid has time
    to flow."""
    frequency = shape_setting("frequency", "Hz", 3.0, 0.3, 20.0, "frequency that the flow follows up to")
    slow = State("slow", f"{2 * pi:.4f} * frequency * ({own} - {others} - slow)", typical)
    return Term("slow", unit, parts=WHOLE, states=(slow,), settings=(frequency,), beside=f"({own} - {others})")


def remembering(what: str, unit: str, *times: float) -> Term:
    """What a damper or spring makes of ``what`` it sees, times how fast it moved of late; ``times`` for which it remembers that: the typical
    one, the least and the largest (s)."""
    time = shape_setting("time", "s", *times, "time for which it remembers how fast it moved")
    return Term(f"recent * {what}", unit, states=(State("recent", "(abs(velocity) - recent) / time", 0.1),), settings=(time,), beside=what)


def sliding(expression: str, unit: str, beside: str, velocity: str = "velocity") -> Term:
    """The direction of motion, which ``strain`` follows over some millimetres."""
    presliding = shape_setting("presliding", "m", 0.001, 0.0002, 0.008, "way over which the direction turns")
    return Term(expression, unit, states=(strained(velocity, "presliding"),), settings=(presliding,), beside=beside)


def strained(velocity: str, way: str) -> State:
    """The direction of a ``velocity`` as what turns with it over a ``way`` has it (Dahl 1976), no quicker than in SHORTEST."""
    size = _absolute(velocity)
    return State("strain", f"({velocity} - {size} * strain) / max({way}, {SHORTEST} * {size})", 1.0)


def _absolute(expression: str) -> str:
    """The size of what an expression, in parentheses if it is more than a name, comes to."""
    return f"abs({expression.strip('()')})"


def acting_beyond(expression: str, *clearances: float, unit: str = "N/m", beside: str = "deflection", in_rebound: bool = False) -> Term:
    """What acts from a deflection on: a typical clearance, the least and the largest."""
    clearance = shape_setting("clearance", "m", *clearances, "deflection from which on it acts")
    return Term(expression, unit, settings=(clearance,), beside=beside, in_rebound=in_rebound)


def on_spring(
    base: str, typical: float, unit: str, result: str, ahead: str = "", frequencies: tuple[float, float, float] = (11.0, 5.0, 25.0),
    above: str = "", known: tuple[State, ...] = (),
) -> Term:  # fmt: skip
    """A part of the sprung mass that moves on a spring of its own where the body has the acceleration ``base`` (typically ``typical``);
    ``frequencies``: the typical one, the least and the largest (Hz); ``known``: what the ``base`` needs to remember."""
    frequency = shape_setting("frequency", "Hz", *frequencies, "frequency at which it swings")
    damping = shape_setting(DAMPING_RATIO, "1", 0.1, 0.02, 0.5, "share of critical damping")
    turns = f"{2 * pi:.4f} * frequency"
    against = f"({turns})**2 * way + 2.0 * damping_ratio * {turns} * rate"
    usual = 2 * pi * frequency.typical
    states = *known, State("way", "rate", typical / usual**2), State("rate", f"-({base} + {against})", typical / usual)
    at = (AT[name] for name in (ahead, above) if name in AT)
    return Term(f"{base} + {against}", unit, result, WHOLE, states, (frequency, damping, *at), ahead, above)


def swaying() -> Term:
    """A mass that moves aside on a spring of its own, where the body below it does."""
    past = State("past", f"{CHANGING} * (motion.side_speed - past)", 0.095)
    body = (
        f"{CHANGING} * (motion.side_speed - past) + motion.speed * motion.yaw_rate + {STANDARD_GRAVITY:.4g} * motion.roll"
        " - height * motion.roll_acceleration"
    )
    return on_spring(body, 1.0, "kg", "force_y", "place", (3.0, 0.5, 15.0), "height", (past,))


def steering_along() -> Term:
    """Rear wheels that an actuator turns with the bend, the other way when slow: what their side force pushes."""
    change = shape_setting("change", "m/s", 8.0, 0.0, 25.0, "speed below which it pushes the other way")
    bend = "motion.yaw_rate * (1.0 - change / max(motion.speed, 3.0))"
    return following(bend, 0.03, 0.08, "N s", "force_y", above="height", ahead="motion.rear", settings=(change,))


def following(
    base: str, typical: float, time: float, unit: str, result: str, beside: str = "", above: str = "", ahead: str = "",
    settings: tuple[Parameter, ...] = (),
) -> Term:  # fmt: skip
    """What follows ``base`` (typically ``typical``) with a lag of ``time`` (s), as what is driven by a controller does: ``late``; ``settings``:
    what else shapes the base."""
    lag = shape_setting("time", "s", time, max(0.2 * time, SHORTEST), 5.0 * time, "time that it is late by")
    states, at = (State("late", f"({base} - late) / time", typical),), (AT[above],) if above else ()
    return Term("late", unit, result, WHOLE, states, (lag, *settings, *at), ahead=ahead, above=above, beside=beside)


def swinging(base: str, typical: float, expression: str, unit: str, result: str, parts: tuple[str, ...], beside: str = "") -> Term:
    """What follows ``base`` (typically ``typical``) as a mass on a spring does: ``way``, in units of it."""
    frequency = shape_setting("frequency", "Hz", 8.0, 3.0, 25.0, "frequency at which it swings")
    damping = shape_setting(DAMPING_RATIO, "1", 0.2, 0.05, 0.8, "share of critical damping")
    turns = f"{2 * pi:.4f} * frequency"
    slope = f"({turns})**2 * ({base} - way) - 2.0 * damping_ratio * {turns} * rate"
    states = State("way", "rate", typical), State("rate", slope, 2 * pi * frequency.typical * typical)
    return Term(expression, unit, result, parts, states, (frequency, damping), beside=beside)


DAMPING_RATIO = "damping_ratio"
"""What the setting is called that says how soon a term that swings at a frequency of its own comes to rest."""

PERIOD = "period"
"""What the setting is called that says after which way or time a term comes back."""

CLOSE = 2e-4
"""Share of its value by which the period of a form that was found may plausibly be changed: farther off its phase is lost within a few
kilometres, and a fit finds another minimum."""


def turning(often: int, expression: str = "1.0", unit: str = "N") -> Term:
    """What comes ``often`` in a turn of each wheel, from an angle of its own."""
    return Term(expression, unit, parts=TURNING, turn="rotation" if often == 1 else f"{often:.1f} * rotation", often=often)


ORDER = "order"
"""What the setting is called that says how often a term comes in a turn of a wheel."""

FIRM = (PERIOD, ORDER)
"""Settings that begin at the line that was heard; in an effect file they may vary by CLOSE."""


def turning_as_heard(expression: str = "1.0", unit: str = "N") -> Term:
    """What comes as often in a turn of each wheel as was heard, from an angle of its own: no whole number where something creeps round in a
    tyre, or where wheels roll farther in a turn than they are thought to."""
    order = shape_setting(ORDER, "1", 1.0, 0.1, 25.0, "how often it comes in a turn of the wheel")
    return Term(expression, unit, parts=TURNING, settings=(order,), turn=f"{ORDER} * rotation", after="m")


def _period(after: str) -> Parameter:
    """The way (m) or the time (s) ``after`` which a term comes back."""
    typical, longest = (2.0, 7.0) if after == "m" else (0.1, 0.33)
    return shape_setting(PERIOD, after, typical, 0.1 * typical, longest, f"{'way' if after == 'm' else 'time'} after which it comes back")


def running_out_aside() -> Term:
    """What turns each wheel aside and back, from an angle of its own, after the way of a turn that was heard: the contact does not see its wheel
    turn, and counts its way."""
    turn = State("turn", f"{2 * pi:.6f} * (1.0 + slip_x) * speed / {PERIOD}", 1.0)
    return Term("1.0", "1", "slip_y", TURNING, (turn,), (_period("m"),), turn="turn", after="m")


AT = {
    "place": shape_setting("place", "m", 0.0, -2.0, 2.0, "how far ahead of the centre of gravity it acts"),
    "height": shape_setting("height", "m", 0.0, -0.8, 0.8, "how far above the centre of gravity it acts"),
}
"""Where a force on the body acts, by what this is called."""


def coming_back(
    after: str, unit: str, result: str, expression: str = "1.0", parts: tuple[str, ...] = WAVES, ahead: str = "", above: str = ""
) -> Term:
    """What comes back ``after`` a way (m) or a time (s), with one phase in all drives, counted from the beginning of the road or of a drive."""
    times = f"{2 * pi:.6f}"
    turn, states = (f"{times} * motion.s / {PERIOD}", ()) if after == "m" else ("phase", (State("phase", f"{times} / {PERIOD}", 1.0),))
    at = (AT[name] for name in (ahead, above) if name)
    return Term(expression, unit, result, parts, states, (_period(after), *at), ahead, above, turn=turn, after=after)


KNEE = shape_setting("knee", "m/s", 0.1, 0.02, 0.5, "velocity at which it is half of what it would be without")
"""What shapes a force that grows less and less with velocity."""


def saturating(velocity: str, parts: tuple[str, ...]) -> Term:
    """What grows less and less with a ``velocity``."""
    return Term(f"{velocity} / (1.0 + {_absolute(velocity)} / knee)", "N s/m", parts=parts, settings=(KNEE,), beside=velocity)


ANGLE = shape_setting("knee", "rad", 0.01, 0.001, 0.05, "angle at which it is half of what it would be without")
"""What shapes a moment that grows less and less with the angle of roll."""

OF_STRUCTURE = (18.0, 8.0, 40.0)
"""Frequencies of a body that is not rigid, as for ``on_spring``."""
