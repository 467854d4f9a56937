"""Bursts: what repeats differ by within moments is a driver's doing, or what one of them met and another did not, and no noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .experiment import Frame
from .floor import own_noises
from .judged import band

MOMENT = 0.5
"""s that are taken together: about what a shift of gear or the grip of a brake lasts."""

FEW = 0.05
"""Share of the time up to which what holds half of a floor are moments: noise has its half in more than a fifth of it, along rough roads, too,
shifts of gear in one or two hundredths."""


def time_share(series: Sequence[np.ndarray], rate: float) -> np.ndarray:
    """Least share of the time, in MOMENTs, that holds half of the power of series (channel, sample) at ``rate`` Hz, (channel,); nan of one
    without power, and of all where none lasts a MOMENT."""
    length = max(int(round(MOMENT * rate)), 1)
    whole = lambda part: part[:, : part.shape[1] // length * length]
    squares = [np.square(whole(part)).reshape(len(part), -1, length).sum(axis=2) for part in series]
    if not any(part.shape[1] for part in squares):
        return np.full(len(series[0]), np.nan)
    largest = -np.sort(-np.concatenate(squares, axis=1), axis=1)
    held = np.cumsum(largest, axis=1)
    count = 1 + np.sum(held < 0.5 * held[:, -1:], axis=1)
    return np.where(held[:, -1] > 0, count / largest.shape[1], np.nan)


def of_repeats(frame: Frame, residuals: Mapping[int, np.ndarray]) -> dict[str, float]:
    """By channel the ``time_share`` of what repeats among the records of a frame do not share, within their band: of the condition in which it
    is least. Empty without repeats."""
    channels = frame.experiment.channels
    found = []
    for record, parts in own_noises(frame.experiment, frame.all_cleaned({index: residuals[index] for index in frame.indices})):
        lower, upper = record.band
        lowest = np.maximum(lower, record.lowest or np.zeros(len(channels)))
        kept = [np.stack([band(row, record.rate, (least, upper)) for row, least in zip(part, lowest)]) for part in parts]
        found.append(time_share(kept, record.rate))
    return dict(zip(channels, np.fmin.reduce(found, axis=0).tolist())) if found else {}


def of_moments(share: Mapping[str, float]) -> list[str]:
    """The channels of which half of what repeats differ by lies within moments, by the ``time_share`` of each."""
    return [channel for channel, own in share.items() if 0.0 < own <= FEW]


def words(share: Mapping[str, float]) -> list[str]:
    """What is to be said of floors that moments make, by the ``time_share`` of each channel: one sentence, or none."""
    channels = of_moments(share)
    if not channels:
        return []
    within = 100 * max(share[channel] for channel in channels)
    return [
        f"half of what repeats differ by in {', '.join(channels)} lies within {max(within, 0.1):.1f} % of the time: what a driver does there "
        "(a shift of gear, a brake), or what one drive met and another did not, stands in the floor as if it were noise"
    ]
