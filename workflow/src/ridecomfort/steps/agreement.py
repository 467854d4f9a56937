"""Agreement of the comfort methods over all sites, influences on them, and the number of runs."""

from ridecomfort import store
from ridecomfort.comfort.assessment import SiteResults, gather
from ridecomfort.steps.command import Command

INPUTS = ("thresholds", "iso2631", "iri", "samples")


def main(thresholds, iso2631, iri, samples, config, output):
    files = zip(thresholds, iso2631, iri, samples, strict=True)
    results = (SiteResults(*(store.read(file) for file in each)) for each in files)
    found = gather(dict(zip(config["sites"], results, strict=True)), rule=config["label"], seed=config["seed"])
    store.write(found, output, title="Agreement of the comfort methods", configuration=config, seed=config["seed"])


if __name__ == "__main__":
    Command(main, inputs=INPUTS, many=INPUTS).run()
