"""An effect of the library as a candidate: its sizes, and what shapes it with the settings to try."""

from __future__ import annotations

import numpy as np

from ..effects.contract import Effect, Parameter
from .experiment import Candidate, Size

PROBE = 0.25
"""Share of an effect's typical size that it is probed with: the smallest size of interest."""

OF_THE_ROAD = ("road_bank", "road_grade")
"""Effects that are errors of the road's file, not of the vehicle."""

ALIGNED = ("clock_drift", "clock_offset", "imu_tilt", "path_offset", "sensor_gain")
"""Effects that are what alignment takes out of every drive, and leaves open by as much as is usual."""

VARIED_UNITS = ("Hz", "m/s")
"""Units of parameters that shape an effect so much that it is tried with several values; clearances do, too, and what may be of either
sign or none."""

CLEARANCE = "clearance"
"""How names of parameters begin that say where a part meets another."""

SHAPING_PROBE = 0.02
"""Share of its plausible range that what shapes an effect is probed with."""


def candidate(effect: Effect) -> Candidate:
    """An effect as a candidate: its sizes, and what only shapes it with the settings to try."""
    sizes = [parameter for parameter in effect.parameters if _is_size(parameter, effect)]
    shaping = [parameter for parameter in effect.parameters if parameter not in sizes]
    typical = {f"{effect.name}.{p.name}": p.typical for p in shaping}
    together: dict[str, list[Parameter]] = {}
    for parameter in shaping:
        if is_varied(parameter):
            together.setdefault(parameter.name.partition("_")[0], []).append(parameter)
    shapes = [typical]
    for varied in together.values():
        keys = [f"{effect.name}.{parameter.name}" for parameter in varied]
        moved = (dict(zip(keys, values)) for values in zip(*map(_moved, varied), strict=True))
        shapes += [{**typical, **own} for own in moved if {**typical, **own} != typical]
    reaches = [1.0] * len(shapes) + [share / PROBE for share in effect.also_probed]
    shapes += [typical] * len(effect.also_probed)
    instrument = effect.port in ("sensor", "path") or effect.name in OF_THE_ROAD
    return Candidate(
        effect.name, tuple(_size(p, effect) for p in sizes), tuple(shapes), tuple(shaping_size(p, f"{effect.name}.{p.name}") for p in shaping),
        effect.sentence, instrument, effect.port, effect.name in ALIGNED, tuple(reaches),
    )  # fmt: skip


def is_varied(parameter: Parameter) -> bool:
    """Whether a parameter shapes an effect so much that it is tried with several values."""
    lower, upper = parameter.plausible
    return parameter.unit in VARIED_UNITS or parameter.name.startswith(CLEARANCE) or lower < 0.0 < upper or not parameter.typical


def _moved(parameter: Parameter) -> list[float]:
    """The values beside the typical one that a parameter is tried with."""
    values = [towards(parameter, 0), towards(parameter, 1)]
    if parameter.name.startswith(CLEARANCE):  # what is met all the time and what is met now and then are hardly alike
        values.append(float(parameter.plausible[0]))
    return values


def towards(parameter: Parameter, end: int) -> float:
    """Half of the way from what is typical to one end of what is plausible; in ratio, where neither may be nil."""
    typical, limit = parameter.typical, parameter.plausible[end]
    if parameter.plausible[0] > 0.0:
        return float(np.sqrt(typical * limit))
    return 0.5 * (typical + limit)


def shaping_size(parameter: Parameter, key: str) -> Size:
    """What shapes an effect as a number that may be fitted."""
    lower, upper = map(float, parameter.plausible)
    step = SHAPING_PROBE * (upper - lower)
    return Size(key, parameter.unit, parameter.typical, lower, upper, step, shaping=True)


def _is_size(parameter: Parameter, effect: Effect) -> bool:
    """Whether it switches the effect on; a size may be typically nil where one of its kind is not."""
    if parameter.neutral != parameter.typical:
        return True
    return any(p.unit == parameter.unit and p.neutral == parameter.neutral != p.typical for p in effect.parameters)


def _size(parameter: Parameter, effect: Effect) -> Size:
    same = [p.typical - p.neutral for p in effect.parameters if p.unit == parameter.unit and p.typical != p.neutral]
    step = parameter.typical - parameter.neutral or same[0]
    return Size(
        f"{effect.name}.{parameter.name}", parameter.unit, parameter.neutral, *map(float, parameter.plausible), PROBE * step
    )
