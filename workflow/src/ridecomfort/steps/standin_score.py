"""Score the verdict on stand-in drives against the sealed truth about them. Nothing else reads it."""

import json

from ridecomfort import store
from ridecomfort.discrepancy.score import score
from ridecomfort.report import diagnosed
from ridecomfort.report.catalogue import label
from ridecomfort.report.study import Diagnosis
from ridecomfort.steps import written
from ridecomfort.steps.command import Command


def main(truth, verdict, ranking, config, output, tables):
    said = json.loads(verdict.read_text(encoding="utf-8"))
    hidden = json.loads(truth[0].read_text(encoding="utf-8"))["effects"]
    found = score(said, hidden, config["effects"], config["effects_folder"])
    with store.replacing(output) as part:
        part.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    sites = tuple(config["sites"])
    files = {"score": output.as_posix()}
    shown = Diagnosis(said, store.read(ranking), files, config["model"], sites, tuple(map(label, sites)), found)
    written.tables(diagnosed.scores(shown), tables)


if __name__ == "__main__":
    Command(main, inputs=("truth", "verdict", "ranking"), outputs=("output", "tables"), many=("truth",)).run()
