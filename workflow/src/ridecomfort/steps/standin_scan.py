"""A stand-in laser scan of a road, made from a seed: its profiles and its trajectory, as `steps.survey` takes them."""

import netCDF4
import numpy as np

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.road import crg
from ridecomfort.standin import scan
from ridecomfort.steps.command import Command


def main(road, config, output, trajectory):
    try:
        scanner = scan.Scanner(**config.get("scanner", {}))
    except TypeError as problem:
        raise InputError(str(problem).split("() ")[-1], place="scanner") from None
    surface = crg.read(road, interpolation="cubic")
    true, measured = scan.trajectory(surface, config["seed"], scanner)
    store.write(measured, trajectory, title=f"Stand-in trajectory over {road.stem}", configuration=config)
    with store.replacing(output) as part, netCDF4.Dataset(part, "w") as recorded:
        recorded.title = f"Stand-in laser scan of {road.stem}, made from seed {config['seed']}"
        recorded.Conventions = store.CONVENTIONS
        recorded.createDimension("profile", None)
        recorded.createDimension("point", scanner.points)
        time = recorded.createVariable("time", "f8", ("profile",))
        across = recorded.createVariable("across", "f4", ("point",))
        height = recorded.createVariable(
            "height", "f4", ("profile", "point"), zlib=True, complevel=1, shuffle=True, fill_value=np.nan,
            chunksizes=(500, scanner.points), significant_digits=5,
        )  # fmt: skip
        for variable, unit, meaning in (
            (time, "s", "time since the start of the drive"),
            (across, "m", "distance to the left of the scanner"),
            (height, "m", "height of the point above the scanner"),
        ):
            variable.units, variable.long_name = unit, meaning
        for block in scan.profiles(surface, true, config["seed"], scanner):
            count = len(time)
            across[:] = block.across
            time[count:] = block.time
            height[count : count + len(block.time)] = block.height


if __name__ == "__main__":
    Command(main, inputs=("road",), outputs=("output", "trajectory")).run()
