"""Find the physical effects that the model lacks, from all measured drives, and write evidence and verdict."""

import json
import sys
from pathlib import Path

from ridecomfort import discrepancy, store
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(roads, measured, vehicle, calibration, config, ranking, verdict):
    drives = {
        name: (store.read(road), store.read(drive))
        for name, road, drive in zip(config["sites"], roads, measured, strict=True)
    }
    table, found = discrepancy.rank(
        drives,
        parameters.read(vehicle),
        calibration=None if calibration is None else store.read(calibration),
        effects=config["effects"],
        effects_folder=config["effects_folder"],
        fitted_on=config["fitted_on"],
        bounds=config["bounds"],
        seed=config["seed"],
        workers=config["workers"],
        options={"step": config["simulation"]["step"]},
        say=lambda words: print(words, file=sys.stderr, flush=True),
    )
    store.write(table, ranking, title="Evidence for effects that the model lacks", configuration=config, seed=config["seed"])
    with store.replacing(verdict) as part:
        Path(part).write_text(json.dumps(found.json(), indent=1) + "\n", encoding="utf-8")
    print(found.words(), file=sys.stderr)


if __name__ == "__main__":
    Command(
        main,
        inputs=("roads", "measured", "vehicle"),
        optional=("calibration",),
        many=("roads", "measured"),
        outputs=("ranking", "verdict"),
    ).run()
