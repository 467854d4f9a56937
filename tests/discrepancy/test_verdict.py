"""A verdict in words."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from pathlib import Path

from ridecomfort.discrepancy.beyond import AtBound, Beyond, BeyondBounds
from ridecomfort.discrepancy.off_file import OffFile
from ridecomfort.discrepancy.verdict import Named, Verdict, is_of_little, left_of
from tests.discrepancy.verdicts import FOUND, NOTHING, SIZE, SURE

READING = Path(__file__).parents[2] / "docs" / "reading.md"


def test_a_question_among_the_reasons_stays_one():
    said = replace(NOTHING, verdict="suspect", reasons=("a_y runs against the model: is its sign right?", "the clock is off"))
    assert said.words().endswith("a_y runs against the model: is its sign right? The clock is off.")


def test_names_that_begin_a_reason_are_written_as_they_are():
    said = replace(NOTHING, reasons=("crosswind: not surely better on drives held out", "top_mount helps", "less than half"))
    assert said.words().endswith("crosswind: not surely better on drives held out. top_mount helps. Less than half.")


def test_what_is_left_where_nothing_is_named_is_what_was_there_at_first():
    """Whatever was tried and is not switched on."""
    said = replace(NOTHING, at_first={"a_x": 0.055}, remainder={"a_x": 0.01})
    assert said.words().startswith("Nothing is missing that would have a name; what is left above the floor") and left_of(said.json()) == {"a_x": 0.055}
    named = replace(said, verdict="named", effects=(FOUND,))
    assert left_of(named.json()) == {"a_x": 0.01} and left_of(replace(NOTHING, remainder={"a_x": 0.01}).json()) == {"a_x": 0.01}


def test_it_is_not_called_little_where_parameters_of_the_vehicle_were_put_right_before():
    """They took most of an error that was large; what was there to explain then is what they left."""
    said = replace(NOTHING, verdict="named", effects=(FOUND,), at_first={"a_x": 0.012})
    assert "It is little" in said.words()
    stiffer = Beyond("spring_stiffness_rear", "N/m", 39000.0, (15000.0, 40000.0), (7500.0, 80000.0), 42940.0, (42450.0, 43420.0))
    right = replace(said, beyond_bounds=BeyondBounds((stiffer,), 0.9, 0.88, is_first=True))
    assert "It is little" not in right.words() and not is_of_little(right.json())
    assert "It is little" in replace(said, beyond_bounds=BeyondBounds((stiffer,), 0.1, 0.1)).words()


def test_an_effect_has_its_first_size_beside_all_and_names_are_of_what_the_verdict_claims():
    content = replace(NOTHING, verdict="named", effects=(replace(FOUND, sizes=(SIZE, SIZE)), replace(FOUND, name="other"))).json()
    first, bare = content["effects"]
    assert (first["size"], first["unit"], first["interval"]) == tuple(first["sizes"][0][key] for key in ("size", "unit", "interval"))
    assert bare["size"] is None and content["names"] == [FOUND.name, "other"]
    wrong = replace(FOUND, name="imu_lever_arm", is_of_measurement=True)
    suspect = replace(NOTHING, verdict="suspect", effects=(FOUND, wrong)).json()
    assert suspect["names"] == ["imu_lever_arm"] and len(suspect["effects"]) == 2


def test_every_key_of_a_verdict_file_is_explained():
    section = READING.read_text(encoding="utf-8").partition("### verdict.json\n")[2].partition("\n`evidence.png`")[0]
    told = set(re.findall(r"`(\w+)`", section))
    names = {own.name for kind in (Verdict, Named, Beyond, BeyondBounds, AtBound, OffFile) for own in fields(kind)}
    assert names | set(SIZE) | set(SURE.json()) | set(NOTHING.json()) <= told
