"""Fit the vehicle, and the effects of the model, to the drives measured on a site."""

import sys
from collections.abc import Mapping

import xarray as xr

from ridecomfort import calibrate, fitrecord, simulate, store
from ridecomfort.effects import library
from ridecomfort.steps.command import Command, counted, note
from ridecomfort.vehicle import parameters


def main(road, measured, vehicle, config, output, workers, below=None):
    drives, course, car = store.read(measured), simulate.prepare(store.read(road)), parameters.read(vehicle)
    result = fitted(drives, course, car, config, int(workers), None if below is None else store.read(below))
    print(result.attrs["remarks"], file=sys.stderr)
    if result.attrs["starts"] != fitrecord.AGREE:
        note(result.attrs["starts"])
    result.attrs["calibrated_on"] = config["site"]
    store.write(
        result, output, title=f"Calibration on {config['site']}", configuration=config, seed=config["calibration"]["seed"]
    )


def fitted(drives: xr.Dataset, course, car, config: Mapping, workers: int, below: xr.Dataset | None) -> xr.Dataset:
    """The calibration (``calibrate.calibrate``) of the configured model on aligned drives; ``below``: that of the model without an effect of it."""
    chosen = library.choose(config["effects"], config["effects_folder"])
    settings = dict(config["calibration"])
    bounds, units = calibrate.effect_parameters(chosen, held=config["effects"])
    # A model that has not the effect has no profile of its size.
    settings["profiles"] = [name for name in settings["profiles"] if "." not in name or name in bounds]
    result = calibrate.calibrate(
        drives,
        course,
        car,
        simulate=counted(simulate.run, "drives simulated"),
        bounds={**settings.pop("bounds"), **bounds},
        units=units,
        effects={entry.effect.name: sizes for entry, sizes in chosen},
        below=None if below is None else calibrate.values_below(below, chosen, config["effects"]),
        options={"step": config["simulation"]["step"], "effects_folder": config["effects_folder"]},
        workers=workers,
        **settings,
    )
    for step in result["step"].values:
        block = result.sel(step=step)
        print(f"{step}: cost {float(block['cost']):.6g} after {int(block['iterations'])} iterations", file=sys.stderr)
    return result


if __name__ == "__main__":
    Command(main, inputs=("road", "measured", "vehicle"), optional=("below",), texts=("workers",)).run()
