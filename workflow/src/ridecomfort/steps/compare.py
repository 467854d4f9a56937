"""Drive the model along the measured paths at the measured speeds and compare, before and after calibration."""

from ridecomfort import calibrated, simulate, store
from ridecomfort.discrepancy import compare
from ridecomfort.steps.command import Command
from ridecomfort.vehicle import parameters


def main(road, measured, vehicle, calibration, config, output):
    car = parameters.read(vehicle)
    states = {"reference": (car, {})}
    if calibration is not None:
        states["calibrated"] = calibrated.apply(store.read(calibration), car, config["effects"])
    result = compare.compare(
        store.read(measured),
        simulate.prepare(store.read(road)),
        states,
        simulate=simulate.run,
        options={"step": config["simulation"]["step"], "effects_folder": config["effects_folder"]},
    )
    store.write(
        result, output, title=f"Simulated against measured drives on {config['site']}", configuration=config
    )


if __name__ == "__main__":
    Command(main, inputs=("road", "measured", "vehicle"), optional=("calibration",)).run()
