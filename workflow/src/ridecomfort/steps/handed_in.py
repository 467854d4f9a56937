"""Take drives that another simulator made of a site's samples in place of the study's own."""

import numpy as np
import xarray as xr

from ridecomfort import store
from ridecomfort.drive import readers, record
from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command
from ridecomfort.vocabulary import DRIVE, describe


def main(files, runs, config, output):
    first, last = (int(number) for number in runs.split("-"))
    drives = [_at_centre_of_gravity(path, config["rate"]) for path in files[first : last + 1]]
    numbered = xr.concat(drives, xr.DataArray(np.arange(first, last + 1), dims="run", name="run"), join="outer")
    store.write(
        describe(numbered.astype(np.float32)),
        output,
        title=f"Drives of another simulator on {config['site']}",
        configuration=config,
        compress=False,
    )


def _at_centre_of_gravity(path, rate):
    """The quantities of a drive at ``rate`` (Hz), its accelerations (m/s2) those of the centre of gravity wherever the file has them from. Raises
    InputError without a distance ``s`` and where that falls."""
    drive = readers.read(path, rate=rate, gravity=False, measured=False)
    if not drive.attrs["place_measured"]:
        raise InputError("is missing (expected the distance along the reference line, which v_x does not tell)", file=path, place="s")
    s = drive["s"].values.astype(np.float32)  # as it is stored: what falls by less than its rounding stands
    back = np.flatnonzero(np.diff(s) < 0)
    if back.size:
        i = back[0]
        fall = f"falls from {s[i]:.2f} to {s[i + 1]:.2f} m at {drive['time'].values[i]:.2f} s"
        raise InputError(f"{fall} (expected a drive that never runs backwards)", file=path, place="s")
    if any(drive.attrs[f"sensor_{axis}"] for axis in "xyz"):
        drive = record.transfer(drive, (0.0, 0.0, 0.0))
    return drive[list(DRIVE)]


if __name__ == "__main__":
    Command(main, inputs=("files",), many=("files",), texts=("runs",)).run()
