"""Write every table of the study, ours beside the published figures, in every form."""

from ridecomfort.report import claims, table, tables
from ridecomfort.steps import results as study_results
from ridecomfort.steps.command import Command
from ridecomfort.store import replacing


def main(results, config, output):
    study = study_results.load(results, config)
    made = tables.make(study)
    made |= claims.tables(study, made)
    for name, each in made.items():
        for suffix, written in table.WRITERS.items():
            with replacing(output / f"{name}{suffix}") as part:
                part.write_text(written(each), encoding="utf-8")
    study_results.drop_others(output, config["sites"])


if __name__ == "__main__":
    Command(main, inputs=("results",)).run()
