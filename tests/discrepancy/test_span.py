"""What is taken out piece by piece against the same with whole rows."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import span, spectrum

from .coloured import coloured

RATE, SAMPLES, BAND = 100.0, 6000, (0.5, 40.0)


@pytest.fixture(scope="module")
def made():
    """Rows of which two are there all along and others for a while, and what makes their noise white."""
    rng = np.random.default_rng(0)
    rows = np.stack([coloured(rng, SAMPLES) for _ in range(7)])
    window = np.hanning(1200)
    for k, start in enumerate((0, 900, 900, 2500, 4800)):
        shape = np.zeros(SAMPLES)
        shape[start : start + 1200] = window
        rows[k] = rows[k] * shape
    series = coloured(rng, SAMPLES)
    whitening = spectrum.Whitening(spectrum.cross_spectrum([series], RATE), RATE, BAND)
    return rows, series, whitening


def test_what_is_left_out_at_the_ends_makes_no_sample_beside_it_weigh_more():
    rng = np.random.default_rng(1)
    white = rng.standard_normal((6, 4000))
    white[:, :100] = white[:, -100:] = 0.0
    scale = spectrum.local_scale(white, RATE)
    assert scale[100:3900] == pytest.approx(1.0, abs=0.1)


def test_rows_of_one_place_are_one_piece(made):
    apart = span.taken_apart(made[0])
    assert sorted(tuple(piece.numbers) for piece in apart.pieces) == [(0,), (1, 2), (3,), (4,), (5, 6)]
    whole = np.zeros_like(made[0])
    for piece in apart.pieces:
        whole[piece.numbers, :, piece.place] = piece.rows
    np.testing.assert_array_equal(whole, made[0])


def test_white_pieces_are_those_of_the_whole_rows(made):
    rows, _, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    expected = whitening(rows)
    found = np.zeros_like(expected)
    for piece in own.white:
        found[piece.numbers, :, piece.place] = piece.rows
    assert np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2)) < 0.02


def test_amounts_are_the_likely_ones_of_whole_rows(made):
    rows, series, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    mixed = whitening(series + np.tensordot([3.0, -2.0, 1.0, 4.0, 2.0, -1.0, 0.5], rows, 1))
    matrix = whitening(rows).reshape(len(rows), -1)
    normal = matrix @ matrix.T + np.eye(len(rows))
    np.testing.assert_allclose(own.amounts(mixed), np.linalg.solve(normal, matrix @ mixed.ravel()), atol=0.02)


def test_what_is_left_weighs_as_noise_and_rows_of_the_usual_size_do_together(made):
    rows, series, whitening = made
    rows = 0.03 * rows  # so that neither all nor nothing is taken
    own = span.Span(span.taken_apart(rows), whitening)
    matrix, white = whitening(rows).reshape(len(rows), -1), whitening(series)
    product = matrix @ white.ravel()
    expected = np.sum(white**2) - product @ np.linalg.solve(matrix @ matrix.T + np.eye(len(rows)), product)
    assert np.sum(white**2) - expected > 1.0
    assert np.sum(own.without(white) ** 2) == pytest.approx(expected, rel=1e-4)
    assert own.shares(white[None])[0][0] == pytest.approx(expected, rel=1e-4)


def test_rows_of_any_size_are_gone_and_such_of_none_stay(made):
    rows, series, whitening = made
    held = whitening(series + np.tensordot([3.0, -2.0, 1.0, 4.0, 2.0, -1.0, 0.5], rows, 1))
    large, small = (span.Span(span.taken_apart(factor * rows), whitening) for factor in (1e3, 1e-6))
    matrix = whitening(rows).reshape(len(rows), -1)
    left = held.ravel() - np.linalg.lstsq(matrix.T, held.ravel(), rcond=None)[0] @ matrix
    assert np.linalg.norm(large.without(held).ravel() - left) < 0.03 * np.linalg.norm(left)
    np.testing.assert_allclose(small.without(held), held, atol=1e-6)


def test_a_series_is_cleaned_of_the_rows_that_it_holds(made):
    rows, _, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    held = np.tensordot([3.0, -2.0, 1.0, 4.0, 2.0, -1.0, 0.5], rows, 1)
    assert np.sqrt(np.mean(own.cleaned(held) ** 2)) < 0.01 * np.sqrt(np.mean(held**2))
