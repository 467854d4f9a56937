"""Read a site's measured drives and bring them into line with its road: clock, speed, path, mounting."""

from ridecomfort import pool, simulate, store
from ridecomfort.drive import align, configured, lead, record
from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command, note
from ridecomfort.vehicle import parameters


def main(road, vehicle, drives, config, output, workers):
    course = simulate.prepare(store.read(road))
    car = parameters.read(vehicle)
    rate, step = config["simulation"]["rate"], config["simulation"]["step"]
    read = [configured.read(path, entry, car, rate=rate) for path, entry in zip(drives, config["drives"], strict=True)]
    each = pool.mapped(int(workers))
    aligned = list(each(lambda job: _aligned(*job, course, car, {"step": step}, config["alignment"]), zip(drives, read)))
    metres = lead.of_drives(aligned)
    is_of_front_axle = all(entry.get("distance_of") == "front_axle" for entry in config["drives"])
    doubt = "" if metres is None else lead.words(metres, car["cg_to_front_axle"], is_of_front_axle)
    stacked = record.stack(aligned).assign_attrs(distance_doubt=doubt)
    store.write(stacked, output, title=f"Measured drives on {config['site']}", configuration=config)
    if doubt:
        note(f"{config['site']}: {doubt}")


def _aligned(path, drive, course, car, options, settings):
    """The drive aligned with the road; whatever speaks against it is said of its file."""
    try:
        found = align.align(drive, course, car, simulate=simulate.run, options=options, **settings)
    except InputError as problem:
        raise InputError(str(problem), file=path) from None
    return configured.check_speed(found, path)


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle", "drives"), many=("drives",), texts=("workers",)).run()
