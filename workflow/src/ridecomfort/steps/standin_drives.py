"""The measured drives of a stand-in site, made by a hidden car: CSV files, and sealed apart from them the truth."""

import json

import pandas as pd

from ridecomfort import store
from ridecomfort.road import crg
from ridecomfort.standin import drives
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(road, vehicle, config, output, truth):
    surface = crg.read(road, interpolation="cubic")
    car = parameters.read(vehicle)
    records, known = drives.make_drives(config["site"], config, surface, car, config["drives"])
    for path, record in zip(output, records, strict=True):
        with store.replacing(path) as part:
            pd.DataFrame(record).to_csv(part, index=False)
    with store.replacing(truth) as part:
        part.write_text(json.dumps(known, indent=1) + "\n")


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle"), outputs=("output", "truth"), many=("output",)).run()
