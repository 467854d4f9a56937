"""Whether two records are one, and what is never taken for that."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from ridecomfort.drive import record
from ridecomfort.drive.copies import is_copy
from ridecomfort.vocabulary import SIGNALS, STANDARD_GRAVITY


def raw(rate, seed=1):
    """Times and signals of a minute of driving, shaken up to some 12 Hz, told with six digits."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, 60.0, 1.0 / rate)
    shaken = {name: gaussian_filter1d(rng.standard_normal(time.size), rate / 40) for name in SIGNALS}
    scaled = {name: (3.0 if name.startswith("a") else 0.1) * row for name, row in shaken.items()}
    return time, {name: np.round(row + (STANDARD_GRAVITY if name == "a_z" else 0.0), 6) for name, row in scaled.items()}


def drive(time, signals):
    quantities = {name: (time, row) for name, row in signals.items()}
    return record.from_arrays({**quantities, "v_x": (time, 20.0 + 0.0 * time), "s": (time, 20.0 * (time - time[0]))}, rate=100.0)


EXPORTS = {
    "with another clock": lambda time, signals: (time + 1234.5, signals),
    "since 1970": lambda time, signals: (time + 1.7e9, signals),
    "cut": lambda time, signals: (time[301:], {name: row[301:] for name, row in signals.items()}),
    "with four digits": lambda time, signals: (time, {name: np.round(row, 4) for name, row in signals.items()}),
    "in g": lambda time, signals: (time, {name: np.round(row / STANDARD_GRAVITY, 6) * STANDARD_GRAVITY for name, row in signals.items()}),
    "one sample of two": lambda time, signals: (time[::2], {name: row[::2] for name, row in signals.items()}),
    "by a clock that is 50 ppm faster": lambda time, signals: (time * (1.0 + 50e-6), signals),
}


@pytest.mark.parametrize("rate", [100, 128, 200, 1000])
@pytest.mark.parametrize("how", EXPORTS)
def test_another_export_of_a_record_is_a_copy_of_it(rate, how):
    one, other = drive(*raw(rate)), drive(*EXPORTS[how](*raw(rate)))
    assert is_copy(one, other) and is_copy(other, one)


@pytest.mark.parametrize(("first", "second"), [((0, 40), (20, 60)), ((0, 45), (15, 60)), ((20, 60), (0, 45)), ((0, 60), (40, 60))])
def test_parts_of_one_record_that_overlap_are_copies(first, second):
    time, signals = raw(128)
    part = lambda begin, end: drive(time[128 * begin : 128 * end], {name: row[128 * begin : 128 * end] for name, row in signals.items()})
    assert is_copy(part(*first), part(*second)) and is_copy(part(*second), part(*first))


def test_parts_of_one_record_that_do_not_overlap_are_drives_of_their_own():
    time, signals = raw(128)
    half = time.size // 2
    halves = [drive(time[own], {name: row[own] for name, row in signals.items()}) for own in (slice(None, half), slice(half, None))]
    assert not is_copy(*halves)


def test_a_record_with_the_noise_of_a_quiet_instrument_of_its_own_is_no_copy():
    time, signals = raw(200)
    rng = np.random.default_rng(5)
    beside = {name: row + 0.01 * rng.standard_normal(row.size) for name, row in signals.items()}
    assert not is_copy(drive(time, signals), drive(time, beside))


def test_another_drive_is_no_copy_nor_is_one_that_stands_still():
    assert not is_copy(drive(*raw(100)), drive(*raw(100, seed=2)))
    time, signals = raw(100)
    dead = drive(time, signals | {"a_z": np.full(time.size, STANDARD_GRAVITY)})
    assert not is_copy(dead, dead) and not is_copy(dead, drive(time, signals))


def test_of_a_drive_that_is_too_short_and_at_a_low_rate_nothing_fails():
    one = drive(*raw(100))
    assert not is_copy(one.isel(time=slice(None, 12)), one) and not is_copy(one.isel(time=slice(None, 12)), one.isel(time=slice(None, 12)))
    slow = one.isel(time=slice(None, None, 5))
    assert is_copy(slow, slow)
