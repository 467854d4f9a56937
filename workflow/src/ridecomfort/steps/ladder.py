"""Put the errors of a chain of models side by side: the error ladder over all measured sites."""

from ridecomfort import store
from ridecomfort.discrepancy import ladder
from ridecomfort.steps.command import Command, note

NEEDED = ("nrmse", "explainable_rmse", "floor_rmse", "square_by_stretch", "role")


def main(comparisons, sections, config, output):
    sites, models = config["sites"], config["models"]
    keys = [(site, model) for site in sites for model in models]
    compared = {key: store.read(path, NEEDED) for key, path in zip(keys, comparisons, strict=True)}
    graded = {key: store.read(path) for key, path in zip(keys, sections, strict=True)}
    measured = {
        site: ladder.Measured(
            {model: compared[site, model] for model in models}, {model: graded[site, model] for model in models}, fitted
        )
        for site, fitted in sites.items()
    }
    found = ladder.ladder(measured, models, config["titles"])
    for site, words in (*ladder.risen(found), *ladder.worsened(found)):
        note(f"{site}: {words}")
    store.write(found, output, title="Error ladder", configuration=config)


if __name__ == "__main__":
    Command(main, inputs=("comparisons", "sections"), many=("comparisons", "sections")).run()
