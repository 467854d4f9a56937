"""Which candidates the fitted drives speak for: the score test over the whole library, with decoys beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from . import event, evidence
from .evidence import Evidence
from .experiment import Candidate, Frame
from .probe import Job, Raw

LEVEL = 0.05
"""Probability of a false alarm over the whole library."""

SURE, CERTAIN = 0.005, 0.002
"""p-values over the whole library at which the fitted drives are sure, and at which they leave no doubt: hardly a draw comes near."""

DECOYS, DRAW = 6, 9
"""Columns with the spectrum of a candidate and random phases that must never rank, and the number of their draw beside those of the test."""

HELD_OUT_Z = 2.0
"""z of the improvement of held-out drives that what is proposed must reach."""

DECOY_LEVEL = 0.005
"""p-value at which a decoy ranks, where another is significant, too; one alone would do so by chance now and then."""

OPPOSITE = 4.0
"""z from which on the drives speak for a negative size where only a positive one is physical: a hint, not a finding."""

BY_BLOCKS, BY_SHAPE = 1.5, 3.0
"""Factors of the p-values: three forms of the test are tried, two of which ``evidence`` has accounted for."""


@dataclass(frozen=True)
class Proposal:
    """The evidence by candidate: ``p_value`` over the whole library, ``gain`` (fall of the white loss) and ``absorbed`` (share
    that is free anyway) in the best shape, ``best``.

    ``columns``: what is projected of every column, by ((candidate, shape), key), ``residual``: and of the residual. ``rare``: names that act at few places.
    """

    names: tuple[str, ...]
    p_value: np.ndarray
    gain: np.ndarray
    absorbed: np.ndarray
    best: dict[str, Job]
    columns: dict[tuple[Job, str], np.ndarray]
    residual: np.ndarray
    rare: frozenset[str]
    opposite: frozenset[str]
    """Names for a negative size of which the drives speak, where only a positive one is physical."""
    decoy_p_value: float
    decoy_ranks: bool
    foreseen: Mapping[str, float] = field(default_factory=dict)
    """Gain that is foreseen of typical sizes, by name, as far as that was asked (``foresight``)."""

    def certain(self) -> frozenset[str]:
        """Names that leave no doubt."""
        return frozenset(name for name, p_value in zip(self.names, self.p_value) if p_value <= CERTAIN)

    def significant(self, most: int) -> list[str]:
        """Names that are significant over the library, those with the largest gains, by small sizes or foreseen, at most ``most``."""
        gains = (max(gain, self.foreseen.get(name, 0.0)) for name, gain in zip(self.names, self.gain))
        order = sorted(zip((-gain for gain in gains), self.names, self.p_value))
        return [name for _, name, p_value in order if p_value <= LEVEL][:most]


def propose(
    frame: Frame, residuals: Mapping[int, np.ndarray], free: np.ndarray, columns: Mapping[Job, Raw],
    candidates: Mapping[str, Candidate], seed: Sequence[int], known: Mapping[str, float] = {},
) -> Proposal:  # fmt: skip
    """Test ``columns`` on the white residuals of the fitted records; ``free``: white directions that are fitted anyway. ``known``:
    p-values by name of what another test has found, of all candidates like these.

    All sizes of a candidate in one shape count together and each alone, two that may be of either sign against one another as well.
    """
    rows, group, sign, labels = [], [], [], []
    white = iter(frame.flats([column for own in columns.values() for column in own.values()]))
    for number, (job, own) in enumerate(columns.items()):
        parts, keys = [next(white) for _ in own], list(own)
        signs = [int(size.is_one_sided) for size in candidates[job[0]].sizes if size.key in own]
        if len(parts) > 1:
            if len(parts) == 2 and not any(signs):  # such as front and rear, which may well be of opposite signs
                parts, signs, keys = [*parts, parts[0] - parts[1]], [*signs, 0], [*keys, "apart"]
            parts, signs, keys = [*parts, sum(parts[: len(own)])], [*signs, int(any(signs))], [*keys, "all"]
        rows += parts
        sign += signs
        group += [number] * len(parts)
        labels += [(job, key) for key in keys]
    decoys = _decoys(frame, list(columns.values()), np.random.default_rng([*seed, DRAW]))
    group += range(len(columns), len(columns) + DECOYS)
    sign += [0] * DECOYS
    found = evidence.score_test(
        frame.flat(residuals), free, np.stack([*rows, *decoys]), [frame.blocks(), frame.blocks(event.FINER)],
        group=group, sign=sign, seed=seed,
    )  # fmt: skip
    by_shape, rare = event.p_values(frame, found.residual, found.projected, np.array(group), np.array(sign))
    p_value = np.minimum(np.minimum(BY_BLOCKS * found.p_value, BY_SHAPE * by_shape), 1.0)
    p_value = np.maximum(p_value, found.white_p_value)
    jobs = list(columns)
    names = tuple(dict.fromkeys(name for name, _ in jobs))
    own = {name: [g for g, job in enumerate(jobs) if job[0] == name] for name in names}
    best = {name: max(own[name], key=lambda g: found.group_gain[g]) for name in names}
    return Proposal(
        names=names,
        p_value=np.array([min(p_value[own[name]].min(), known.get(name, 1.0)) for name in names]),
        gain=np.array([found.group_gain[best[name]] for name in names]),
        absorbed=np.array([min(found.absorbed[k] for k in range(len(labels)) if group[k] == best[name]) for name in names]),
        best={name: jobs[g] for name, g in best.items()},
        columns={label: found.projected[k] for k, label in enumerate(labels)},
        residual=found.residual,
        rare=frozenset(job[0] for job, is_rare in zip(jobs, rare) if is_rare),
        opposite=frozenset(
            jobs[g][0] for g, own, statistic in zip(group, sign, found.statistic) if g in best.values() and own > 0 and statistic < -OPPOSITE
        ),
        decoy_p_value=float(found.p_value[len(jobs) :].min()),
        decoy_ranks=_decoy_ranks(found, len(jobs)),
    )


def _decoys(frame: Frame, columns: Sequence[Raw], rng: np.random.Generator) -> np.ndarray:
    rows = []
    for _ in range(DECOYS):
        column = next(iter(columns[rng.integers(len(columns))].values()))
        state = rng.integers(2**31)
        rows.append({i: evidence.phase_randomised(part, np.random.default_rng(state)) for i, part in column.items()})
    return frame.flats(rows)


def _decoy_ranks(found: Evidence, candidates: int) -> bool:
    p_values = np.sort(found.p_value[candidates:])
    ranks = found.group_gain[candidates:].max() > found.group_gain[:candidates].max(initial=0.0)
    return bool(ranks and p_values[0] <= DECOY_LEVEL and p_values[1] <= LEVEL)
