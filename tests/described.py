"""Whether a file tells by itself what it holds."""

from __future__ import annotations

import xarray as xr


def undescribed(dataset: xr.Dataset) -> list[str]:
    """Variables without a meaning, or without a unit where their meaning names none either."""
    found = [name for name, variable in dataset.variables.items() if "long_name" not in variable.attrs]
    numbers = [name for name, variable in dataset.variables.items() if variable.dtype.kind not in "USO" and "units" not in variable.attrs]
    return found + [name for name in numbers if "unit" not in dataset[name].attrs.get("long_name", "")]
