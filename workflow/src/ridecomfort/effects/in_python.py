"""What effects at the ports outside the compiled kernel make of a vehicle, a path or a drive, checked."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..errors import InputError
from ..vehicle.parameters import Vehicle
from .library import Entry


class ActFails(InputError):
    """``act`` of an effect's file fails, or returns what its port does not take: a mistake in the file, not a size that cannot be driven."""


def answer(entry: Entry, sizes: Mapping[str, float], *seen):
    """What an effect at a port of ``IN_PYTHON`` makes of what it sees: a Vehicle, positions over u or a drive over time.

    Raises ActFails, which names the file of the effect, where ``act`` fails and where it returns something else; InputError where it refuses.
    """
    before = dict(seen[0].variables) if isinstance(seen[0], xr.Dataset) else seen[0]  # act may replace what a drive holds
    try:
        found = entry.act(*seen, **sizes)
    except InputError as problem:
        raise InputError(str(problem), file=entry.path) from None
    except Exception as problem:
        raise ActFails(f"act failed: {type(problem).__name__}: {' '.join(str(problem).split())}", file=entry.path) from None
    problem = _CHECKS[entry.effect.port](before, found)
    if problem:
        raise ActFails(f"act returned {problem}", file=entry.path)
    return found


def _not_a_vehicle(before: Vehicle, found) -> str:
    return "" if isinstance(found, Vehicle) else f"{_kind(found)}, expected a Vehicle (as of vehicle.replace)"


def _not_a_path(before: np.ndarray, found) -> str:
    expected = f"expected an array of {before.size} positions in m, one for each u"
    if not (isinstance(found, np.ndarray) and found.dtype.kind in "fiu"):
        return f"{_kind(found)}, {expected}"
    if found.shape != before.shape:
        return f"the shape {found.shape}, {expected}"
    return "" if np.isfinite(found).all() else f"what is not finite everywhere, {expected}"


def _not_a_drive(before: Mapping[str, xr.Variable], found) -> str:
    if not isinstance(found, xr.Dataset):
        return f"{_kind(found)}, expected a Dataset over time"
    kept = found.variables
    lost = [name for name, variable in before.items() if name not in kept or kept[name].dims != variable.dims]
    if lost:
        return f"a Dataset without {', '.join(lost)}, expected all that it was given over time"
    same = np.array_equal(kept["time"].values, before["time"].values)
    return "" if same else f"{kept['time'].size} records with times of their own, expected the {before['time'].size} times that it was given"


_CHECKS = {"vehicle": _not_a_vehicle, "path": _not_a_path, "sensor": _not_a_drive}
"""What is wrong with what was returned at a port of ``IN_PYTHON``, of what went in and what came out; nothing where all is right."""


def _kind(found) -> str:
    return "nothing" if found is None else f"a {type(found).__name__}"
