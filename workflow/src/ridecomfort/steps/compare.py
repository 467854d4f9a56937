"""Drive the model along the measured paths at the measured speeds, compare, and find where the error sits."""

import sys

from ridecomfort import calibrated, pool, simulate, store
from ridecomfort.discrepancy import compare, explain, findings, locate, unlike
from ridecomfort.steps.command import Command, note
from ridecomfort.vehicle import parameters

NOT_CALIBRATED = "{site}: compared with the vehicle of its file, calibrated on no drives (no drive of role: fit, or calibrated_on: none)"

ALL_FITTED = "{site}: no drive is held out here (role: check), so that only other sites could tell whether what is fitted holds"


FLOOR = ("floor_rmse", "band_floor", "floor_density")
"""What is read of the comparison of the site that the vehicle is calibrated on."""


def main(road, measured, vehicle, calibration, config, output, workers, elsewhere=None):
    car = parameters.read(vehicle)
    states = {"reference": (car, {})}
    if calibration is not None:
        calibration = store.read(calibration)
        states["calibrated"] = calibrated.apply(calibration, car, config["effects"])
    elif config["effects"]:
        states["with_effects"] = (car, config["effects"])
    elsewhere = None if elsewhere is None else store.read(elsewhere, FLOOR)
    result = compare.compare(
        store.read(measured),
        simulate.prepare(store.read(road)),
        states,
        simulate=simulate.run,
        options={"step": config["simulation"]["step"], "effects_folder": config["effects_folder"]},
        noise_density=config["noise_density"],
        elsewhere=None if elsewhere is None else (calibration.attrs["calibrated_on"], elsewhere),
        each=pool.side_by_side(int(workers)),
    )
    located = locate.locate(result, elsewhere=elsewhere)
    words, doubts = findings.words(located), findings.doubts(located)
    result = result.merge(located).assign_attrs(**located.attrs, words="\n".join(words))
    if calibration is not None:
        result.attrs["starts"] = calibration.attrs["starts"]
    store.write(
        result,
        output,
        title=f"Simulated against measured drives on {config['site']}",
        configuration=config,
        seed=None if calibration is None else calibration.attrs.get("seed"),
    )
    for doubt in doubts:
        note(f"{config['site']}: {doubt}")
    for said in (*explain.too_short(result), *unlike.of_comparison(result)):
        note(f"{config['site']}: {said}")
    if result.attrs["near_repeats"]:
        note(f"{config['site']}: {result.attrs['near_repeats']}")
    if calibration is None:
        note(NOT_CALIBRATED.format(site=config["site"]))
    elif calibration.attrs["calibrated_on"] == config["site"] and "check" not in result["role"].values:
        note(ALL_FITTED.format(site=config["site"]))
    print(*words[len(doubts) :], sep="\n", file=sys.stderr)


if __name__ == "__main__":
    Command(main, inputs=("road", "measured", "vehicle"), optional=("calibration", "elsewhere"), texts=("workers",)).run()
