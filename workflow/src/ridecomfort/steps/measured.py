"""Read a site's measured drives and bring them into line with its road: clock, speed, path, mounting."""

from ridecomfort import simulate, store
from ridecomfort.drive import align, configured, record
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(road, vehicle, drives, config, output):
    course = simulate.prepare(store.read(road))
    car = parameters.read(vehicle)
    rate, step = config["simulation"]["rate"], config["simulation"]["step"]
    aligned = [
        align.align(
            configured.read(path, entry, car, rate=rate),
            course,
            car,
            simulate=simulate.run,
            options={"step": step},
            **config["alignment"],
        )
        for path, entry in zip(drives, config["drives"], strict=True)
    ]
    store.write(
        record.stack(aligned), output, title=f"Measured drives on {config['site']}", configuration=config
    )


if __name__ == "__main__":
    Command(main, inputs=("road", "vehicle", "drives"), many=("drives",)).run()
