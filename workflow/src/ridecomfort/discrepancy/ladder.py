"""The error ladder: how far the error falls with each effect that is added, down to the floor."""

from __future__ import annotations

import numpy as np
import xarray as xr


def ladder(ranking: xr.Dataset) -> xr.Dataset:
    """Rows of the error ladder from a ranking (``rank``): calibrated, then with every effect that was found.

    Over ``model`` and ``signal``: ``rmse`` on fitted and ``held_out_rmse`` on held-out drives, ``floor`` and
    ``held_out_floor``, and the share of the explainable error that is left, ``left`` and ``held_out_left`` (1 for the
    first model, 0 at the floor; nan where nothing was explainable). Each model is calibrated anew.
    """
    data = {}
    for prefix, drive in (("", "drive"), ("held_out_", "held_out")):
        square = ranking[f"{prefix}mean_square"].mean(drive)
        ground = ranking[f"{prefix}floor_mean_square"].mean(drive)
        explainable = square.isel(model=0) - ground
        data[f"{prefix}rmse"] = np.sqrt(square)
        data[f"{prefix}floor"] = np.sqrt(ground)
        data[f"{prefix}left"] = (square - ground) / explainable.where(explainable > 0)
    return xr.Dataset(data).assign_attrs(floor=ranking.attrs["floor"])


def table(rungs: xr.Dataset) -> list[dict[str, object]]:
    """The ladder as rows for a table: model, signal, errors in the unit of the signal, shares left in percent."""
    rows = []
    for model in rungs["model"].values:
        for signal in rungs["signal"].values:
            row = rungs.sel(model=model, signal=signal)
            rows.append(
                {
                    "model": str(model),
                    "signal": str(signal),
                    **{name: float(row[name]) for name in ("rmse", "floor", "held_out_rmse", "held_out_floor")},
                    **{f"{name}_percent": 100 * float(row[name]) for name in ("left", "held_out_left")},
                }
            )
    return rows
