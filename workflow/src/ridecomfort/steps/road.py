"""The road as it is used: read from an OpenCRG file, checked, cleaned as the site asks, every step in the log."""

import sys

from ridecomfort import store
from ridecomfort.comfort import iri
from ridecomfort.errors import InputError
from ridecomfort.road import prepare, wheeltracks
from ridecomfort.steps.command import Command


def main(road, config, output):
    prepared = prepare.prepare(road, **config.get("options", {}))
    used = prepared.used
    if prepared.smoothed is not None and (said := _smoothed(prepared)):
        used.attrs["treatment"] += f"\n{said}"
    if remark := iri.coarse(float(used.u[1] - used.u[0])):
        used.attrs["treatment"] += f"\nIRI of the wheel tracks: {remark}"
    print(used.treatment, file=sys.stderr)
    used.attrs["standin"] = int(config.get("standin", False))
    store.write(used, output, title=f"Road of {config.get('site', road.stem)}", configuration=config)


def _smoothed(prepared) -> str:
    """What smoothing did to the IRI of the usual wheel tracks; nothing where one of them is not on the road."""
    states = prepared.repaired, prepared.smoothed
    try:
        profiles = [wheeltracks.tracks(state) for state in states]
    except InputError:
        return ""
    spacing = float(prepared.used.u[1] - prepared.used.u[0])
    before, after = (iri.iri(each, spacing).mean() for each in profiles)
    places = " and ".join(f"{track:g}" for track in wheeltracks.WHEEL_TRACKS)
    return f"smoothing took the IRI of the wheel tracks at {places} m from {before:.3f} to {after:.3f} m/km"


if __name__ == "__main__":
    Command(main, inputs=("road",)).run()
