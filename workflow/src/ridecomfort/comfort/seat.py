"""From the floor to the seat: a seat's transmissibility and its SEAT value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from . import quantities, signals, weighting


@dataclass(frozen=True)
class Seat:
    """A seat with its passenger as one mass on a spring and a damper.

    ``natural_frequency`` in Hz, ``damping_ratio`` of critical. The defaults are a
    conventional foam-and-spring car seat, whose transmissibility peaks near 4 Hz at
    about 2 (Griffin 1990, Handbook of Human Vibration, section 9.3).
    """

    natural_frequency: float = 4.0
    damping_ratio: float = 0.3

    def __post_init__(self) -> None:
        if not (self.natural_frequency > 0.0 and 0.0 < self.damping_ratio < 2.0):
            raise InputError("expected a frequency above 0 Hz and a damping ratio between 0 and 2", place="seat")

    def response(self, frequency) -> np.ndarray:
        """Complex transmissibility from floor to seat at frequencies in Hz; 1 at 0 Hz."""
        ratio = np.asarray(frequency, float) / self.natural_frequency
        spring = 1 + 2j * self.damping_ratio * ratio
        return spring / (spring - ratio**2)

    @property
    def memory(self) -> float:
        """Seconds after which a transient has died away."""
        p = np.roots([1.0, 2 * self.damping_ratio, 1.0]) * 2 * np.pi * self.natural_frequency
        return float(np.log(1 / weighting.TAIL) / np.min(-p.real))


@dataclass(frozen=True)
class Behind:
    """A weighting of what a seat passes on: both filters in one."""

    weighting: weighting.Weighting
    seat: Seat

    def response(self, frequency) -> np.ndarray:
        """Complex response from the floor to the weighted vibration on the seat at frequencies in Hz."""
        return self.weighting.response(frequency) * self.seat.response(frequency)

    @property
    def memory(self) -> float:
        """Seconds after which a transient has died away."""
        return self.weighting.memory + self.seat.memory


def on_seat(floor, rate: float, seat: Seat | None = None):
    """Vertical acceleration on the seat in m/s2 from that of the floor, of its shape; as ``weighting.weight``.

    A seat passes a constant, such as gravity, unchanged: it is thought to have borne it long before the record begins.
    """
    rate = signals.check_rate(rate)
    return weighting.filtered(floor, rate, seat or Seat(), before="mirror")


def seat_value(seat, floor, rate: float, name: str = "Wk", *, dose: bool = False):
    """SEAT value in percent: the weighted vibration on the seat over that on the floor beneath it.

    By rms, or with ``dose`` by VDV where shocks matter (ISO 10326-1; Griffin 1990). 100: the seat
    neither helps nor harms; floor and seat take the same weighting.
    """
    quantity = "vdv" if dose else "rms"
    above, below = (
        quantities.metrics(weighting.weight(signal, rate, name, before="mirror"), rate)[quantity] for signal in (seat, floor)
    )
    answer = 100.0 * above.values / below.values
    return float(answer) if np.ndim(answer) == 0 else answer
