"""Simulate some of a site's runs: each its own speed, lateral position and road friction."""

from ridecomfort import calibrated, simulate, store
from ridecomfort.space import places
from ridecomfort.steps.command import Command, countdown
from ridecomfort.vehicle import driver, parameters


def main(road, samples, vehicle, calibration, runs, config, output):
    course = simulate.prepare(store.read(road))
    places(course.u[0], course.u[-1], **config["space"], file=road)  # a road too short is told before it is driven on
    found = None if calibration is None else store.read(calibration)
    car, effects = calibrated.apply(found, parameters.read(vehicle), config["effects"])
    first, last = (int(number) for number in runs.split("-"))
    drawn = store.read(samples).sel(run=slice(first, last))
    aim = config["speed"]
    drives = simulate.runs(
        course,
        car,
        speed=driver.speed_profile(
            course.road,
            limit=aim["limit_km_h"] / 3.6,
            lateral_acceleration=aim["lateral_acceleration"],
            acceleration=aim["acceleration"],
            deceleration=aim["deceleration"],
        ),
        **{name: drawn[name].values for name in drawn},
        effects=effects,
        effects_folder=config["effects_folder"],
        **config["simulation"],
        progress=countdown(drawn.sizes["run"], "runs"),
    )
    store.write(
        drives.assign_coords(run=drawn["run"]),
        output,
        title=f"Simulated drives on {config['site']}",
        configuration=config,
        compress=False,
    )


if __name__ == "__main__":
    Command(
        main, inputs=("road", "samples", "vehicle"), optional=("calibration",), texts=("runs",)
    ).run()
