"""Write tables and figures of the verdict and of the evidence behind it."""

from ridecomfort.report import catalogue, diagnosed
from ridecomfort.steps import results as study_results
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(results, later, config, output, workers):
    diagnosis = study_results.diagnosis(results, config, later)
    written.tables(diagnosed.tables(diagnosis), output / "tables")
    written.figures(diagnosed.figures(diagnosis), output / "figures", int(workers))
    if not all(config["diagnosed"].values()):  # of real drives nothing hidden is known: a score that lies there is an earlier study's
        study_results.drop(output / "tables", lambda name: name in catalogue.SCORE_TABLES)


if __name__ == "__main__":
    Command(main, inputs=("results",), many=("later",), optional=("later",), texts=("workers",)).run()
