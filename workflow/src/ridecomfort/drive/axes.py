"""Whether the horizontal axes of an instrument are exchanged, or point the other way: it is then turned in yaw by quarters, which gravity does
not show and the small steps of alignment (``mounting.fit``) find late, or not."""

from __future__ import annotations

import numpy as np

from ..vocabulary import SIGNALS
from . import record
from .place import STANDS_STILL
from .replay import Replay, Simulated

PAIRS = (("a_x", "a_y"), ("roll_rate", "pitch_rate"))
"""Signals along the vehicle and across it, to the left, that an instrument which is turned in yaw tells of one another."""

LEAST, TIMES = 0.3, 2.0
"""Correlation (mean over the PAIRS) from which on a turn is likely, that of a drive at a wrong place staying below (``align.LOWEST``), and
times that of the axes as they are: that of an instrument turned by 63 deg, which takes all rounds of alignment or more."""


EXCHANGED, OWN = 0.6, 0.4
"""Correlation of two signals with the model's of one another (mean) from which on their columns are likely exchanged, and that which each of these exceeds
and none with its own: a_x of a drive at a constant speed is little but noise."""


def agreement(again: Replay, simulated: Simulated) -> np.ndarray:
    """Correlation of record and model, mean over the PAIRS, (4,): as recorded, and of an instrument that is turned to the left by one, two, and
    three quarters. What either does not move in counts nothing; accelerations hold gravity where those of the record do."""
    own, exchanged = _correlations(again, simulated)
    right, left = own.mean(), exchanged.mean()
    return np.array([right, left, -right, -left])


def put_right(again: Replay, simulated: Simulated) -> tuple[float, float]:
    """The same mean with every sign put right, and of an instrument that is turned by the best angle of all."""
    own, exchanged = _correlations(again, simulated)
    return float(np.abs(own).mean()), float(np.hypot(own.mean(), exchanged.mean()))


def _correlations(again: Replay, simulated: Simulated) -> tuple[np.ndarray, np.ndarray]:
    """Correlations of record and model, (pair, 2): of each of the PAIRS with itself, and as it is told after a quarter to the left."""
    measured, model = again.measured(), simulated.signals.copy()
    if again.drive.attrs["gravity"]:
        measured[:3], model[:3] = record.felt(again.drive), record.specific_force(model[:3], simulated.roll, simulated.pitch)
    kept, moves = again.compared, model.std(axis=1) > STANDS_STILL * measured.std(axis=1)

    def correlation(name: str, of: str) -> float:
        one, other = (values[SIGNALS.index(own), kept] for values, own in ((measured, name), (model, of)))
        spread = one.std() * other.std()
        return float(np.mean((one - one.mean()) * (other - other.mean())) / spread) if moves[SIGNALS.index(of)] and spread > 0 else 0.0

    own = [[correlation(along, along), correlation(across, across)] for along, across in PAIRS]
    exchanged = [[-correlation(across, along), correlation(along, across)] for along, across in PAIRS]
    return np.array(own), np.array(exchanged)


def words(again: Replay, simulated: Simulated) -> str:
    """Words on axes that agree far better with the model after a turn by quarters, with what to change; empty where they do not."""
    found = agreement(again, simulated)
    quarters = int(np.argmax(found))
    if quarters == 0 or found[quarters] < max(LEAST, TIMES * found[0]):
        return ""
    signs = {1: ("-", ""), 2: ("-", "-"), 3: ("", "-")}[quarters]
    told = [
        f"{name} = {sign}{own}"
        for along, across in PAIRS
        for name, sign, own in zip((along, across), signs, (along, across) if quarters == 2 else (across, along))
    ]
    angle = 90 * quarters if quarters < 3 else -90
    return (
        f"the instrument looks turned by {angle:+d} deg in yaw: {', '.join(name for pair in PAIRS for name in pair)} correlate with the model by "
        f"{found[quarters]:.2f} then, by {found[0]:.2f} as recorded "
        f"(if so, exchange `columns`, and `factor` where there is a minus: {', '.join(told)})"
    )


def columns(again: Replay, simulated: Simulated) -> str:
    """Words on two signals of which each does what the model does in the other, while the instrument is not turned; empty where there are none."""
    own, to_the_left = _correlations(again, simulated)
    exchanged = to_the_left * [-1.0, 1.0]  # after a quarter one of two has the other sign
    found = [" and ".join(pair) for pair, one, other in zip(PAIRS, own, exchanged) if other.mean() > EXCHANGED and other.min() > OWN > one.max()]
    return "; ".join(f"{names} each do what the model does in the other: are their columns exchanged?" for names in found)
