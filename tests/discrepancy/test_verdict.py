"""A verdict in words."""

from __future__ import annotations

from dataclasses import replace

from tests.discrepancy.verdicts import NOTHING


def test_a_question_among_the_reasons_stays_one():
    said = replace(NOTHING, verdict="suspect", reasons=("a_y runs against the model: is its sign right?", "the clock is off"))
    assert said.words().endswith("a_y runs against the model: is its sign right? The clock is off.")


def test_names_that_begin_a_reason_are_written_as_they_are():
    said = replace(NOTHING, reasons=("crosswind: not surely better on drives held out", "top_mount helps", "less than half"))
    assert said.words().endswith("crosswind: not surely better on drives held out. top_mount helps. Less than half.")
