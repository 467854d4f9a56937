"""Find the physical effects that the model lacks, from all measured drives; write the evidence and the verdict.

Where something is missing that no effect of the library explains, the form that is proposed for it is written
beside the verdict as an effect file, ``discovered.py``, to be read, kept and switched on.
"""

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
    settings = {key: config[key] for key in ("effects", "effects_folder", "fitted_on", "bounds", "uncertain", "seed", "workers")}
    settings["calibration"] = None if calibration is None else store.read(calibration)
    settings["options"] = {"step": config["simulation"]["step"]}
    settings["say"] = lambda words: print(words, file=sys.stderr, flush=True)
    car = parameters.read(vehicle)
    told = {"among": config["among"], "noise_density": config["noise_density"], "signatures": True}
    table, found, proposal = discrepancy.diagnose(drives, car, **told, **settings)
    content = found.json()
    proposed = Path(verdict).with_name("discovered.py")
    proposed.unlink(missing_ok=True)  # of drives or of a model before
    if proposal is not None:
        content["proposal"] = proposal.json()
        if proposal.source:
            _write(proposed, proposal.source)
    store.write(table, ranking, title="Evidence for effects that the model lacks", configuration=config, seed=config["seed"])
    _write(verdict, json.dumps(content, indent=1) + "\n")
    print(found.words(), file=sys.stderr)


def _write(path, text):
    with store.replacing(path) as part:
        part.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    Command(
        main,
        inputs=("roads", "measured", "vehicle"),
        optional=("calibration",),
        many=("roads", "measured"),
        outputs=("ranking", "verdict"),
    ).run()
