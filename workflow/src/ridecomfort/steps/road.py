"""The road as it is used: read from an OpenCRG file, checked, cleaned as the site asks, every step in the log."""

import sys

from ridecomfort import store
from ridecomfort.comfort import iri, iriclass
from ridecomfort.errors import InputError
from ridecomfort.road import clean, crg, smoothing
from ridecomfort.steps.command import Command

SMOOTHING = ("none", "cross-validation")


def main(road, config, output):
    options = {"interpolation": "cubic", "smoothing": SMOOTHING[0], **config.get("options", {})}
    asked = options.pop("smoothing")
    if asked not in SMOOTHING:
        raise InputError(f"{asked!r}, expected one of {', '.join(SMOOTHING)}", file=road, place="road.smoothing")
    cleaning = {name: value for name, value in options.items() if name in clean.CHOICES}
    reading = {name: value for name, value in options.items() if name not in cleaning}
    reading["holes"] = "keep" if cleaning.get("holes") == "fill" else "refuse"
    measured = crg.read(road, **reading)
    try:
        used, _ = clean.clean(measured, **cleaning)
        if asked == "cross-validation":
            used = smoothed(used)
    except InputError as problem:
        raise InputError(str(problem), file=road) from None
    print(used.treatment, file=sys.stderr)
    used.attrs["standin"] = int(config.get("standin", False))
    store.write(used, output, title=f"Road of {config.get('title', road.stem)}", configuration=config)


def smoothed(road):
    """The road smoothed by cross-validated splines; its treatment says what that did to the IRI of the wheel tracks."""
    smooth, _ = smoothing.smooth_surface(road)
    spacing = float(road.u[1] - road.u[0])
    before, after = (iri.iri(iriclass.tracks(state), spacing).mean() for state in (road, smooth))
    smooth.attrs["treatment"] += f"\nsmoothing took the IRI of the wheel tracks from {before:.3f} to {after:.3f} m/km"
    return smooth


if __name__ == "__main__":
    Command(main, inputs=("road",)).run()
