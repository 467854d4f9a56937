"""The score test: its p-values hold where nothing is missing, and it names what is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom, norm

from ridecomfort.discrepancy import evidence, spectrum

from .coloured import coloured

RATE, SAMPLES, BAND = 100.0, 4000, (0.3, 40.0)


def candidates(rng, count=12):
    """Responses that look like errors do: coloured over all channels."""
    return np.stack([coloured(rng, SAMPLES) for _ in range(count)])


def whitened(residual, others):
    white = spectrum.Whitening(spectrum.cross_spectrum([residual], RATE), RATE, BAND)
    return white(residual).ravel(), white(others).reshape(len(others), -1)


BLOCKS = [np.tile(np.arange(SAMPLES) // length, 4) for length in (100, 25)]


def p_of_noise(rng, whiten=whitened):
    residual = coloured(rng, SAMPLES)
    columns = candidates(rng)
    flat, rows = whiten(residual, columns)
    found = evidence.score_test(flat, rows[:3], rows[3:], BLOCKS, resamples=399, seed=[int(rng.integers(2**31))])
    return found.p_value.min()


def test_false_alarms_over_the_whole_library_are_as_rare_as_promised():
    rng = np.random.default_rng(0)
    trials = 150
    alarms = sum(p_of_noise(rng) <= 0.05 for _ in range(trials))
    lower, upper = binom.interval(0.998, trials, 0.05)
    assert lower <= alarms <= upper


def test_scores_of_white_noise_are_normal():
    """Of one column: twice the upper tail of the normal distribution; where only positive sizes are physical, once."""
    rng = np.random.default_rng(5)
    noise, column = rng.standard_normal(SAMPLES), rng.standard_normal((1, SAMPLES))
    column /= np.linalg.norm(column)
    residual = noise - (noise @ column[0] + 2.0) * column[0]
    blocks = [np.arange(SAMPLES) // 100]
    for sign, expected in ((0, 2 * norm.sf(2.0)), (1, norm.sf(2.0))):
        found = evidence.score_test(residual, column[:0], column, blocks, sign=[sign], resamples=20000)
        assert found.white_p_value[0] == pytest.approx(expected, rel=0.15)


def test_blocks_that_agree_on_little_are_no_evidence_against_white_noise():
    """Forty blocks with the same small score: signs that all agree, and two thirds of a standard deviation together."""
    column = np.ones((1, SAMPLES)) / np.sqrt(SAMPLES)
    residual = np.tile([1.0, -1.0], SAMPLES // 2) - 0.65 * column[0]
    found = evidence.score_test(residual, column[:0], column, [np.arange(SAMPLES) // 100])
    assert found.p_value[0] < 0.002 and found.white_p_value[0] == pytest.approx(2 * norm.sf(0.65), rel=0.1)


def test_columns_that_are_alike_count_once_in_white_noise():
    rng = np.random.default_rng(6)
    residual, column = rng.standard_normal(SAMPLES), rng.standard_normal((1, SAMPLES))
    alone, thrice = (
        evidence.score_test(residual, column[:0], np.repeat(column, count, axis=0), [np.arange(SAMPLES) // 100], resamples=20000)
        for count in (1, 3)
    )
    np.testing.assert_allclose(thrice.white_p_value, alone.white_p_value[0], atol=0.02)


def test_a_missing_response_is_found_and_measured():
    rng = np.random.default_rng(1)
    residual, columns = coloured(rng, SAMPLES), candidates(rng)
    flat, rows = whitened(residual - 0.1 * columns[7], columns)
    found = evidence.score_test(flat, rows[:3], rows[3:], BLOCKS, seed=[3])
    assert np.argmin(found.p_value) == 4 and found.p_value[4] < 0.01
    column = found.projected[4]
    assert -column @ found.residual / (column @ column) == pytest.approx(0.1, abs=3 / np.linalg.norm(column))


def test_what_calibration_may_change_is_absorbed():
    rng = np.random.default_rng(2)
    residual, columns = coloured(rng, SAMPLES), candidates(rng, 3)
    mixed = np.concatenate([columns, columns[:1] + 1e-6 * columns[1:2]])
    flat, rows = whitened(residual - 0.5 * columns[0], mixed)
    found = evidence.score_test(flat, rows[:1], rows[1:], BLOCKS)
    assert found.absorbed[-1] > 0.999 and found.p_value.min() > 0.05


def test_a_one_sided_effect_is_not_found_with_the_wrong_sign():
    rng = np.random.default_rng(3)
    residual, columns = coloured(rng, SAMPLES), candidates(rng, 4)
    flat, rows = whitened(residual + 0.3 * columns[1], columns)
    two_sided = evidence.score_test(flat, rows[:0], rows, BLOCKS)
    one_sided = evidence.score_test(flat, rows[:0], rows, BLOCKS, sign=[1, 1, 1, 1])
    assert two_sided.p_value[1] < 0.01 and one_sided.p_value[1] > 0.5
    assert one_sided.group_gain[1] == 0.0


def test_canonical_correlation_of_mixtures_and_of_strangers():
    rng = np.random.default_rng(4)
    one = rng.standard_normal((2, 4000))
    assert evidence.canonical_correlation(one, np.array([[1.0, 2.0]]) @ one) == pytest.approx(1.0)
    assert evidence.canonical_correlation(one, rng.standard_normal((2, 4000))) < 0.1


def test_white_series_are_white_and_independent():
    rng = np.random.default_rng(5)
    series = [coloured(rng, 20000) for _ in range(2)]
    white = spectrum.Whitening(spectrum.cross_spectrum(series[:1], RATE), RATE, (0.0, 50.0))(series[1])
    found = spectrum.cross_spectrum([white], RATE)
    inner = (found.frequency > 0.5) & (found.frequency < 49)
    assert np.abs(found.density[inner].mean(axis=0) - np.eye(4)).max() < 0.06
