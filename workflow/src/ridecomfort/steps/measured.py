"""Read a site's measured drives and bring them into line with its road: clock, speed, path, mounting."""

from collections.abc import Mapping, Sequence
from itertools import combinations

import xarray as xr

from ridecomfort import pool, simulate, store
from ridecomfort.drive import align, configured, copies, lead, mounting, record, turning
from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command, note
from ridecomfort.vehicle import parameters


def main(road, vehicle, drives, config, output, workers):
    car = parameters.read(vehicle)
    surface = store.read(road)
    aligned = of_files(drives, simulate.prepare(surface), car, config, int(workers), car)
    store.write(aligned, output, title=f"Measured drives on {config['site']}", configuration=config)
    failing = [f"{name}: {faults}" for name, faults in zip(aligned["drive"].values, aligned["faults"].values) if faults]
    treated = [f"{name}: {done}" for name, done in zip(aligned["drive"].values, aligned["treatment"].values) if done != "none"]
    gains = [f"{one.attrs['name']}: {words}" for one in record.unstack(aligned) if (words := turning.words(one, surface))]
    for words in (*treated, *failing, *gains, *mounting.moved(aligned)):
        note(f"{config['site']}: {words}")
    if aligned.attrs["distance_doubt"]:
        note(f"{config['site']}: {aligned.attrs['distance_doubt']}")


def of_files(
    files: Sequence, course, car, config: Mapping, workers: int, own, effects: Mapping[str, Mapping[str, float]] | None = None
) -> xr.Dataset:
    """The drives of a ``car`` in files, aligned with the road, and what speaks against their distances; aligned for the car as it is
    supposed to be, its ``own`` vehicle with ``effects``."""
    read = [configured.read(path, entry, car, rate=config["simulation"]["rate"]) for path, entry in zip(files, config["drives"], strict=True)]
    _check_once(files, read)
    options = {"step": config["simulation"]["step"], "effects_folder": config.get("effects_folder")}

    def found(path, drive: xr.Dataset) -> xr.Dataset:
        try:
            one = align.align(drive, course, own, simulate=simulate.run, effects=effects, options=options, **config["alignment"])
        except InputError as problem:
            raise InputError(str(problem), file=path) from None
        return configured.check_speed(one, path)

    aligned = list(pool.mapped(workers)(lambda job: found(*job), zip(files, read)))
    metres = lead.of_drives(aligned)
    is_of_front_axle = all(entry.get("distance_of") == "front_axle" for entry in config["drives"])
    doubt = "" if metres is None else lead.words(metres, car["cg_to_front_axle"], is_of_front_axle)
    return record.stack(aligned).assign_attrs(distance_doubt=doubt)


def _check_once(files: Sequence, drives: Sequence[xr.Dataset]) -> None:
    """InputError where two drives are one record (``copies``)."""
    for (other, one), (file, two) in combinations(zip(files, drives), 2):
        if copies.is_copy(one, two):
            raise InputError(f"is that of {other}, expected a record once, either fitted or held out", file=file, place="a_z")


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle", "drives"), many=("drives",), texts=("workers",)).run()
