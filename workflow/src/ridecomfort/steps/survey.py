"""A laser scan and its trajectory made into a road: an OpenCRG file, cleaned, every step in the log."""

import sys

from ridecomfort import store
from ridecomfort.errors import InputError
from ridecomfort.road import clean, crg, recording, survey
from ridecomfort.steps.command import Command


def main(scan, trajectory, config, output, gridded=None):
    path = recording.trajectory(trajectory)
    spacing = config.get("spacing", 0.1)
    try:
        with recording.profiles(scan) as profiles:
            road, _ = survey.grid(profiles, path, spacing=(spacing, spacing), width=config.get("width", 4.0))
        cleaned, _ = clean.clean(road, outliers="repair", holes="fill")
    except InputError as problem:
        if str(problem).startswith(str(scan)):
            raise
        raise InputError(str(problem), file=trajectory if str(problem).startswith("trajectory") else scan) from None
    print(cleaned.treatment, file=sys.stderr)
    title = f"Scanned road {config.get('site', scan.stem)}"
    if gridded is not None:
        before = road.assign(treated=cleaned.treated).assign_attrs(treatment=cleaned.treatment)
        store.write(before, gridded, title=f"{title}, as scanned", configuration=config)
    crg.write(output, cleaned, format=config.get("format", "LRFI"), comment=title)


if __name__ == "__main__":
    Command(main, inputs=("scan", "trajectory"), optional=("gridded",)).run()
