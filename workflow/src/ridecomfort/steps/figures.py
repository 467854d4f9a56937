"""Draw every figure of the study as PNG and PDF."""

from ridecomfort.report import catalogue, figures, style
from ridecomfort.steps import results as study_results
from ridecomfort.steps.command import Command
from ridecomfort.store import replacing


def main(results, config, output):
    study = study_results.load(results, config)
    for name in catalogue.figures(config["sites"]):
        drawn = figures.draw(study, name)
        for suffix in style.METADATA:
            with replacing(output / f"{name}{suffix}") as part:
                style.save(drawn, part)
    study_results.drop_others(output, config["sites"])


if __name__ == "__main__":
    Command(main, inputs=("results",)).run()
