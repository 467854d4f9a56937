"""Whether a file tells by itself what it holds."""

from __future__ import annotations

import re

import xarray as xr

WHERE_ITS_UNIT_STANDS = re.compile(r", in (the unit of the signal|its (SI )?unit|(seen|missing|other)_unit, its unit)")
"""What the meaning of a variable says that is stacked over quantities of several units."""


def undescribed(dataset: xr.Dataset) -> list[str]:
    """Variables without a meaning, or without a unit where their meaning does not say where that stands."""
    found = [name for name, variable in dataset.variables.items() if "long_name" not in variable.attrs]
    numbers = [name for name, variable in dataset.variables.items() if variable.dtype.kind not in "USO" and "units" not in variable.attrs]
    return found + [name for name in numbers if not WHERE_ITS_UNIT_STANDS.search(dataset[name].attrs.get("long_name", ""))]
