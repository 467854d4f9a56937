"""The curves of what is missing where a diagnosis found something, beside those that what it found would show."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr

from ..effects import library
from . import experiment as exp
from .car import Car
from .discovery import Discovery
from .rung import Rung
from .selection import Selection
from .signature import signature
from .verdict import Verdict


def missing_force(
    experiment: Car, rung: Rung, selection: Selection, verdict: Verdict, proposal: Discovery | None = None, *, effects_folder=None,
    each: Callable = map,
) -> xr.Dataset:  # fmt: skip
    """``signature`` of what a ``rung`` misses, which a search in the library came to a ``selection`` and a ``verdict`` from: at struts and
    tyres, and at the ports of what is named, of the form that is proposed with what stands beside it, of effects that are on (those of the
    ``experiment``), or else of what came nearest."""
    is_proposed = proposal is not None and bool(proposal.place)
    names = [name for effect in verdict.effects for name in (effect.name, *effect.like)]
    if not (names or is_proposed):
        names = [trial.name for turn in selection.rounds[:1] for trial in turn.trials]
    known = library.find(effects_folder)
    ports = [known[name].effect.port for name in (*names, *experiment.effects)]
    found = proposal.residuals if is_proposed else _with_named(rung, selection, verdict, experiment)
    ports += [proposal.port] if is_proposed else []
    return signature(rung, found=found, ports=ports, effects_folder=effects_folder, each=each)


def _with_named(rung: Rung, selection: Selection, verdict: Verdict, experiment: Car) -> Mapping[int, np.ndarray] | None:
    """Residuals of the last model with nothing but the effects that the verdict names; None without any."""
    named = [effect.name for effect in verdict.effects]
    others = [c for c in experiment.candidates if c.name in selection.accepted and c.name not in named]
    values = {**selection.final.values, **{size.key: size.neutral for c in others for size in c.sizes}}
    return exp.simulate(rung.experiment, values, rung.fit.residuals) if named else None
