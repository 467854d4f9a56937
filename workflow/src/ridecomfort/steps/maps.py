"""Write the critical sections of a site on its reference line as GeoJSON, one file a method."""

import json

from ridecomfort import store
from ridecomfort.comfort import maps
from ridecomfort.comfort.georeference import GeoReference
from ridecomfort.steps.command import Command

METHODS = ("thresholds", "iso2631", "iri")


def main(road, thresholds, iso2631, iri, config, output):
    line = store.read(road, ["x", "y"])
    speed = store.read(iri, ["v_x"])["v_x"]
    place = config["geo_reference"]
    for file, target in zip((thresholds, iso2631, iri), output, strict=True):
        found = maps.geojson(
            store.read(file),
            line,
            probability=config["probability"],
            rule=config["label"],
            speed=speed,
            project=GeoReference(**place) if place else None,
            site=config["site"],
        )
        with store.replacing(target) as part:
            part.write_text(json.dumps(found, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    Command(main, inputs=("road", *METHODS), many=("output",)).run()
