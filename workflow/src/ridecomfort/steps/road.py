"""The road as it is used: read from an OpenCRG file, checked, cleaned as the site asks, every step in the log."""

import sys

from ridecomfort import store
from ridecomfort.comfort import iri, iriclass
from ridecomfort.road import prepare
from ridecomfort.steps.command import Command


def main(road, config, output):
    prepared = prepare.prepare(road, **config.get("options", {}))
    used = prepared.used
    spacing = float(used.u[1] - used.u[0])
    if prepared.smoothed is not None:
        before, after = (iri.iri(iriclass.tracks(state), spacing).mean() for state in (prepared.repaired, used))
        used.attrs["treatment"] += f"\nsmoothing took the IRI of the wheel tracks from {before:.3f} to {after:.3f} m/km"
    if remark := iri.coarse(spacing):
        used.attrs["treatment"] += f"\nIRI of the wheel tracks: {remark}"
    print(used.treatment, file=sys.stderr)
    used.attrs["standin"] = int(config.get("standin", False))
    store.write(used, output, title=f"Road of {config.get('site', road.stem)}", configuration=config)


if __name__ == "__main__":
    Command(main, inputs=("road",)).run()
