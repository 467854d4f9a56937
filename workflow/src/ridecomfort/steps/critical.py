"""Grade the sections of a site's measured drives, and of the model on the same path, by thresholds and ISO 2631."""

from ridecomfort import store
from ridecomfort.discrepancy import critical
from ridecomfort.steps.command import Command

NEEDED = ("measured", "simulated", "residual", "s", "e", "role")


def main(comparison, config, output):
    found = critical.critical(
        store.read(comparison, NEEDED),
        spacing=config["spacing"],
        length=config["critical_length"],
        limits=config["thresholds"],
        weighting=config["iso2631"],
    )
    title = f"Critical sections of measured drives and their replays on {config['site']}"
    store.write(found, output, title=title, configuration=config)


if __name__ == "__main__":
    Command(main, inputs=("comparison",)).run()
