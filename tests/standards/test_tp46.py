"""The quarter-car of the IRI against World Bank Technical Paper 46 and its analytic gain."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from ridecomfort.comfort import iri, quartercar

# Sayers, Gillespie and Paterson (1986), World Bank Technical Paper 46, table of state transition
# coefficients at 80 km/h: spacing in m, element, printed value.
PRINTED = [
    (0.05, "ST11", 0.9998452), (0.05, "ST43", -10.2297), (0.05, "PR4", 9.331372),
    (0.1, "ST22", 0.975036), (0.1, "ST41", 1.687312), (0.1, "PR2", 0.2490886),
    (0.25, "ST11", 0.9966071), (0.25, "ST13", -0.002083274), (0.25, "ST44", 0.4347564), (0.25, "PR4", 35.79262),
]  # fmt: skip

# IRI in mm/m of a sine of 1 mm amplitude: 4 / wavelength times the gain of the quarter-car at 80 km/h.
SINE = [(1.25, 1.5315106), (2.4, 2.7733391), (5.0, 0.93573274), (15.4, 0.39872446), (30.0, 0.060641542)]

SINGLE_PRECISION = {"PR1": 1e-3, "PR3": 5e-6}
"""Elements in which the printed table shows the cancellation of its computer's arithmetic."""


def element(spacing: float, name: str) -> float:
    st, pr = quartercar.transition(spacing)
    return pr[int(name[2]) - 1] if name.startswith("PR") else st[int(name[2]) - 1, int(name[3]) - 1]


@pytest.mark.parametrize("spacing, name, printed", PRINTED)
def test_coefficients_to_print_accuracy(spacing, name, printed):
    assert element(spacing, name) == pytest.approx(printed, rel=1e-6)


def test_every_coefficient(shared):
    with open(shared / "references/iri_tp46_coefficients.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 60
    for row in rows:
        found = element(float(row["dx_m"]), row["element"])
        assert found == pytest.approx(float(row["computed_exact"]), rel=2e-9), row
        rounding = SINGLE_PRECISION.get(row["element"], 1.1e-6)
        assert found == pytest.approx(float(row["published_TP46"]), rel=rounding), row


def iri_of_sine(wavelength: float, spacing: float = 0.01) -> float:
    """IRI of a sine of 1 mm over whole periods, behind 100 m for the start to die away."""
    periods = int(np.ceil(max(100.0, 3 * wavelength) / wavelength))
    s = np.arange(0, 2 * periods * wavelength + 1, spacing)
    response = quartercar.respond(1e-3 * np.sin(2 * np.pi * s / wavelength), spacing, moving_average=None)
    return float(response.between(periods * wavelength, 2 * periods * wavelength))


@pytest.mark.parametrize("wavelength, expected", SINE)
def test_sine_within_0_02_percent(wavelength, expected):
    assert iri_of_sine(wavelength) == pytest.approx(expected, rel=2e-4)


def test_every_sine_from_1_m(shared):
    with open(shared / "references/iri_gain_analytic.csv") as file:
        rows = [row for row in csv.DictReader(file) if float(row["wavelength_m"]) >= 1.0]
    for row in rows:
        wavelength = float(row["wavelength_m"])
        gain = quartercar.GOLDEN_CAR.gain(quartercar.SPEED / wavelength)
        assert gain == pytest.approx(float(row["gain"]), rel=1e-7)
        assert iri_of_sine(wavelength) == pytest.approx(float(row["IRI_mm_per_m_of_sine_amplitude_1mm"]), rel=2e-4)


def test_constant_slope_of_the_standard_loses_what_theory_says():
    """Linear between samples, a sine of wavelength L loses (pi dx / L)^2 / 3 of its amplitude."""
    s = np.arange(0, 400, 0.05)
    profile = 1e-3 * np.sin(2 * np.pi * s / 2.0)
    exact, linear = (
        float(quartercar.respond(profile, 0.05, moving_average=None, between=between).between(200, 398))
        for between in ("cubic", "linear")
    )
    assert 1 - linear / exact == pytest.approx((np.pi * 0.05 / 2.0) ** 2 / 3, rel=0.02)


def test_the_public_door_gives_the_same():
    s = np.arange(0, 960.001, 0.01)
    found = iri.iri(1e-3 * np.sin(2 * np.pi * s / 2.4), 0.01, segment=96.0, moving_average=None)
    assert found.shape == (10,)
    assert found[1:] == pytest.approx(2.7733391, rel=2e-4)
