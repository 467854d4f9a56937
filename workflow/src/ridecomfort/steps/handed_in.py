"""Take drives that another simulator made of a site's samples in place of the study's own."""

import numpy as np
import xarray as xr

from ridecomfort import store
from ridecomfort.drive import readers
from ridecomfort.steps.command import Command
from ridecomfort.vocabulary import DRIVE, describe


def main(files, runs, config, output):
    first, last = (int(number) for number in runs.split("-"))
    drives = [readers.read(path, rate=config["rate"], gravity=False, measured=False)[list(DRIVE)] for path in files[first : last + 1]]
    numbered = xr.concat(drives, xr.DataArray(np.arange(first, last + 1), dims="run", name="run"), join="outer")
    store.write(
        describe(numbered.astype(np.float32)),
        output,
        title=f"Drives of another simulator on {config['site']}",
        configuration=config,
        compress=False,
    )


if __name__ == "__main__":
    Command(main, inputs=("files",), many=("files",), texts=("runs",)).run()
