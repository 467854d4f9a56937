"""How far fitted sizes would move if one effect more were there, which the drives leave open.

Such an effect moves sizes on all repeats and at all places alike, so that neither noise nor blocks show it, and drives held out in part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import expit
from scipy.stats import norm

from . import evidence, refit
from .experiment import Candidate, Frame, Size
from .probe import Job, Raw
from .refit import Fit

NOTABLE = 1.5
"""Times by which an interval is widened from which on it is said for what."""


@dataclass(frozen=True)
class Allowance:
    """The largest ``shift`` of a size that one effect more would bring, in its unit and by the root of how likely that effect is, and its
    ``name``."""

    shift: float = 0.0
    name: str = ""

    def widened(self, interval: tuple[float, float]) -> tuple[float, float]:
        """An interval of ``refit.CONFIDENCE`` that takes the shift for a standard deviation more."""
        middle, half = sum(interval) / 2, (interval[1] - interval[0]) / 2
        wider = float(np.hypot(half, norm.ppf(0.5 + refit.CONFIDENCE / 2) * self.shift))
        return middle - wider, middle + wider

    def is_notable(self, interval: tuple[float, float]) -> bool:
        """Whether it widens an interval by much."""
        lower, upper = self.widened(interval)
        return upper - lower > NOTABLE * (interval[1] - interval[0])


def allowances(
    fit: Fit, frame: Frame, sizes: Sequence[Size], raw: Mapping[Job, Raw], candidates: Mapping[str, Candidate], count: int
) -> dict[str, Allowance]:
    """By key of the fitted ``sizes``, what one more of the ``candidates`` would make of them; ``raw``: what these change per probe.

    As far as all is linear, and within what is plausible. The square of a shift counts by the probability that this effect is there
    (by BIC, Kass and Raftery 1995, if one of ``count`` candidates is expected to be): that of its expectation is what the mean over models
    adds to the variance of a size (Hoeting and others 1999, eq. 4). Of all candidates the largest counts, since many are alike.
    """
    found = dict.fromkeys((size.key for size in sizes), Allowance())
    rows, residual = fit.columns[[fit.keys.index(size.key) for size in sizes]], frame.flat(fit.residuals)
    normal = evidence.product(rows, rows) + np.diag(refit.precision(frame, sizes))
    right = -evidence.product(rows, residual)
    room = _room(fit, frame, sizes)
    alone = refit.solved(normal, right, room)
    for (name, _), columns in raw.items():
        more = [size for size in candidates[name].sizes if size.key in columns]
        own = frame.flats([columns[size.key] for size in more])
        across = evidence.product(rows, own)
        whole = np.block([[normal, across], [across.T, evidence.product(own, own)]])
        both = np.concatenate([right, -evidence.product(own, residual)])
        amounts = refit.solved(whole, both, np.concatenate([room, _room(fit, frame, more)]))
        gain = _loss(normal, right, alone) - _loss(whole, both, amounts)
        likely = expit(0.5 * (gain - len(more) * frame.price()) - np.log(count))
        for size, before, after in zip(sizes, alone, amounts):
            shift = float(np.sqrt(likely) * abs((after - before) * size.probe))
            if shift > found[size.key].shift:
                found[size.key] = Allowance(shift, name)
    return found


def _room(fit: Fit, frame: Frame, sizes: Sequence[Size]) -> np.ndarray:
    """Probes (size, 2) by which sizes may move from where they are: within bounds, one that is fitted of an effect as far as a fit may go."""
    free = {size.key for size in frame.experiment.free}
    bounds = np.array([refit.limits(size, refit.BEYOND if size.key in fit.keys and size.key not in free else 0.0) for size in sizes])
    return refit.room_of(fit.values, sizes, bounds)


def _loss(normal: np.ndarray, right: np.ndarray, amounts: np.ndarray) -> float:
    """White loss that amounts leave, less that without them."""
    return float(amounts @ normal @ amounts - 2.0 * right @ amounts)
