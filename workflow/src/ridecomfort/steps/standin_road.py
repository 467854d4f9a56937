"""The road of a stand-in site, made from a seed: an OpenCRG file, and sealed apart from it how it was made."""

import json

from ridecomfort import store
from ridecomfort.comfort import iri, iriclass
from ridecomfort.road import crg
from ridecomfort.standin import site
from ridecomfort.steps.command import Command


def main(config, output, truth):
    road, known = site.make_road(config["site"], config, iri.iri, iriclass.Edges().at)
    crg.write(output, road, comment=f"Stand-in road {config['site']}, made from seed {config['seed']}")
    with store.replacing(truth) as part:
        part.write_text(json.dumps(known, indent=1) + "\n")


if __name__ == "__main__":
    Command(main, outputs=("output", "truth")).run()
