"""Read a site's measured drives and bring them into line with its road: clock, speed, path, mounting."""

from ridecomfort import simulate, store
from ridecomfort.drive import align, configured, record
from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(road, vehicle, drives, config, output):
    course = simulate.prepare(store.read(road))
    car = parameters.read(vehicle)
    rate, step = config["simulation"]["rate"], config["simulation"]["step"]
    aligned = [
        _aligned(path, configured.read(path, entry, car, rate=rate), course, car, {"step": step}, config["alignment"])
        for path, entry in zip(drives, config["drives"], strict=True)
    ]
    store.write(
        record.stack(aligned), output, title=f"Measured drives on {config['site']}", configuration=config
    )


def _aligned(path, drive, course, car, options, settings):
    """The drive aligned with the road; whatever speaks against it is said of its file."""
    try:
        found = align.align(drive, course, car, simulate=simulate.run, options=options, **settings)
    except InputError as problem:
        raise InputError(str(problem), file=path) from None
    return configured.check_speed(found, path)


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle", "drives"), many=("drives",)).run()
