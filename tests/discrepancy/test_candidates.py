"""What is tried of an effect: its sizes, and settings that may turn it round."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy.candidates import ALIGNED, candidate
from ridecomfort.effects import library


def test_an_effect_is_tried_at_the_settings_that_may_turn_it_round():
    known = library.find()
    knees = [shape["damper_knee.knee"] for shape in candidate(known["damper_knee"].effect).shapes]
    assert knees == pytest.approx([0.1, np.sqrt(0.1 * 0.03), np.sqrt(0.1 * 0.5)])
    friction = candidate(known["suspension_friction"].effect)
    assert [shape["suspension_friction.presliding"] for shape in friction.shapes] == [0.0, 0.001]
    assert [size.key for size in friction.shaping] == ["suspension_friction.presliding"] and friction.shaping[0].shaping
    stop = [(shape["bump_stop.clearance_front"], shape["bump_stop.clearance_rear"]) for shape in candidate(known["bump_stop"].effect).shapes]
    assert stop[0] == (0.03, 0.04) and stop[1] == pytest.approx((np.sqrt(0.03 * 0.01), 0.02)) and stop[-1] == (0.01, 0.01)
    ahead = {shape["payload.ahead"] for shape in candidate(known["payload"].effect).shapes}
    assert min(ahead) < -0.8 < 0.0 < max(ahead)


def test_an_effect_is_tried_over_a_quarter_of_its_typical_sizes_and_over_those_that_it_names():
    known = {name: candidate(entry.effect) for name, entry in library.find().items()}
    bushings = known.pop("wheel_compliance")
    assert [bushings.reach(shape) for shape in range(len(bushings.shapes))] == [1.0, 4.0, 8.0]
    assert all(shape == bushings.shapes[0] for shape in bushings.shapes)
    assert {own.reach(shape) for own in known.values() for shape in range(len(own.shapes))} == {1.0}


def test_what_alignment_takes_out_is_known_by_its_name_and_an_error_of_the_measurement():
    found = {name: candidate(entry.effect) for name, entry in library.find().items()}
    assert {name for name, own in found.items() if own.is_aligned} == set(ALIGNED)
    assert all(found[name].instrument for name in ALIGNED)
