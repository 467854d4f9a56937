"""Evidence for what happens at a few places only: its shape against the errors of other places."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.stats import binom, kstest

from ridecomfort.discrepancy import event

CHANNELS, SAMPLES, EVENT = 3, 2000, slice(900, 940)

DOZEN = tuple(range(60, 1980, 160))


def a_column(rng, places=(EVENT.start,)):
    """A response that is there at one place, or some, only, (channel, sample)."""
    column = np.zeros((CHANNELS, SAMPLES))
    for place in places:
        column[:, place : place + 40] = rng.standard_normal((CHANNELS, 40))
    return column


def p_of(residuals, columns, sign=0):
    marks = [np.any(rows != 0, axis=1) for rows in columns]
    like = event.likeness(residuals, columns, marks, np.full(len(columns[0]), sign))
    return event.shift_test(like, np.arange(len(columns[0])), 50)


def test_participation_counts_the_places_that_power_is_spread_over():
    numbers = np.arange(1000) // 100
    even, single = np.ones(1000), np.where(numbers == 3, 1.0, 0.0)
    assert event.participation(np.stack([even, single]), numbers) == pytest.approx([10.0, 1.0])


def test_windows_hold_the_blocks_with_most_of_the_power():
    numbers = np.arange(1000) // 100
    column = np.where(numbers == 3, 1.0, np.where(numbers == 7, 0.5, 0.01))[None]
    assert set(numbers[event.windows(column, numbers)[0]]) == {3, 7}


def test_likeness_is_the_share_of_the_error_that_a_moved_column_explains():
    rng = np.random.default_rng(0)
    residual, column = rng.standard_normal((CHANNELS, SAMPLES)), a_column(rng)
    marks = np.any(column != 0, axis=0)
    like = event.likeness([residual], [column[None]], [marks[None]], np.zeros(1))[0]
    for shift in (0, 17, 1500):
        moved, inside = np.roll(column, shift, axis=1), np.roll(marks, shift)
        best = np.sum(moved * residual) / np.sum(moved**2)
        left = np.sum((residual - best * moved)[:, inside] ** 2) / np.sum(residual[:, inside] ** 2)
        assert like[shift] == pytest.approx(1 - left)


def test_records_move_together():
    rng = np.random.default_rng(1)
    residuals = [rng.standard_normal((CHANNELS, count)) for count in (SAMPLES, SAMPLES + 30)]
    columns = [np.pad(a_column(rng), ((0, 0), (0, part.shape[1] - SAMPLES)))[None] for part in residuals]
    marks = [np.any(rows != 0, axis=1) for rows in columns]
    like = event.likeness(residuals, columns, marks, np.zeros(1))[0]
    product = sum(np.sum(np.roll(rows[0], 5, axis=1) * own) for rows, own in zip(columns, residuals))
    power = sum(np.sum(rows**2) for rows in columns)
    within = sum(np.sum(own[:, np.roll(inside[0], 5)] ** 2) for own, inside in zip(residuals, marks))
    assert like[5] == pytest.approx(product**2 / (power * within))


def test_an_event_that_is_missing_is_found_although_it_is_one():
    rng = np.random.default_rng(2)
    columns = np.stack([a_column(rng) for _ in range(4)])
    residual = rng.standard_normal((CHANNELS, SAMPLES)) - 1.5 * columns[2]
    p_value = p_of([residual], [columns])
    assert p_value[2] < 0.005 and np.delete(p_value, 2).min() > 0.05


def test_an_amount_of_the_wrong_sign_is_none():
    rng = np.random.default_rng(3)
    column = a_column(rng)
    residual = rng.standard_normal((CHANNELS, SAMPLES)) + 1.5 * column
    assert p_of([residual], [column[None]], sign=1)[0] > 0.5 and p_of([residual], [column[None]])[0] < 0.005


def test_large_errors_at_the_place_are_no_evidence_unless_they_look_like_the_effect():
    rng = np.random.default_rng(4)
    residual = rng.standard_normal((CHANNELS, SAMPLES))
    residual[:, EVENT] *= 30.0
    assert p_of([residual], [a_column(rng)[None]])[0] > 0.02


def test_what_acts_at_a_dozen_places_counts_as_an_event_and_what_acts_all_along_does_not():
    rng = np.random.default_rng(6)
    columns = np.stack([a_column(rng, DOZEN), rng.standard_normal((CHANNELS, SAMPLES))])
    residual = rng.standard_normal((CHANNELS, SAMPLES)) - 0.4 * columns[0]
    blocks = lambda finer=1.0: np.tile(np.arange(SAMPLES) * int(finer) // 50, CHANNELS)
    frame = SimpleNamespace(
        blocks=blocks, indices=[0], experiment=SimpleNamespace(records=[SimpleNamespace(rate=100.0)]),
        parts=lambda rows: [rows.reshape(*rows.shape[:-1], CHANNELS, SAMPLES)],
    )  # fmt: skip
    of_dozen, of_all = event.participation(columns.reshape(2, -1), frame.blocks())
    assert 8.0 < of_dozen < event.FEW_BLOCKS < of_all
    p_value, rare = event.p_values(frame, residual.ravel(), columns.reshape(2, -1), np.arange(2), np.zeros(2))
    assert rare.tolist() == [True, False] and p_value[0] < 0.005 and p_value[1] == 1.0


@pytest.mark.parametrize("places", [(EVENT.start,), DOZEN])
def test_false_alarms_over_many_slow_columns_are_as_rare_as_promised_at_small_levels_too(places):
    """Forty columns as slow as what a vehicle does: the best of so many is soon ahead of all that others are elsewhere."""
    rng, trials = np.random.default_rng(6), 300
    slow = lambda: gaussian_filter1d(np.stack([a_column(rng, places) for _ in range(40)]), 4.0, axis=-1)
    found = np.array([p_of([rng.standard_normal((CHANNELS, SAMPLES))], [slow()]).min() for _ in range(trials)])
    for level in (0.05, 0.005):
        assert np.sum(found <= level) <= binom.ppf(0.999, trials, level)


def test_false_alarms_are_as_rare_where_drives_differ_in_length():
    """The flanks of a chance peak count on either side of the place, in every drive's own circle."""
    rng, trials, counts = np.random.default_rng(9), 600, (1000, SAMPLES, SAMPLES)
    slow = lambda: gaussian_filter1d(np.stack([a_column(rng, (400,)) for _ in range(40)]), 4.0, axis=-1)
    part = lambda columns: [columns[..., :count] for count in counts]
    found = np.array([p_of([rng.standard_normal((CHANNELS, count)) for count in counts], part(slow())).min() for _ in range(trials)])
    for level in (0.05, 0.005):
        assert np.sum(found <= level) <= binom.ppf(0.999, trials, level)


def test_a_record_moves_both_ways_in_its_own_circle():
    rng = np.random.default_rng(10)
    residuals = [rng.standard_normal((CHANNELS, count)) for count in (SAMPLES, SAMPLES + 30)]
    columns = [np.pad(a_column(rng), ((0, 0), (0, part.shape[1] - SAMPLES)))[None] for part in residuals]
    marks = [np.any(rows != 0, axis=1) for rows in columns]
    like = event.likeness(residuals, columns, marks, np.zeros(1))[0]
    product = sum(np.sum(np.roll(rows[0], -5, axis=1) * own) for rows, own in zip(columns, residuals))
    power = sum(np.sum(rows**2) for rows in columns)
    within = sum(np.sum(own[:, np.roll(inside[0], -5)] ** 2) for own, inside in zip(residuals, marks))
    assert like.size == SAMPLES and like[-5] == pytest.approx(product**2 / (power * within))


def test_what_is_missing_stands_out_beside_another_that_does_the_same_a_moment_later():
    """As the stops of both axles do."""
    rng = np.random.default_rng(8)
    own, others = a_column(rng), [a_column(rng) for _ in range(20)]
    columns = np.stack([own, np.roll(own, 15, axis=1), *others])
    residual = rng.standard_normal((CHANNELS, SAMPLES)) + own * 7.0 / np.linalg.norm(own)
    found = p_of([residual], [columns])
    assert found[0] == found.min() <= 0.002


@pytest.mark.parametrize("places", [(EVENT.start,), DOZEN])
def test_false_alarms_over_all_events_are_as_rare_as_promised(places):
    rng = np.random.default_rng(5)
    columns = lambda: np.stack([a_column(rng, places) for _ in range(3)])
    found = [p_of([rng.standard_normal((CHANNELS, SAMPLES))], [columns()]).min() for _ in range(200)]
    lower, upper = binom.interval(0.998, 200, 0.05)
    assert lower <= np.sum(np.array(found) <= 0.05) <= upper
    assert kstest(found, "uniform").pvalue > 0.001
