"""What is kept of a fit of the vehicle (calibration.nc), and what is to be said of it in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from . import identifiability
from .descent import Descent
from .drive.replay import CLOCK_LEFT
from .problem import Problem
from .vehicle.parameters import PARAMETERS

DISAGREE = 0.01
"""Relative difference of cost from which on two fits are different ones, and which is said."""

AGREE = "agree"
"""What is said of starts none of which led nowhere, and two of which at least found the best."""

NEAR = 1e-12
"""Share of the way between its bounds by which a parameter may miss one and be there."""


def dataset(task, start, chosen, in_sequence, steps: Mapping[str, Descent], knowledge) -> xr.Dataset:
    """The Dataset of calibration.nc (``calibrate.calibrate``) but for units, words, profiles and restarts.

    Of a ``task`` (``Problem``) from its point ``start``: with the ``chosen`` point, the one that the ``steps`` one after the other led to,
    ``in_sequence``, and what is known at the chosen one (``identifiability.Knowledge``).
    """
    names = list(task.parameters)
    width = task.upper - task.lower
    bound = np.round(chosen)
    value = task.values(np.where(np.abs(chosen - bound) < NEAR, bound, chosen))
    verdicts = [identifiability.verdict(place, size) for place, size in zip(chosen, knowledge.half_width)]
    left_over = task.left_over(chosen)
    half = np.minimum(knowledge.half_width, 1.0) * width
    deviation = np.sqrt(np.diag(knowledge.covariance))
    with np.errstate(invalid="ignore"):
        correlation = knowledge.covariance / np.outer(deviation, deviation)
    path = [(label, point, cost) for label, step in steps.items() for point, cost in step.path]
    return xr.Dataset(
        {
            "value": ("parameter", value),
            "initial": ("parameter", task.values(start)),
            "lower": ("parameter", task.lower),
            "upper": ("parameter", task.upper),
            "interval_lower": ("parameter", np.maximum(value - half, task.lower)),
            "interval_upper": ("parameter", np.minimum(value + half, task.upper)),
            "value_sequence": ("parameter", task.values(in_sequence)),
            "verdict": ("parameter", np.array(verdicts)),
            "correlation": (("parameter", "other"), correlation, {"units": "1", "long_name": "correlation of the estimates of two parameters"}),
            "signal_share": (("parameter", "signal"), knowledge.information),
            "singular_value": ("rank", knowledge.singular_values),
            "cost": ("step", np.array([step.cost for step in steps.values()])),
            "iterations": ("step", np.array([max(len(step.path) - 1, 0) for step in steps.values()])),
            "evaluations": ("step", np.array([step.evaluations for step in steps.values()])),
            "stopped": ("step", np.array([step.stopped for step in steps.values()])),
            "step_value": (("step", "parameter"), np.stack([task.values(step.point) for step in steps.values()])),
            "step_nrmse": (("step", "drive", "signal"), np.stack([step.nrmse for step in steps.values()])),
            "initial_nrmse": (("drive", "signal"), task.nrmse(start)),
            "clock_correction": ("drive", left_over[:, 0], {"units": "s"}),
            "path_correction": ("drive", left_over[:, 1], {"units": "m"}),
            "iteration_step": ("iteration", np.array([label for label, _, _ in path])),
            "iteration_cost": ("iteration", np.array([cost for _, _, cost in path])),
            "iteration_value": (("iteration", "parameter"), np.array([task.values(point) for _, point, _ in path]).reshape(-1, len(names))),
        },
        {
            "parameter": names,
            "other": names,
            "signal": list(task.signals),
            "step": list(steps),
            "drive": [again.drive.attrs["name"] for again in task.replays],
        },
    )


def unit(name: str, units: Mapping[str, str]) -> str:
    """Unit of a parameter of the vehicle, or of an effect as ``units`` have it."""
    return PARAMETERS[name].unit if name in PARAMETERS else units.get(name, "")


def clipped(task: Problem, nominal: Mapping[str, float]) -> list[str]:
    """A sentence on every parameter that the vehicle's file has outside of its bounds."""
    return [
        f"{name} is {nominal[name]:g} in the vehicle's file, outside of its bounds {lower:g} to {upper:g}"
        for name, lower, upper in zip(task.parameters, task.lower, task.upper)
        if not lower <= nominal[name] <= upper
    ]


def of_clocks(result: xr.Dataset) -> list[str]:
    """What is to be said of drives whose clock would go farther than it may."""
    eager = result["drive"].values[np.abs(result["clock_correction"].values) >= CLOCK_LEFT]
    said = f"the clock of {', '.join(eager)} would move by more than the {1e3 * CLOCK_LEFT:g} ms it is trusted to: "
    lacks = "the model lacks something (mostly a delay, a damping or friction), or s is the distance of another point of the vehicle (alignment.md)"
    if any("." in name for name in result["parameter"].values.tolist()):
        lacks += (
            ", or alignment, which knows effects at the sizes of a rough fit, took some of their delay for one of the clock: then a part of the error stays, "
            "and the sizes of a verdict are nearer"
        )
    return [said + lacks] if eager.size else []


def of_starts(task: Problem, fits: Sequence[Descent], best: Descent, refused: Sequence[str]) -> tuple[list[str], list[str]]:
    """What is to be said of starts that failed or ended elsewhere, and which of that leaves open whether the best fit was found."""
    said, in_doubt = [], []
    if len(fits) + len(refused) == 1:
        in_doubt.append("one start only: nothing tells whether another would end lower (calibration: restarts)")
    if refused:
        said.append(f"{len(refused)} of {len(refused) + len(fits)} starts led to a vehicle that does not drive ({refused[0]})")
        in_doubt += said
    worst = max(fits, key=lambda fit: fit.cost)
    above = worst.cost / best.cost - 1
    if above > DISAGREE:
        most = int(np.argmax(np.abs(worst.point - best.point)))
        ends = [f"{task.values(fit.point)[most]:.4g}" for fit in (worst, best)]
        cost = f"a cost {100 * above:.1f} % above the best" if above < 1.0 else f"{1.0 + above:.3g} times the cost of the best"
        differ = f"the worst of {len(fits)} ends at {cost}, which is taken; they differ most in {task.parameters[most]}, {ends[0]} against {ends[1]}"
        together = sum(fit.cost < best.cost * (1 + DISAGREE) for fit in fits)
        if together > 1:
            said.append(f"{together} of {len(fits)} starts end at the best, {differ}")
        else:
            said.append(f"starts disagree: {differ}; more of them (calibration: restarts) may find a better one")
            in_doubt += said[-1:]
    return said, in_doubt
