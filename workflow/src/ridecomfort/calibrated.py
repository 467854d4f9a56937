"""A vehicle and its effects with the values that calibration found."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr


def apply(calibration: xr.Dataset | None, vehicle, effects: Mapping[str, Mapping[str, float]] | None = None):
    """The vehicle and the effects with calibrated values: (vehicle, effects). None changes nothing."""
    if calibration is None:
        return vehicle, dict(effects or {})
    found = calibration["value"]
    values = {str(name): float(value) for name, value in zip(found["parameter"].values, found.values)}
    return with_values(vehicle, effects or {}, values)


def with_values(vehicle, effects: Mapping[str, Mapping[str, float]], values: Mapping[str, float]):
    """Vehicle and effects with values replaced; ``effect.parameter`` goes to the effect."""
    changed = {name: dict(parameters) for name, parameters in effects.items()}
    own = {}
    for name, value in values.items():
        effect, dot, parameter = name.partition(".")
        if dot:
            changed.setdefault(effect, {})[parameter] = float(value)
        else:
            own[name] = float(value)
    return vehicle.replace(**own), changed
