"""Align a site's measured drives anew for a model with effects: what an effect does late would else pass for a clock's error.

They are aligned as for the base model, from the same vehicle, with the effects at the sizes that a rough calibration on the drives
as they were aligned ``before`` gives them, or those of the site that the vehicle is calibrated on.
"""

import sys

from ridecomfort import calibrate, calibrated, simulate, store
from ridecomfort.effects import library
from ridecomfort.errors import InputError
from ridecomfort.steps import calibrate as calibration_step
from ridecomfort.steps import measured
from ridecomfort.steps.command import Command, note
from ridecomfort.vehicle import parameters

STAYS = "{site}: drives stay as aligned for the model before, since with {effects} {why}"


def main(road, vehicle, drives, before, config, output, workers, below=None, calibration=None):
    course, car = simulate.prepare(store.read(road)), parameters.read(vehicle)
    effects = {entry.effect.name: sizes for entry, sizes in library.choose(config["effects"], config["effects_folder"])}
    found = None if calibration is None else store.read(calibration)
    if below is not None:
        rough = {"sequence": False, "profiles": [], "restarts": 0, "tolerance": calibrate.COARSE}
        settings = config | {"calibration": config["calibration"] | rough}
        found = calibration_step.fitted(store.read(before), course, car, settings, int(workers), store.read(below))
    _, effects = calibrated.apply(found, car, effects)
    for name, sizes in effects.items():
        print(name, *(f"{parameter} {size:.4g}" for parameter, size in sizes.items()), file=sys.stderr)
    try:
        aligned = measured.of_files(drives, course, car, config, int(workers), effects)
    except InputError as why:
        note(STAYS.format(site=config["site"], effects=", ".join(effects), why=why))
        aligned = store.read(before)
    title = f"Measured drives on {config['site']}, aligned for {', '.join(effects)}"
    store.write(aligned, output, title=title, configuration=config)


if __name__ == "__main__":
    Command(
        main, inputs=("road", "vehicle", "drives", "before"), many=("drives",), optional=("below", "calibration"), texts=("workers",)
    ).run()
