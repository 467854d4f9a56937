"""Random inputs of the simulated drives: Latin hypercube samples (sec:MC, tab:lhs_input)."""

from __future__ import annotations

import zlib
from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.special import ndtri

from .errors import InputError

INPUTS = ("speed_deviation", "lateral_position", "road_friction")

METHODS = ("latin_hypercube", "monte_carlo")


def sample(
    distributions: Mapping[str, Mapping], runs: int, *, seed: int, site: str, method: str = "latin_hypercube"
) -> xr.Dataset:
    """Speed deviation [m/s], lateral position [m] and road friction [1] of each run.

    ``distributions`` maps each input to ``{"normal": [mean, sd]}`` or
    ``{"uniform": [lower, upper]}``. A Latin hypercube takes one value from each of
    ``runs`` equally probable intervals of every input, in random order, and is sliced
    (``latin_hypercube``); ``monte_carlo`` draws independently. Each site has its own stream of the seed, whatever other sites
    there are. Returns a dataset with dim ``run``.

    Raises InputError for an unknown method and where a friction is drawn that is not positive.
    """
    generator = np.random.default_rng([seed, zlib.crc32(site.encode())])
    if method == "latin_hypercube":
        unit = latin_hypercube(runs, len(INPUTS), generator)
    elif method == "monte_carlo":
        unit = generator.random((runs, len(INPUTS)))
    else:
        raise InputError(f"{method!r}, expected one of {', '.join(METHODS)}", place="sampling method")
    values = {
        name: ("run", _quantile(distributions[name], column)) for name, column in zip(INPUTS, unit.T)
    }
    lowest = values["road_friction"][1].min()
    if lowest <= 0:
        raise InputError(f"draws {lowest:.3g}, expected positive friction only", place="sampling: road_friction")
    return xr.Dataset(values, coords={"run": np.arange(runs, dtype=np.int32)})


def latin_hypercube(runs: int, inputs: int, generator: np.random.Generator) -> np.ndarray:
    """Points (runs, inputs) of the unit cube: a Latin hypercube whose slices are Latin hypercubes too.

    For every size in ``slices``, each of the blocks of that many consecutive points is by
    itself a random Latin hypercube: the study replicates smaller ones at no cost (sliced
    design: Qian 2012, Journal of the American Statistical Association 107, 393-399).
    """
    columns = []
    for _ in range(inputs):
        strata = np.arange(runs)[None, :]
        for size in slices(runs)[1:]:
            # Of neighbouring strata each slice gets one; which one is drawn.
            groups = strata.reshape(len(strata), size, -1)
            dealt = generator.permuted(groups, axis=2)
            strata = dealt.transpose(0, 2, 1).reshape(-1, size)
        columns.append((generator.permuted(strata, axis=1).ravel() + generator.random(runs)) / runs)
    return np.stack(columns, axis=1)


def slices(runs: int) -> list[int]:
    """Sizes of the slices of a Latin hypercube, largest first: ``runs`` divided by its prime factors, smallest first."""
    sizes, factor = [runs], 2
    while sizes[-1] > 1:
        while sizes[-1] % factor:
            factor += 1
        sizes.append(sizes[-1] // factor)
    return sizes


def _quantile(distribution: Mapping, probability: np.ndarray) -> np.ndarray:
    ((kind, (first, second)),) = distribution.items()
    if kind == "normal":
        return ndtri(probability) * second + first
    return first + (second - first) * probability
