"""The verdict against what was hidden in the stand-in drives."""

from __future__ import annotations

from .. import catalogue
from ..notation import unit, words
from ..study import Diagnosis
from ..table import Column, Source, Table


def standin_score(found: Diagnosis) -> Table:
    """Every hidden effect with its true size beside what the verdict says of it, and what it names that was not hidden."""
    columns = (
        Column("effect", ("", "Effect")),
        Column("hidden", ("", "Hidden")),
        Column("found", ("", "Found")),
        Column("parameter", ("", "Size")),
        Column("unit", ("", "Unit")),
        Column("true_size", ("", "True"), ".4g"),
        Column("size", ("Found", "value"), ".4g"),
        Column("interval_lower", ("Found", "90 % from"), ".4g"),
        Column("interval_upper", ("Found", "to"), ".4g"),
        Column("covered", ("", "Interval holds the truth")),
    )
    rows = [
        (
            words(row["effect"]), _yes(row["hidden"]), row["found"], words(row["parameter"]), unit(row["unit"]), row["true_size"],
            row["size"], *(row["interval"] or (None, None)), _yes(row["covered"]),
        )
        for row in found.score["rows"]
    ]  # fmt: skip
    source = Source("all", found.files.get("score", ""), "rows", "as in the file")
    notes = (
        found.subject(),
        f"The verdict is {found.score['verdict']}. The truth is sealed beside the stand-in drives; the step that wrote this table is the "
        "only one that reads it, and nothing that was diagnosed depends on it.",
        *filter(None, [found.standin_note()]),
    )
    return Table("standin_score", catalogue.SCORE_TABLES["standin_score"], columns, tuple(rows), (source,), notes)


def _yes(value: bool | None) -> str:
    return {True: "yes", False: "no", None: ""}[value]
