"""Frequency weightings against the tables of ISO 8041-1 and ISO 2631-1."""

from __future__ import annotations

import csv
import math

import pytest

from ridecomfort.comfort.weighting import WEIGHTINGS

# ISO 8041-1:2017 annex B, printed factors at exact third-octave centres 10^(n/10) Hz.
ANNEX_B = [
    ("Wb", 0, 0.3853), ("Wb", 8, 1.054), ("Wb", 16, 0.395),
    ("Wc", -2, 0.9292), ("Wc", 9, 0.8941),
    ("Wd", -10, 0.06242), ("Wd", 0, 1.011), ("Wd", 10, 0.2017),
    ("Wk", 0, 0.4825), ("Wk", 8, 1.054), ("Wk", 19, 0.1339),
]  # fmt: skip


@pytest.mark.parametrize("name, band, printed", ANNEX_B)
def test_factors_of_annex_b(name, band, printed):
    assert WEIGHTINGS[name].factor(10 ** (band / 10)) == pytest.approx(printed, rel=5e-4)


def test_every_factor_of_annex_b(shared):
    with open(shared / "references/iso8041_annexB.csv") as file:
        rows = [row for row in csv.DictReader(file) if row["weighting"] in WEIGHTINGS]
    assert {row["weighting"] for row in rows} == set(WEIGHTINGS)
    for row in rows:
        factor = WEIGHTINGS[row["weighting"]].factor(10 ** (int(row["band_n"]) / 10))
        assert factor == pytest.approx(float(row["factor_printed"]), rel=5e-4), row


def test_every_parameter_of_table_3(shared):
    def number(text):
        return 1 / math.sqrt(2) if text == "1/sqrt(2)" else float(text or "inf")

    with open(shared / "references/iso8041_parameters.csv") as file:
        rows = [row for row in csv.DictReader(file) if row["weighting"] in WEIGHTINGS]
    columns = {
        "f1_Hz": "f1", "Q1": "q1", "f2_Hz": "f2", "Q2": "q2", "f3_Hz": "f3", "f4_Hz": "f4", "Q4": "q4",
        "f5_Hz": "f5", "Q5": "q5", "f6_Hz": "f6", "Q6": "q6", "K": "gain",
    }  # fmt: skip
    for row in rows:
        weighting = WEIGHTINGS[row["weighting"]]
        for column, attribute in columns.items():
            assert getattr(weighting, attribute) == pytest.approx(number(row[column])), (row["weighting"], column)


def test_iso2631_tables_3_and_4_at_nominal_centres(shared):
    """The older tables are rounded to three digits and hold misprints, which their notes name."""
    with open(shared / "references/iso2631_table3.csv") as file:
        rows = [row for row in csv.DictReader(file) if not row["note"]]
    assert len(rows) > 50
    for row in rows:
        factor = 1000 * WEIGHTINGS[row["weighting"]].factor(float(row["f_nominal_Hz"]))
        assert factor == pytest.approx(float(row["factor_x1000_printed"]), rel=4e-3), row


def test_far_from_their_corners_the_stages_are_powers_of_frequency():
    """Transitions fall as 1/f above their corner, Wj has none, the step of Wk is (2.37 / 3.35)^2 below its own."""
    assert WEIGHTINGS["Wd"].factor(40.0) / WEIGHTINGS["We"].factor(40.0) == pytest.approx(2.0, rel=0.01)
    assert WEIGHTINGS["Wj"].factor(30.0) == pytest.approx(1.0, abs=0.01)
    plain = WEIGHTINGS["Wd"].factor(0.01) / WEIGHTINGS["Wk"].factor(0.01)
    assert plain == pytest.approx((3.35 / 2.37) ** 2, rel=1e-3)
