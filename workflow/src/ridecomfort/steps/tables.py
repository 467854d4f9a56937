"""Write every table of the study, ours beside the published figures, in every form."""

from ridecomfort.report import claims, tables
from ridecomfort.steps import results as study_results
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(results, config, output):
    study = study_results.load(results, config)
    made = tables.make(study)
    made |= claims.tables(study, made)
    written.tables(made, output)
    study_results.drop_others(output, config["sites"])


if __name__ == "__main__":
    Command(main, inputs=("results",)).run()
