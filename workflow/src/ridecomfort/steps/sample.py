"""Draw the random inputs of a site's runs."""

from ridecomfort import store
from ridecomfort.sample import sample
from ridecomfort.steps.command import Command


def main(config, output):
    samples = sample(
        config["sampling"], config["runs"], seed=config["seed"], site=config["site"], method=config["method"]
    )
    store.write(
        samples,
        output,
        title=f"Inputs of the simulated drives on {config['site']}",
        configuration=config,
        seed=config["seed"],
    )


if __name__ == "__main__":
    Command(main).run()
