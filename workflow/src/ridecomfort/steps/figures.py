"""Draw every figure of the study as PNG and PDF."""

from functools import partial

from ridecomfort.report import catalogue, figures
from ridecomfort.steps import results as study_results
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(results, config, output, workers):
    study = study_results.load(results, config)
    drawn = {name: partial(figures.draw, study, name) for name in catalogue.figures(config["sites"])}
    written.figures(drawn, output, int(workers))
    study_results.drop_others(output, config["sites"])


if __name__ == "__main__":
    Command(main, inputs=("results",), texts=("workers",)).run()
