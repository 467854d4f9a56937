"""Simulate some of a site's runs: each its own speed, lateral position and road friction."""

from functools import partial

from ridecomfort import calibrated, simulate, store
from ridecomfort.space import places
from ridecomfort.steps.command import Command, countdown
from ridecomfort.vehicle import driver, parameters

SWAY = 0.2
"""m by which a wheel may leave the road on the way. On the stand-in sites drivers sway by 0.1 m about where they aim for, that of the
van by 0.2 m."""


def main(road, samples, vehicle, calibration, runs, config, output):
    course = simulate.prepare(store.read(road))
    # A road too short or too narrow is told before it is driven on.
    evaluated = places(course.u[0], course.u[-1], **config["space"], file=road)
    found = None if calibration is None else store.read(calibration)
    car, effects = calibrated.apply(found, parameters.read(vehicle), config["effects"])
    first, last = (int(number) for number in runs.split("-"))
    drawn = store.read(samples).sel(run=slice(first, last))
    on_road = partial(simulate.check_on_road, course.road, car)
    for number, lateral in zip(drawn["run"].values, drawn["lateral_position"].values):
        on_road(lateral, file=samples, place=f"run {number}")
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
    for number, s, e in zip(drawn["run"].values, drives["s"].values, drives["e"].values):
        inside = (s >= evaluated[0]) & (s <= evaluated[-1])
        on_road(e[inside], s[inside], beyond=SWAY, file=road, place=f"run {number}")
    store.write(
        drives.assign_coords(run=drawn["run"]),
        output,
        title=f"Simulated drives on {config['site']}",
        configuration=config,
        seed=drawn.attrs.get("seed"),
        compress=False,
    )


if __name__ == "__main__":
    Command(
        main, inputs=("road", "samples", "vehicle"), optional=("calibration",), texts=("runs",)
    ).run()
