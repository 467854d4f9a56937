"""Write tables of where model and measurement differ, and the error ladder as a table and a figure."""

from ridecomfort.report import differing
from ridecomfort.steps import results as study_results
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(results, config, output):
    difference = study_results.difference(results, config)
    written.tables(differing.tables(difference), output / "tables")
    written.figures(differing.figures(difference), output / "figures")


if __name__ == "__main__":
    Command(main, inputs=("results",)).run()
