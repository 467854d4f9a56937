"""A laser scan and its trajectory made into a road: an OpenCRG file, cleaned as asked, every step in the log."""

import sys

import xarray as xr

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.road import clean, crg, survey
from ridecomfort.steps.command import Command

BLOCK = 1000
"""Profiles that are held in memory at a time."""


def main(scan, trajectory, config, output):
    grid = {name: config[name] for name in ("spacing", "width") if name in config}
    path = store.read(trajectory, survey.POSE)
    try:
        with xr.open_dataset(scan, engine="netcdf4") as recorded:
            road, _ = survey.grid(profiles(recorded), path, **grid)
        road, _ = clean.clean(road, **{"outliers": "repair", "holes": "fill", **config.get("options", {})})
    except InputError as problem:
        raise InputError(str(problem), file=scan) from None
    except KeyError as problem:
        said = f"has no variable {problem}, expected height (profile, point), time (profile), across (point)"
        raise InputError(said, file=scan) from None
    except (OSError, RuntimeError) as problem:
        raise InputError(f"not a readable NetCDF file ({problem})", file=scan) from None
    print(road.treatment, file=sys.stderr)
    comment = config.get("title", f"Scanned road {scan.stem}")
    crg.write(output, road, format=config.get("format", "LRFI"), comment=comment)


def profiles(recorded: xr.Dataset):
    """The profiles of a recording (profile, point), a block at a time."""
    across = recorded["across"].values.astype(float)
    for start in range(0, recorded.sizes["profile"], BLOCK):
        part = recorded[["time", "height"]].isel(profile=slice(start, start + BLOCK))
        yield survey.Profiles(
            part["time"].values.astype(float), across, part["height"].transpose("profile", "point").values.astype(float)
        )


if __name__ == "__main__":
    Command(main, inputs=("scan", "trajectory")).run()
