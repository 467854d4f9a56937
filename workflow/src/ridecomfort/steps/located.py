"""Draw where model and measurement differ on a site."""

from ridecomfort.report import differing
from ridecomfort.steps import results as study_results
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(results, config, output):
    (site,) = config["sites"]
    compared = study_results.compared(results, config, site)
    written.figures(differing.figures_of_site(compared, config["model"]), output)


if __name__ == "__main__":
    Command(main, inputs=("results",)).run()
