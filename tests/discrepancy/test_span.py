"""Projection on pieces against that on whole rows."""

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


def test_the_projection_is_that_of_least_squares_on_whole_rows(made):
    rows, series, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    mixed = whitening(series + np.tensordot([3.0, -2.0, 1.0, 4.0, 2.0, -1.0, 0.5], rows, 1))
    matrix = whitening(rows).reshape(len(rows), -1)
    amounts = np.linalg.lstsq(matrix.T, mixed.ravel(), rcond=None)[0]
    np.testing.assert_allclose(own.amounts(mixed), amounts, atol=0.02)
    left = mixed.ravel() - amounts @ matrix
    assert np.linalg.norm(own.without(mixed).ravel() - left) < 0.03 * np.linalg.norm(left)
    assert own.shares(mixed[None])[0][0] == pytest.approx(left @ left, rel=2e-3)


def test_what_is_projected_out_is_gone_for_good(made):
    rows, series, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    once = own.without(whitening(series))
    np.testing.assert_allclose(own.without(once), once, atol=1e-9)


def test_a_repeated_row_changes_nothing(made):
    rows, series, whitening = made
    once, twice = (span.Span(span.taken_apart(given), whitening) for given in (rows, np.concatenate([rows, rows[3:4]])))
    white = whitening(series)
    np.testing.assert_allclose(twice.without(white), once.without(white), atol=1e-6)


def test_a_series_is_cleaned_of_the_rows_that_it_holds(made):
    rows, _, whitening = made
    own = span.Span(span.taken_apart(rows), whitening)
    held = np.tensordot([3.0, -2.0, 1.0, 4.0, 2.0, -1.0, 0.5], rows, 1)
    assert np.sqrt(np.mean(own.cleaned(held) ** 2)) < 0.01 * np.sqrt(np.mean(held**2))
