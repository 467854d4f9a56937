"""What a site's road is like and what treating it changes: roughness, defects, repairs, and the cost of smoothing."""

from dataclasses import replace

import numpy as np

from ridecomfort import store
from ridecomfort.comfort import inspection
from ridecomfort.road import clean, prepare
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(road, vehicle, gridded, config, output):
    prepared = prepare.prepare(road, **{**config["options"], "smoothing": "cross-validation"})
    if gridded is not None:
        prepared = scanned(prepared, store.read(gridded))
    found = inspection.inspect(
        prepared, parameters.read(vehicle), speed=config["speed"], tracks=config["wheel_tracks"], lateral=config["lateral_position"],
        **config["simulation"],
    )
    found.attrs["used"] = "smoothed" if config["options"].get("smoothing") == "cross-validation" else "repaired"
    store.write(found, output, title=f"Inspection of the road of {config['site']}", configuration=config)


def scanned(prepared, before):
    """The road with what was done to it before it was written as OpenCRG: heights and treatment of the scan's grid."""
    treated = np.where(before.treated.values != clean.MEASURED, before.treated.values, prepared.repaired.treated.values)
    measured = prepared.measured.assign(elevation=(("u", "v"), before.elevation.values))
    return replace(prepared, measured=measured, repaired=prepared.repaired.assign(treated=(("u", "v"), treated)))


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle"), optional=("gridded",)).run()
