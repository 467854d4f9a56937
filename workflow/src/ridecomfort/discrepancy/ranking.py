"""The evidence of a selection as a Dataset, that of the library and beside it that of forces of any form."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..vocabulary import describe
from .experiment import Experiment
from .explain import ASSUMED, NIL, REPEATS
from .selection import Selection, Trial, shares

SHARED = ("shared_z", "shared_gone", "remaining", "remaining_z")
"""What repeats have in common of their errors, before the first effect and after the last, as in ``Selection``."""

FORMS = "form_"
"""What names of the evidence for forces of any form begin with."""

TESTED = {"round", "effect", "trial"}
"""Dimensions of what was tested and refitted."""


def dataset(experiment: Experiment, selection: Selection) -> xr.Dataset:
    """The evidence of a selection as the Dataset of ranking.nc."""
    rounds = selection.rounds
    names = [candidate.name for candidate in experiment.candidates]
    table = {key: np.full((len(rounds), len(names)), np.nan) for key in ("p_value", "gain", "absorbed")}
    trials = []
    for number, turn in enumerate(rounds):
        places = [names.index(name) for name in turn.names]
        for key in table:
            table[key][number, places] = getattr(turn, key)
        trials += [(number + 1, trial, turn) for trial in turn.trials]
    shared = selection.shared_z, selection.shared_gone, selection.remaining.share, selection.remaining.z
    fitted = [record.name for record in experiment.records if record.role == "fit"]
    held_out = [record.name for record in experiment.records if record.role != "fit"]
    by_trial = lambda get: ("trial", np.array([get(trial) for _, trial, _ in trials], dtype=float))
    text = lambda get: ("trial", np.array([get(trial) for _, trial, _ in trials], dtype=str))
    columns = {key: (("round", "effect"), values, {"units": "1"}) for key, values in table.items()}
    others = rounds[-1].excluded if rounds else ()
    of_others = {f"other_{key}": ("other", np.array([getattr(one, key) for one in others], dtype=str)) for key in ("effect", "parameter", "unit")}
    of_others["other_size"] = "other", np.array([one.size for one in others], dtype=float)
    ranges = {"other_interval": [one.interval for one in others], "other_plausible": [one.plausible for one in others]}
    of_others |= {key: (("other", "bound"), np.array(pairs, dtype=float).reshape(-1, 2)) for key, pairs in ranges.items()}
    passed_over = np.array([[turn.passed_over.get(name, "") for name in names] for turn in rounds], dtype=str).reshape(len(rounds), len(names))
    result = xr.Dataset(
        {
            **columns,
            **of_others,
            "passed_over": (("round", "effect"), passed_over),
            "trial_round": ("trial", np.array([number for number, _, _ in trials], dtype=int)),
            "trial_effect": text(lambda trial: trial.name),
            "trial_sizes": text(lambda trial: _sizes_in_words(trial, experiment)),
            "trial_gain": by_trial(lambda trial: trial.gain),
            "trial_bic": by_trial(lambda trial: trial.bic),
            "trial_held_out_gain": by_trial(lambda trial: trial.held_out_gain),
            "trial_held_out_z": by_trial(lambda trial: trial.held_out_z),
            # Above the last floor, as all other shares that are told; the search went by the floor of its time.
            "trial_share": by_trial(lambda trial: shares(selection, trial.before, trial.after)[0]),
            "trial_held_out_share": by_trial(lambda trial: shares(selection, trial.before, trial.after)[1] if trial.met else np.nan),
            "trial_correlation": (
                "trial", np.array([turn.correlation.get(trial.name, np.nan) for _, trial, turn in trials], dtype=float),
            ),
            "trial_objection": text(lambda trial: trial.objection),
            "winner": ("round", np.array([turn.winner.name if turn.winner else "" for turn in rounds], dtype=str)),
            "cluster": ("round", np.array([", ".join(turn.cluster) for turn in rounds], dtype=str)),
            "decoy_p_value": ("round", np.array([turn.decoy_p_value for turn in rounds], dtype=float)),
            "mean_square": (("model", "drive", "signal"), np.stack([state.squares for state in selection.states])),
            "held_out_mean_square": (
                ("model", "held_out", "signal"), np.stack([state.held_out_squares for state in selection.states]),
            ),
            "floor_mean_square": (("drive", "signal"), selection.floor_squares),
            "held_out_floor_mean_square": (("held_out", "signal"), selection.held_out_floor_squares),
            **{name: ((), float(value), {"units": "1"}) for name, value in zip(SHARED, shared)},
            "value": (("parameter",), np.array([selection.final.values[key] for key in selection.intervals])),
            "interval": (("parameter", "bound"), np.array([selection.told(key) for key in selection.intervals]).reshape(-1, 2)),
        },
        {
            "effect": names,
            "round": np.arange(1, len(rounds) + 1),
            "model": [state.name for state in selection.states],
            "drive": fitted,
            "held_out": held_out,
            "signal": list(experiment.channels),
            "parameter": list(selection.intervals),
            "bound": ["lower", "upper"],
        },
    )  # fmt: skip
    return result.assign_attrs(
        floor=REPEATS if selection.is_floor_known else ASSUMED if selection.floor_squares.any() else NIL,
        remaining_band=str(selection.remaining.band or ""),
    )


def with_forms(table: xr.Dataset, own: xr.Dataset) -> xr.Dataset:
    """The evidence of the library with its ``own`` of the terms of a force of any form beside it."""
    own = own[[name for name, values in own.data_vars.items() if values.dims and TESTED.issuperset(values.dims)]]
    return table.merge(describe(own).rename({name: f"{FORMS}{name}" for name in (*own.variables, *own.dims)}))


def forms(table: xr.Dataset) -> xr.Dataset | None:
    """The evidence for forces of any form, named as that of the library; None where none were looked for."""
    names = [name for name in table.data_vars if name.startswith(FORMS)]
    own = table[names]
    return own.rename({name: name.removeprefix(FORMS) for name in (*own.variables, *own.dims)}) if names else None


def _sizes_in_words(trial: Trial, experiment: Experiment) -> str:
    candidate = next(c for c in experiment.candidates if c.name == trial.name)
    term = trial.name.partition(":")[2]
    return ", ".join(
        f"{size.key.partition('.')[2].removeprefix(f'{term}_')} {trial.fit.values[size.key]:.4g} {size.unit}".removesuffix(" 1")
        for size in (*candidate.sizes, *(size for size in candidate.shaping if size.key in trial.fit.keys))
        if size.key in trial.fit.values
    )
