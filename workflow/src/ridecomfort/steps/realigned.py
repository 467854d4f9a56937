"""Align a site's measured drives anew for a model: what the vehicle and its effects do late else passes for an error of the clock.

They are aligned from the vehicle, and with the effects, of a rough calibration on the drives as they were aligned ``before``, or of the
calibration on the site that this one takes its vehicle from; base as well, so that no model is compared with better aligned drives.
"""

import sys

import xarray as xr

from ridecomfort import calibrate, calibrated, simulate, store
from ridecomfort.effects import library
from ridecomfort.errors import InputError
from ridecomfort.steps import calibrate as calibration_step
from ridecomfort.steps import measured
from ridecomfort.steps.command import Command, note
from ridecomfort.vehicle import parameters

ROUGH = {"applied": "joint", "sequence": False, "profiles": [], "restarts": 0, "seed": 0, "tolerance": calibrate.COARSE}
"""Settings of the rough calibration, beside those of which the step is told."""

STAYS = "drives stay as they were aligned before, since for {model} {why}"


def main(road, vehicle, drives, before, config, output, workers, below=None, calibration=None):
    course, car = simulate.prepare(store.read(road)), parameters.read(vehicle)
    effects = {entry.effect.name: sizes for entry, sizes in library.choose(config["effects"], config["effects_folder"])}
    found = None if calibration is None else store.read(calibration)
    if config["calibration"] is not None:
        settings = config | {"calibration": config["calibration"] | ROUGH}
        lower = None if below is None else store.read(below)
        found = calibration_step.fitted(store.read(before), course, car, settings, int(workers), lower)
    own, effects = calibrated.apply(found, car, effects)
    model = ", ".join(effects) or "the calibrated vehicle"
    title, doubt = f"Measured drives on {config['site']}, aligned for {model}", ""
    try:
        aligned = measured.of_files(drives, course, car, config, int(workers), own, effects)
    except InputError as why:
        aligned, doubt = store.read(before), STAYS.format(model=model, why=why)
        title = f"Measured drives on {config['site']}, not aligned for {model}"
        note(f"{config['site']}: {doubt}")
    for name, offset in zip(aligned["drive"].values, 1e3 * aligned["clock_offset"].values):
        print(f"{name}: clock offset {offset:.2f} ms", file=sys.stderr)
    for words in new_faults(store.read(before), aligned):
        note(f"{config['site']}: {words}, aligned for {model}")
    store.write(aligned.assign_attrs(alignment_doubt=doubt), output, title=title, configuration=config)


def new_faults(before: xr.Dataset, aligned: xr.Dataset) -> list[str]:
    """What alignment for a model found to speak against drives, and had not found ``before``, one a drive."""
    pairs = zip(aligned["drive"].values, *([str(faults).split("; ") for faults in drives["faults"].values] for drives in (before, aligned)))
    new = {name: [fault for fault in later if fault and fault not in earlier] for name, earlier, later in pairs}
    return [f"{name}: {'; '.join(faults)}" for name, faults in new.items() if faults]


if __name__ == "__main__":
    Command(
        main, inputs=("road", "vehicle", "drives", "before"), many=("drives",), optional=("below", "calibration"), texts=("workers",)
    ).run()
