"""Fits of parameters and sizes of effects together in the white frame, and how two fits compare."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear
from scipy.stats import norm
from scipy.stats import t as student

from ..errors import InputError
from . import event, evidence, spectrum
from ..identifiability import AT_BOUND, CONFIDENCE
from . import experiment as exp
from .experiment import Experiment, Frame, Size

BEYOND = 0.5
"""Share of the plausible range that a fit may go beyond it, to see that it wants to."""

WORTHWHILE = 1.0
"""Fall of the white loss, or gain in 2 ln L, below which a further step is not worth a simulation."""

SHORTEST = 0.1
"""Share of its length below which a step is not shortened."""

SAME_GAIN = 0.05
"""Relative difference of the gains in long and in short steps up to which a fit in long steps is taken: its sizes are nearly the best then."""

RENEWAL = 0.3
"""Probes that a size must have moved for its column to be made anew."""

LEAST_BLOCKS = 8.0
"""Blocks that the difference of two fits must be spread over (participation number) for its z to be that over blocks."""



@dataclass(frozen=True)
class Fit:
    """Where a fit ended: ``values``, ``residuals`` by record, ``keys`` fitted with white ``columns`` per probe, white ``loss``."""

    values: dict[str, float]
    residuals: dict[int, np.ndarray]
    keys: tuple[str, ...]
    columns: np.ndarray
    loss: float


def limits(size: Size, beyond: float = 0.0) -> tuple[float, float]:
    """Bounds of a fit: what is plausible, and ``beyond`` of its width more at ends that are not the neutral value of a size."""
    width = 0.0 if size.shaping else beyond * (size.upper - size.lower)
    lower = size.lower if size.lower == size.neutral else size.lower - width
    upper = size.upper if size.upper == size.neutral else size.upper + width
    return lower, upper


def refit(
    experiment: Experiment,
    frame: Frame,
    values: Mapping[str, float],
    sizes: Sequence[Size],
    columns: Mapping[str, np.ndarray],
    *,
    renewed: Sequence[str] = (),
    iterations: int = 4,
    residuals: Mapping[int, np.ndarray] | None = None,
    beyond: float = BEYOND,
    tolerance: float = 2e-4,
    halved: bool = True,
) -> Fit:
    """Gauss-Newton within bounds for ``sizes`` from ``values``, in the white frame.

    ``columns``: white change per probe of each key at the start; those of ``renewed`` are made anew, as secants, after
    every step. ``residuals``: those at the start, where they are known. ``beyond``: share of an effect's
    plausible range that its size may go beyond it. A step that does not lower the loss is shortened to where a parabola through
    it has its least, one that cannot be simulated is ``halved``, or raises InputError or ValueError.
    """
    free = {size.key for size in experiment.free}
    values = dict(values)
    residuals = exp.simulate(experiment, values, frame.indices) if residuals is None else residuals
    flat = frame.flat(residuals)
    loss = float(flat @ flat)
    matrix = np.stack([columns[size.key] for size in sizes])
    for _ in range(iterations):
        bounds = np.array([limits(size, 0.0 if size.key in free else beyond) for size in sizes])
        step = _step(matrix, flat, room_of(values, sizes, bounds))
        improved = False
        for _ in range(4):
            trial = _moved(values, sizes, bounds, step)
            try:
                found = exp.simulate(experiment, trial, frame.indices)
            except (InputError, ValueError):
                if not halved:
                    raise
                step = step / 2
                continue
            flat_trial = frame.flat(found)
            rise = float(flat_trial @ flat_trial) - loss
            if rise < 0:
                improved = True
                break
            slope = 2.0 * float(flat @ (step @ matrix))
            shorter = -0.5 * slope / (rise - slope) if slope < 0 else 0.0
            if -0.5 * shorter * slope < WORTHWHILE:
                break
            step = max(shorter, SHORTEST) * step
        if not improved:
            break
        gained = loss - float(flat_trial @ flat_trial)
        values, residuals, flat, loss = trial, found, flat_trial, float(flat_trial @ flat_trial)
        for k, size in enumerate(sizes):
            if size.key in renewed and abs(step[k]) > RENEWAL:
                matrix[k] = _renewed(experiment, frame, values, residuals, size, matrix[k])
        if gained < tolerance * loss:
            break
    return Fit(values, residuals, tuple(size.key for size in sizes), matrix, loss)


def refit_sooner(
    experiment: Experiment, sooner: Experiment, frame: Frame, values: Mapping[str, float], sizes: Sequence[Size],
    columns: Mapping[str, np.ndarray], *, residuals: Mapping[int, np.ndarray], **settings,
) -> Fit:  # fmt: skip
    """``refit`` in the longer steps of ``sooner`` (``probe.coarsely`` at these values), told in the experiment's own; fitted on in these where
    the gain is another there, and in these alone where the model cannot be driven in the longer ones."""
    if sooner is experiment:
        return refit(experiment, frame, values, sizes, columns, residuals=residuals, **settings)
    try:
        found = refit(sooner, frame, values, sizes, columns, residuals=residuals, halved=False, **settings)
        own = exp.simulate(experiment, found.values, frame.indices)
    except (InputError, ValueError):
        return refit(experiment, frame, values, sizes, columns, residuals=residuals, **settings)
    before, loss = (float(np.sum(frame.flat(parts) ** 2)) for parts in (residuals, own))
    if abs(loss - found.loss) < WORTHWHILE + SAME_GAIN * (before - found.loss):
        return replace(found, residuals=own, loss=loss)
    if loss < before:
        values, residuals, columns = found.values, own, dict(zip(found.keys, found.columns))
    return refit(experiment, frame, values, sizes, columns, residuals=residuals, **settings)


def stepped(values: Mapping[str, float], sizes: Sequence[Size], matrix: np.ndarray, flat: np.ndarray) -> tuple[dict[str, float], float]:
    """``values`` with these sizes moved to where the rows of ``matrix`` (white change per probe) foresee the least, within their bounds, and the
    fall of the white loss that they foresee."""
    bounds = np.array([limits(size) for size in sizes])
    step = _step(matrix, flat, room_of(values, sizes, bounds))
    left = flat + step @ matrix
    return _moved(values, sizes, bounds, step), float(flat @ flat - left @ left)


def _now(values: Mapping[str, float], sizes: Sequence[Size]) -> tuple[np.ndarray, np.ndarray]:
    """Values of ``sizes``, and their probes."""
    return np.array([values.get(size.key, size.neutral) for size in sizes]), np.array([size.probe for size in sizes])


def room_of(values: Mapping[str, float], sizes: Sequence[Size], bounds: np.ndarray) -> np.ndarray:
    """Probes (size, 2) by which ``sizes`` may move down and up within ``bounds`` (size, 2)."""
    now, probe = _now(values, sizes)
    return np.sort((bounds - now[:, None]) / probe[:, None], axis=1) + np.array([-1e-9, 1e-9])


def _moved(values: Mapping[str, float], sizes: Sequence[Size], bounds: np.ndarray, step: np.ndarray) -> dict[str, float]:
    """``values`` with ``sizes`` moved by a ``step`` (probes), no farther out than ``bounds`` or where they are."""
    now, probe = _now(values, sizes)
    reached = np.clip(now + step * probe, np.minimum(now, bounds[:, 0]), np.maximum(now, bounds[:, 1]))
    return {**values, **{size.key: float(value) for size, value in zip(sizes, reached)}}


def _step(matrix: np.ndarray, flat: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Amounts of the rows of ``matrix`` within ``room`` (row, 2) that bring ``flat`` nearest to nothing.

    On the normal equations: rows are long and few.
    """
    return solved(evidence.product(matrix, matrix), -evidence.product(matrix, flat), room)


def solved(normal: np.ndarray, right: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Amounts (row,) within ``room`` (row, 2) that solve these normal equations as well as can be."""
    power = np.sqrt(np.diag(normal))
    power = np.where(power > 0, power, 1.0)
    root, inverse = evidence.square_root(normal / np.outer(power, power))
    return lsq_linear(root, inverse @ (right / power), (room[:, 0] * power, room[:, 1] * power)).x / power


def _renewed(experiment, frame, values, residuals, size: Size, before: np.ndarray) -> np.ndarray:
    inside = (values[size.key] + size.probe - size.lower) * (size.upper - values[size.key] - size.probe) >= 0
    try:
        column = exp.secant(experiment, values, residuals, size, 1.0 if inside else -0.5)
    except (InputError, ValueError):
        return before
    return frame.flat(column)


def covariance(
    fit: Fit, frame: Frame, keys: Sequence[str], groups: np.ndarray, lost: int, known: np.ndarray | float = 0.0
) -> tuple[np.ndarray, int]:
    """Covariance of the fitted sizes ``keys`` in probes, the others held, and the number of groups it rests on, as of ``clustered``."""
    columns = fit.columns[[fit.keys.index(key) for key in keys]]
    known = np.diag(np.broadcast_to(known, len(keys)))
    bread = np.linalg.pinv(evidence.product(columns, columns) + known, rcond=1e-10, hermitian=True)
    return clustered(bread, columns, frame.flat(fit.residuals), numbered(groups), lost, known)


def both_ways(
    fit: Fit, frame: Frame, keys: Sequence[str], known: np.ndarray | float = 0.0
) -> tuple[tuple[np.ndarray, int], tuple[np.ndarray, int]]:
    """``covariance`` over places, and what depends along drives adds to it, each with its number of groups; nil where one drive was fitted. Together
    they are clustered both ways (Cameron, Gelbach and Miller 2011, eq. 2.8)."""
    place, drive = frame.blocks(), frame.drives()
    over_places = covariance(fit, frame, keys, place, len(keys), known)
    along, drives = covariance(fit, frame, keys, drive, 1, known)
    if drives < 2:
        return over_places, (np.zeros_like(along), drives)
    return over_places, (along - covariance(fit, frame, keys, place * (drive.max() + 1) + drive, 1, known)[0], drives)


def numbered(groups: np.ndarray) -> np.ndarray:
    """Groups (element,) numbered from 0 on, which takes longer than what is done with them."""
    return np.unique(groups, return_inverse=True)[1]


def clustered(
    bread: np.ndarray, rows: np.ndarray, residual: np.ndarray, numbers: np.ndarray, lost: int, known: np.ndarray
) -> tuple[np.ndarray, int]:
    """Covariance (size, size) of sizes whose columns are ``rows`` (size, element), and the number of groups it rests on.

    Sandwich estimator: errors of one group, whose ``numbers`` (element,) are ``numbered``, may depend on one another in any way (Cameron and
    Miller 2015, eq. 11).
    ``bread``: inverse of the products of the rows and what is ``known`` (size, size), the precision of what is known of the sizes
    beforehand. ``lost``: groups that the fit has used up.
    """
    sums = np.stack([np.bincount(numbers, row * residual) for row in rows])
    used = int(np.sum(np.any(sums != 0, axis=0)))
    factor = used / max(used - lost, 1)
    return bread @ (factor * sums @ sums.T + known) @ bread, used


def intervals(fit: Fit, frame: Frame, sizes: Sequence[Size], held: bool = False, wider: float = 1.0) -> dict[str, tuple[float, float]]:
    """90 % intervals of fitted sizes in their units, by key.

    Errors depend on one another where drives come by the same place, and all along a drive, whose path, clock and mounting
    are its own: clustered both ways (Cameron, Gelbach and Miller 2011, eq. 2.8), degrees of freedom by Satterthwaite (1946).
    A size of an effect that ended at a bound is held there for the intervals of the others. A parameter of the vehicle at its bound stays
    free: something else may have driven it there, so that its whole range counts as possible. ``held``: it is held, too, which suits
    the question whether a size is there at all. ``wider``: times by which errors are larger than these drives show. A size that changes
    nothing on them may be anything within its bounds, as any may where there is one block only: nothing tells by how much another would differ.
    """
    free = {size.key for size in frame.experiment.free}
    moving = [size for size in sizes if (size.key in free and not held) or is_within(size, fit.values)]
    found = _intervals(fit, frame, moving, wider) if moving else {}
    for size in sizes:
        if size not in moving:
            found |= {size.key: _intervals(fit, frame, [*moving, size], wider)[size.key]}
    return {size.key: found[size.key] for size in sizes}


def is_within(size: Size, values: Mapping[str, float]) -> bool:
    """Whether a size can still move both ways; one at its bound takes nothing up any more."""
    room = AT_BOUND * (size.upper - size.lower)
    return not min(abs(values.get(size.key, size.neutral) - end) for end in (size.lower, size.upper)) <= room


def _intervals(fit: Fit, frame: Frame, sizes: Sequence[Size], wider: float) -> dict[str, tuple[float, float]]:
    keys = [size.key for size in sizes]
    (own, places), (along, drives) = both_ways(fit, frame, keys, precision(frame, sizes))
    found = {}
    for k, size in enumerate(sizes):
        parts = own[k, k], max(along[k, k], 0.0)
        freedom = 1.0
        if sum(parts) > 0:
            freedom = sum(parts) ** 2 / (parts[0] ** 2 / max(places - len(keys), 1) + parts[1] ** 2 / max(drives - 1, 1))
        half = wider * student.ppf(0.5 + CONFIDENCE / 2, freedom) * np.sqrt(sum(parts)) * abs(size.probe)
        value, is_met = fit.values[size.key], np.any(fit.columns[fit.keys.index(size.key)])
        found[size.key] = (value - half, value + half) if is_met and places > 1 else (size.lower, size.upper)
    return found


def precision(frame: Frame, sizes: Sequence[Size]) -> np.ndarray:
    """Per probe, (size,), what is known beforehand of parameters and of what shapes an effect: that they lie within their bounds."""
    free = {size.key for size in frame.experiment.free}
    return np.array(
        [12.0 * (size.probe / (size.upper - size.lower)) ** 2 if size.key in free or size.shaping else 0.0 for size in sizes]
    )


def information(frame: Frame, residuals: Mapping[int, np.ndarray]) -> float:
    """Twice the log-likelihood of Gaussian errors whose spectra are those of the residuals themselves (Whittle 1953).

    Larger is better; it needs no spectrum known beforehand, so that it compares models whose errors differ in colour.
    """
    cleaned = {index: part / frame.whitening[index].scale for index, part in frame.all_cleaned(residuals).items()}
    found = exp.condition_spectra(frame.experiment, cleaned)
    total = 0.0
    for index in frame.indices:
        record = frame.experiment.records[index]
        seconds = residuals[index].shape[1] / record.rate
        total -= 2 * seconds * (record.band[1] - record.band[0]) * found[record.condition].log_determinant(record.band)
    return total


def advantage(frame: Frame, one: Mapping[int, np.ndarray], other: Mapping[int, np.ndarray]) -> tuple[float, float]:
    """How much better ``one`` fits than ``other``: fall of the white loss, and its z over blocks (Vuong 1989).

    Both are made white by the mean of their spectra, so that neither is favoured. Where they differ at a few
    places only, the z is that of an error there which looks like the difference (``event``).
    """
    cleaned = [frame.all_cleaned(part) for part in (one, other)]
    spectra = [exp.condition_spectra(frame.experiment, part) for part in cleaned]

    def white(index: int) -> np.ndarray:
        record = frame.experiment.records[index]
        mean = (spectra[0][record.condition] + spectra[1][record.condition]) * 0.5
        whitening = spectrum.Whitening(mean, record.rate, record.band, frame.whitening[index].scale)
        return whitening(np.stack([own[index] for own in cleaned])).reshape(2, -1)

    better, worse = np.concatenate(list(frame.experiment.each_record(white, frame.indices)), axis=1)
    sums = np.bincount(np.unique(frame.blocks(), return_inverse=True)[1], worse**2 - better**2)
    sums = sums[sums != 0]
    fall = float(sums.sum())
    change = (better - worse)[None]
    if fall > 0 and event.participation(change, frame.blocks())[0] < LEAST_BLOCKS:
        return fall, float(norm.isf(event.p_values(frame, worse, change, np.zeros(1, int), np.ones(1))[0][0]))
    spread = np.sqrt(np.sum((sums - sums.mean()) ** 2)) if sums.size > 1 else np.inf
    return fall, float(fall / spread) if spread > 0 else 0.0
