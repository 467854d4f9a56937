"""Find the physical effects that the model lacks, from all drives of one calibration; write the evidence and the verdict.

Where something is missing that no effect of the library explains, or a form explains as much as these do, the form that is proposed for it is
written beside the verdict as an effect file, ``discovered.py`` (``discovered_2.py`` where there is an effect of that name), to be read,
kept and switched on.
"""

import itertools
import json
import sys
from pathlib import Path

from ridecomfort import store
from ridecomfort.discrepancy.diagnosis import diagnose
from ridecomfort.drive import copies, record
from ridecomfort.effects import library
from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command, note
from ridecomfort.study import digest
from ridecomfort.vehicle import parameters

DISCOVERED = "discovered"
"""Name of the effect that is proposed."""


def main(roads, measured, vehicle, calibration, config, ranking, verdict, workers):
    drives = {
        name: (store.read(road), store.read(drive))
        for name, road, drive in zip(config["sites"], roads, measured, strict=True)
    }
    settings = {key: config[key] for key in ("effects", "effects_folder", "fitted_on", "bounds", "uncertain", "seed")}
    settings["workers"] = int(workers)
    settings["calibration"] = None if calibration is None else store.read(calibration)
    settings["options"] = {"step": config["simulation"]["step"]}
    settings["say"] = lambda words: print(words, file=sys.stderr, flush=True)
    check_once(drives, config["fitted_on"])
    car = parameters.read(vehicle)
    known = library.find(config["effects_folder"])
    name = next(name for name in _names() if name not in known)
    told = {"among": config["among"], "noise_density": config["noise_density"], "signatures": True, "name": name}
    table, found, proposal = diagnose(drives, car, **told, **settings)
    if settings["calibration"] is not None:
        table.attrs["calibrated"] = ", ".join(settings["calibration"]["parameter"].values.tolist())
    # By these it is known later whether another verdict speaks of the same drives.
    digests = {site: digest(drive, vehicle) for site, drive in zip(config["sites"], measured, strict=True)}
    content = {"sites": config["sites"], "vehicle_digest": digest(vehicle), "digests": digests, **found.json(), "proposal": None}
    for old in Path(verdict).parent.glob(f"{DISCOVERED}*.py"):  # of drives or of a model before
        old.unlink()
    conclusions = [found.words(proposal.form if proposal is not None else "")]
    if proposal is not None:
        content["proposal"] = proposal.json()
        if proposal.source:
            file = Path(verdict).with_name(f"{name}.py")
            _write(file, proposal.source)
            conclusions.append(f"Proposed is a form, in {file}: {proposal.words()}")
    store.write(table, ranking, title="Evidence for effects that the model lacks", configuration=config, seed=config["seed"])
    _write(verdict, json.dumps(content, indent=1) + "\n")
    for words in conclusions:
        note(words)


def check_once(drives, fitted_on):
    """InputError where a drive of a site that nothing is fitted to is the record of a fitted drive (``copies``): within a site that was asked before."""
    fitted = [(site, one) for site in drives if site in fitted_on for one in record.unstack(drives[site][1])]
    held_out = [(site, one) for site in drives if site not in fitted_on for one in record.unstack(drives[site][1])]
    for (site, one), (other, two) in itertools.product(held_out, fitted):
        if copies.is_copy(one, two):
            raise InputError(f"is the record of {other} {two.attrs['name']}, expected one that nothing is fitted to", place=f"{site}: drive {one.attrs['name']}: a_z")


def _names():
    yield DISCOVERED
    yield from (f"{DISCOVERED}_{number}" for number in itertools.count(2))


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
        texts=("workers",),
    ).run()
