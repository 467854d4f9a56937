"""Comfort bands of ISO 2631-1 with their overlaps."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.comfort import bands
from ridecomfort.errors import InputError

# ISO 2631-1:1997 C.2.3.
EXAMPLES = [(0.2, ["NU"]), (0.4, ["LU"]), (0.55, ["LU", "FU"]), (0.7, ["FU"]), (0.9, ["FU", "U"]),
            (1.1, ["U"]), (1.4, ["U", "VU"]), (1.8, ["VU"]), (2.2, ["VU", "EU"]), (9.0, ["EU"])]  # fmt: skip


@pytest.mark.parametrize("value, names", EXAMPLES)
def test_a_value_reports_every_band_that_it_lies_in(value, names):
    assert bands.names(value) == names
    assert np.array(list(bands.BANDS))[bands.membership(value)].tolist() == names


@pytest.mark.parametrize("value, names", EXAMPLES)
def test_one_label_by_rule(value, names):
    order = list(bands.BANDS)
    assert order[bands.label(value, "severe")] == names[-1]
    assert order[bands.label(value, "mild")] == names[0]


def test_middle_of_an_overlap_divides_it():
    assert bands.boundaries("middle") == pytest.approx([0.315, 0.565, 0.9, 1.425, 2.25])
    assert bands.label([0.56, 0.57, np.nan], "middle").tolist() == [1, 2, -1]


def test_configured_bands():
    assert bands.edges({"FU": [0.5, None], "NU": [0, 0.6]}) == {"NU": (0.0, 0.6), "FU": (0.5, np.inf)}
    with pytest.raises(InputError, match="nothing between"):
        bands.edges({"NU": [0, 0.3], "LU": [0.4, None]})
    with pytest.raises(InputError, match="follow upon each other"):
        bands.edges({"NU": [0, 0.9], "LU": [0.4, 0.8]})
    for gap in ({"NU": [0.1, 0.3], "LU": [0.3, None]}, {"NU": [0, 0.3], "LU": [0.3, 2.0]}):
        with pytest.raises(InputError, match="expected 0 and null: every value lies in a band"):
            bands.edges(gap)
    with pytest.raises(InputError, match="rule"):
        bands.label(0.5, "worst")
