"""Calibration of the vehicle on measured drives: the five steps of the paper, and all parameters at once.

The residuals are simulated minus measured signals (eq:nonlinlsq), every signal
divided by its measured range and by the root of its length, so that the sum of
squares is the sum of NRMSE^2 over the signals, averaged over the drives. They are
minimised within bounds (eq:opti) by the trust-region reflective method of scipy
("trf": the damped Gauss-Newton steps of Levenberg and Marquardt, their damping set by
a trust region that bends at the bounds; MINPACK's own "lm" knows no bounds).

What alignment may have left of every drive's clock, path, speed and mounting (``drive.leftover``) is
projected out of the residuals, about a first rough fit. A driver's foot is heard where the accelerometer tells it (``drive.pedals``), by
every vehicle anew: springs would make up for braking that the model has not done. The clock no further than ``replay.CLOCK_LEFT``: a damping
would be fitted to a delay, or a delay to a damping. The intervals are those of a jackknife over stretches of the road
(``identifiability.assess``); what alignment left moves them as far as it moves the fit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from scipy.stats import qmc

from . import fitrecord, identifiability, pool
from . import simulate as simulator
from .descent import Descent, descend
from .drive import pedals
from .drive.record import completed
from .drive.replay import replay
from .errors import InputError, hint
from .problem import Problem
from .vehicle.parameters import PARAMETERS
from .vocabulary import SIGNALS

BOUNDS = {
    "spring_stiffness_front": (15000.0, 40000.0),
    "spring_stiffness_rear": (15000.0, 40000.0),
    "tyre_friction": (0.7, 1.4),
    "tyre_radial_stiffness": (250000.0, 400000.0),
    "tyre_radial_damping": (4000.0, 7000.0),
}
"""tab:constraints, SI."""

COARSE = 1e-3
"""Tolerance of a search from a random start; one that ends below the best is carried on with the full tolerance."""

EQUAL = 1e-4
"""Relative difference of cost within which two fits are equally good; the first of them stays, the nearest to the
nominal vehicle where the data are silent."""

PROFILE_PLACES = 9
"""Places of a profile of the cost."""

BLOCK = 2.0
"""s; residuals at places farther apart than this at the mean speed are independent in the intervals."""


def problem(
    drives: xr.Dataset | Sequence[xr.Dataset],
    road,
    vehicle,
    *,
    simulate: Callable[..., xr.Dataset] = simulator.run,
    parameters: Sequence[str] = tuple(BOUNDS),
    bounds: Mapping[str, Sequence[float]] | None = None,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    signals: Sequence[str] = SIGNALS,
    options: Mapping | None = None,
    scales: Sequence[float] | None = None,
    workers: int = 1,
) -> Problem:
    """The problem of fitting the drives whose role is "fit"; arguments as for ``calibrate``, ``scales`` as for ``Problem``."""
    drives = completed(drives)
    roads = list(road) if isinstance(road, (list, tuple)) else [road] * len(drives)
    each = pool.side_by_side(workers)
    fitted = [pair for pair in zip(drives, roads, strict=True) if pair[0].attrs.get("role", "fit") == "fit"]
    replays = list(each(lambda pair: pedals.listening(replay(*pair, simulate, options=options), vehicle, effects or {}).replay, fitted))
    if not replays:
        raise InputError("no drive has the role 'fit' (expected at least one)", place="drives")
    for name in signals:
        if name not in SIGNALS:
            raise InputError(f"unknown signal {name!r} (expected of {', '.join(SIGNALS)})", place="signals")
    bounds = _bounds(vehicle, parameters, bounds or {})
    for name, (lower, upper) in bounds.items():
        if not (np.isfinite([lower, upper]).all() and lower < upper):
            raise InputError(f"bounds {lower:g} to {upper:g} (expected lower < upper)", place=name)
    lower, upper = np.array(list(bounds.values()), dtype=float).T
    return Problem(replays, vehicle, tuple(bounds), lower, upper, effects or {}, tuple(signals), scales=scales, each=each)


def calibrate(
    drives: xr.Dataset | Sequence[xr.Dataset],
    road,
    vehicle,
    *,
    simulate: Callable[..., xr.Dataset] = simulator.run,
    parameters: Sequence[str] = tuple(BOUNDS),
    bounds: Mapping[str, Sequence[float]] | None = None,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    units: Mapping[str, str] | None = None,
    signals: Sequence[str] = SIGNALS,
    applied: str = "joint",
    sequence: bool = True,
    start: Sequence[Mapping[str, float]] = (),
    below: Mapping[str, float] | None = None,
    restarts: int = 2,
    tolerance: float = 1e-4,
    seed: int = 0,
    profiles: Sequence[str] = (),
    options: Mapping | None = None,
    workers: int = 1,
) -> xr.Dataset:
    """Parameters of the vehicle, and of its effects, that bring the model closest to the aligned drives.

    ``drives`` are aligned (``drive.align``), those of role "check" are left out; ``road`` is one (prepared
    or not) or a list of one per drive; ``simulate`` has the signature of ``simulate.run``. ``parameters`` of the vehicle
    are calibrated in this order, by default the five of the paper. ``bounds`` widen or narrow
    tab:constraints and add parameters of effects as "effect.parameter" (SI), whose ``units`` may be named; other
    parameters of the vehicle without bounds lie between half and twice their nominal value, as far as plausible.
    ``effects`` holds their start and what is not fitted of them. The start is the nominal
    vehicle, clipped into the bounds, with the values of the first of ``start``, mappings of parameter to value in SI units.
    OP_1, OP_2 and so on fit one parameter after the other (fig:optichain), an effect's after them; the joint fit starts where
    they end, from the further ones of ``start`` and from ``restarts`` random points (restart_cost, restart_value).
    ``below`` are the values (SI) of the calibrated model with fewer effects (``values_below``): a further start, which keeps the joint fit
    with an effect from ending above the one without it where all others go astray.
    ``applied`` says whose values are ``value``: "joint" (default) or "sequence", as in the paper; without
    ``sequence`` there is the joint fit alone and value_sequence is NaN. ``profiles`` names parameters whose profile of the cost is wanted.
    Drives are simulated side by side on so many cores as there are ``workers``, which changes nothing else.

    Returns the Dataset of calibration.nc: over ``parameter`` value, initial, lower, upper, unit,
    interval_lower/upper (90 %), value_sequence, verdict and signal_share(parameter, signal);
    over ``step`` cost, iterations, evaluations, step_value, step_nrmse, stopped; over ``iteration`` the way there.
    Where asked for, over ``profile`` and ``place``: profile_value and profile_cost, the least cost with the parameter held
    there, up to twice its interval to either side. Attributes: stopping rule, remarks in words, and of these what
    leaves open whether the best of the ``starts`` is the best there is (``fitrecord.AGREE`` where nothing does), and what of the ``driver`` is heard by the
    accelerometer (``drive.pedals``), empty where nothing is. Raises InputError.
    """
    if applied not in ("joint", "sequence"):
        raise InputError(f"{applied!r} (expected joint or sequence)", place="applied")
    if applied == "sequence" and not sequence:
        raise InputError("sequence, which is left out (expected joint)", place="applied")
    task = problem(
        drives, road, vehicle, simulate=simulate, parameters=parameters, bounds=bounds, effects=effects, signals=signals,
        options=options, workers=workers,
    )  # fmt: skip
    unknown = [name for name in profiles if name not in task.parameters]
    if unknown:
        raise InputError(f"{unknown[0]!r} is not calibrated (expected of {', '.join(task.parameters)})", place="profiles")
    nominal = {name: _nominal(vehicle, effects or {}, name) for name in task.parameters}
    starts = [_started(task, nominal, given) for given in start or [{}]]
    everything = list(range(len(task.parameters)))
    further = starts[1:] if below is None else [task.point([{**nominal, **below}[name] for name in nominal]), *starts[1:]]
    first = descend(task, starts[0], everything, COARSE)
    if below is not None:
        # What alignment left is seen from the better of two rough fits: about one that went astray no other is good.
        rough, _ = _from_elsewhere(task, first, further[:1], COARSE)
        first = rough[_least(rough)]
    task = task.about(first.point)
    steps, columns = _one_after_the_other(task, starts[0], tolerance) if sequence else ({}, None)
    in_sequence = list(steps.values())[-1].point if sequence else np.full_like(first.point, np.nan)
    best = descend(task, in_sequence if sequence else first.point, everything, tolerance, known=columns, exact=True)
    random = qmc.LatinHypercube(len(everything), rng=np.random.default_rng(seed)).random(restarts)
    fits, refused = _from_elsewhere(task, best, [*further, *random], tolerance)
    best = fits[_least(fits)]
    chosen = best.point if applied == "joint" else in_sequence
    jacobian = best.jacobian if applied == "joint" else task.jacobian(chosen, everything)
    knowledge = _assess(task, chosen, jacobian)
    result = fitrecord.dataset(task, starts[0], chosen, in_sequence, {**steps, "joint": best}, knowledge)
    if profiles:
        result = result.merge(_profiles(task, chosen, knowledge, profiles))
    result["restart_cost"] = "restart", np.array([fit.cost for fit in fits])
    result["restart_value"] = ("restart", "parameter"), np.stack([task.values(fit.point) for fit in fits])
    result["unit"] = "parameter", np.array([fitrecord.unit(name, units or {}) for name in task.parameters])
    of_starts, in_doubt = fitrecord.of_starts(task, fits, best, refused)
    remarks = [
        *fitrecord.clipped(task, nominal), *identifiability.remarks(list(task.parameters), chosen, knowledge), *fitrecord.of_clocks(result),
        *of_starts,
    ]  # fmt: skip
    result.attrs.update(
        applied=applied,
        start="; ".join(
            ["the nominal vehicle, clipped into the bounds", *(f"{name} {value:g}" for name, value in dict(*start[:1]).items())]
        ),
        stopping_rule=f"relative change of cost or step below {tolerance:g} (scipy least_squares, trf: ftol, xtol)",
        drives=", ".join(again.drive.attrs["name"] for again in task.replays),
        remarks="; ".join(remarks) or "none",
        starts="; ".join(in_doubt) or fitrecord.AGREE,
        driver=pedals.words(again.by_foot for again in task.replays),
    )
    return result


def _one_after_the_other(task: Problem, start: np.ndarray, tolerance: float) -> tuple[dict[str, Descent], np.ndarray]:
    """OP_1, OP_2, ... of fig:optichain, each from where the one before it ended, and the columns of the Jacobian that they leave."""
    steps, columns, point = {}, None, start
    for index in range(len(task.parameters)):
        found = descend(task, point, [index], tolerance)
        columns = np.zeros_like(found.jacobian) if columns is None else columns
        point, columns[:, index] = found.point, found.jacobian[:, index]
        steps[f"OP_{index + 1}"] = found
    return steps, columns


def _from_elsewhere(
    task: Problem, best: Descent, places: Sequence[np.ndarray], tolerance: float
) -> tuple[list[Descent], list[str]]:
    """``best`` and the fits from other places, and why the others of these led nowhere."""
    fits, refused, everything = [best], [], list(range(len(task.parameters)))
    for place in places:
        known = fits[_least(fits)]
        try:
            found = descend(task, place, everything, max(tolerance, COARSE), known=known.jacobian)
        except InputError as why:
            refused.append(str(why))
            continue
        if not -EQUAL < found.cost / known.cost - 1 < fitrecord.DISAGREE:
            found = descend(task, found.point, everything, tolerance, known=found.jacobian, exact=True)
        fits.append(found)
    return fits, refused


def _least(fits: Sequence[Descent]) -> int:
    """Which fit is the best; of equal ones the first."""
    best = 0
    for number, fit in enumerate(fits):
        if fit.cost < fits[best].cost * (1 - EQUAL):
            best = number
    return best


def effect_parameters(chosen, held: Mapping[str, Mapping[str, float]]) -> tuple[dict, dict]:
    """Bounds (the plausible range) and units of all parameters of effects but those that are held.

    ``chosen`` is what ``effects.library.choose`` returns; keys are "effect.parameter".
    """
    bounds, units = {}, {}
    for entry, _ in chosen:
        for parameter in entry.effect.parameters:
            if parameter.name not in (held.get(entry.effect.name) or {}):
                name = f"{entry.effect.name}.{parameter.name}"
                bounds[name], units[name] = parameter.plausible, parameter.unit
    return bounds, units


def values_below(calibration: xr.Dataset, chosen, held: Mapping[str, Mapping[str, float]]) -> dict[str, float]:
    """The values (SI) of all that is calibrated at which a model with effects is one with fewer, as ``calibration`` left that.

    Those of its joint fit, and neutral ones of the effects that it has not; ``chosen`` and ``held`` as for ``effect_parameters``.
    """
    neutral = {f"{entry.effect.name}.{name}": value for entry, _ in chosen for name, value in entry.effect.neutral.items()}
    joint = calibration["step_value"].sel(step="joint")
    known = dict(zip(joint["parameter"].values.tolist(), joint.values.tolist()))
    return {**{name: neutral[name] for name in effect_parameters(chosen, held)[0]}, **known}


def profile(
    task: Problem, point: np.ndarray, parameter: str, places: np.ndarray, tolerance: float = 1e-4
) -> xr.DataArray:
    """Profile of the cost: least cost over all other parameters with ``parameter`` held at each place.

    ``point`` is the optimum and ``places`` are values of the parameter in SI units. Returns cost over
    ``value``; flat where the data do not see the parameter, nan where the vehicle cannot be driven.
    """
    held = task.parameters.index(parameter)
    free = [index for index in range(len(task.parameters)) if index != held]
    width = task.upper[held] - task.lower[held]
    costs = []
    for place in np.asarray(places, dtype=float):
        first = np.array(point, dtype=float)
        first[held] = (place - task.lower[held]) / width
        try:
            costs.append(descend(task, first, free, tolerance).cost)
        except InputError:
            costs.append(np.nan)
    return xr.DataArray(costs, {"value": places}, "value", name=parameter)


def _profiles(task: Problem, point, knowledge: identifiability.Knowledge, names: Sequence[str]) -> xr.Dataset:
    rows = []
    for name in names:
        index = task.parameters.index(name)
        reach = np.minimum(2 * knowledge.half_width[index], 1.0) * np.linspace(-1, 1, PROFILE_PLACES)
        spread = np.clip(point[index] + reach, 0.0, 1.0)
        places = task.lower[index] + spread * (task.upper[index] - task.lower[index])
        rows.append((places, profile(task, point, name, places).values))
    places, costs = np.stack(rows, axis=1)
    over = ("profile", "place")
    return xr.Dataset({"profile_value": (over, places), "profile_cost": (over, costs)}, {"profile": list(names)})


def _assess(task: Problem, point: np.ndarray, jacobian: np.ndarray) -> identifiability.Knowledge:
    """What is known at a point. The residuals are those that alignment left: what the fit finds of path, clock and mounting it
    finds in the same signals, so what is left behind them is too small for an error. They count by what they do to the fit."""
    length = max(1.0, BLOCK * np.mean([np.ptp(again.place) / np.ptp(again.time) for again in task.replays]))
    roads = list(dict.fromkeys(id(again.road) for again in task.replays))
    residuals, blocks = task.residuals_as_aligned(point), []
    for again in task.replays:
        # Repeats of a place share a block: what the model lacks there, it lacks in every repeat.
        part = np.floor(again.place[again.compared] / length).astype(np.int64)
        blocks.append(10**6 * roads.index(id(again.road)) + part)
    first, parts = 0, []
    for residual in residuals:
        parts.append(jacobian[first : first + residual.size].reshape(*residual.shape, -1))
        first += residual.size
    return identifiability.assess(
        np.concatenate(parts, axis=1),
        np.concatenate(residuals, axis=1),
        np.concatenate(blocks),
        np.concatenate(task.influence(point, jacobian), axis=1),
    )


def _bounds(vehicle, parameters: Sequence[str], given: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
    """Bounds of the parameters in their order, those of effects behind them."""
    bounds = {}
    for name in parameters:
        if name not in PARAMETERS:
            raise InputError(f"unknown parameter {name!r}; {hint(name, PARAMETERS)}", place="parameters")
        bounds[name] = given.get(name, BOUNDS.get(name, vehicle.about(name)))
    for name in given:
        if "." not in name and name not in PARAMETERS:
            raise InputError(f"unknown parameter {name!r}; {hint(name, PARAMETERS)}", place="bounds")
    found = {**bounds, **{name: pair for name, pair in given.items() if "." in name}}
    if not found:
        raise InputError("nothing is calibrated (expected at least one parameter)", place="parameters")
    return found


def _started(task: Problem, nominal: Mapping[str, float], given: Mapping[str, float]) -> np.ndarray:
    """The point of the nominal values, clipped, with those that are given."""
    for name, value in given.items():
        if name not in task.parameters:
            raise InputError(f"{name!r} is not calibrated (expected of {', '.join(task.parameters)})", place="start")
        index = task.parameters.index(name)
        if not task.lower[index] <= value <= task.upper[index]:
            bounds = f"{task.lower[index]:g} to {task.upper[index]:g}"
            raise InputError(f"{value:g} (expected within the bounds {bounds})", place=f"start: {name}")
    return task.point([given.get(name, value) for name, value in nominal.items()])


def _nominal(vehicle, effects: Mapping[str, Mapping[str, float]], name: str) -> float:
    effect, dot, parameter = name.partition(".")
    if not dot:
        return vehicle[name]
    try:
        return effects[effect][parameter]
    except KeyError:
        raise InputError(f"effect {effect!r} has no starting value of {parameter!r}", place=name) from None
