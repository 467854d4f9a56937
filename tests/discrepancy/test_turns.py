"""What comes back with the way or the time is heard at any angle it begins at, and told from noise and from a road that is another."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import turns
from ridecomfort.discrepancy.reconsider import heard
from ridecomfort.discrepancy.experiment import Record
from ridecomfort.discrepancy.verdict import Verdict

CHANNELS = ("a_x", "a_z")

RADIUS = 0.31


def frame(speeds, rng, line=0.0, period=0.8, road=None, hum=0.0):
    """White residuals of drives at these speeds (m/s) over 600 m, with an error of a_z that comes back every ``period`` m, one of the
    ``road`` (2, 6001) at equal place, and one of 20 Hz."""
    records, residuals = [], {}
    for number, speed in enumerate(speeds):
        place = np.arange(0.0, 600.0, speed / 100.0)
        noise = rng.standard_normal((2, place.size))
        noise[1] += line * np.sin(2 * np.pi * place / period + rng.uniform(0, 6)) + hum * np.sin(2 * np.pi * 20.0 * place / speed)
        if road is not None:
            noise += np.stack([np.interp(place, np.arange(6001) * 0.1, row) for row in road])
        records.append(Record(f"drive {number}", "fit", "site", f"{speed}", 100.0, (0.8, 42.0), place, speed))
        residuals[number] = noise
    experiment = SimpleNamespace(records=records, channels=CHANNELS)
    flat_of = lambda index, residual: residual.ravel()
    return SimpleNamespace(experiment=experiment, indices=list(range(len(speeds))), flat_of=flat_of), residuals


def test_what_turns_is_heard_with_its_period_and_its_order():
    rng = np.random.default_rng(1)
    found = turns.line(*frame([22.0, 22.3, 21.8], rng, line=0.25), *frame([16.0], rng, line=0.25))
    assert found.channel == "a_z" and found.period == pytest.approx(0.8, rel=3e-4) and found.p_value < 1e-4
    assert found.width == pytest.approx(0.8**2 / 600.0, rel=0.01)  # that much longer it would be one turn behind at the end
    assert f"{2 * np.pi * RADIUS / 0.8:.2f} times a turn of the wheels" in found.words(RADIUS)


@pytest.mark.parametrize("share", [0.0, 0.6, 3.0])
def test_noise_is_not_even_where_it_is_that_of_one_road(share):
    for seed in range(60):
        rng = np.random.default_rng(seed)
        road = share * rng.standard_normal((2, 6001))
        assert turns.line(*frame([22.0, 22.3, 21.8], rng, road=road), *frame([16.0], rng, road=road)) is None


def test_a_line_that_is_far_above_all_has_a_p_value_all_the_same():
    rng = np.random.default_rng(5)
    found = turns.line(*frame([22.0, 22.3, 21.8], rng, line=20.0), *frame([16.0], rng, line=20.0))
    assert found.period == pytest.approx(0.8, rel=0.002) and 0.0 < found.p_value < 1e-100


def test_repeats_that_have_no_error_in_common_hear_what_one_drive_would_not():
    """In the mean over three the noise is even: a line is heard that in one would be no more than the strongest of chance."""
    heard, alone = 0, 0
    for seed in range(20):
        rng = np.random.default_rng([seed, 1])
        heard += turns.line(*frame([22.0, 22.3, 21.8], rng, line=0.17), None, {}) is not None
        alone += turns.line(*frame([22.0], rng, line=0.17), None, {}) is not None
    assert heard >= 15 and alone <= 10


def test_what_a_held_out_drive_hears_too_is_heard_where_the_fitted_ones_alone_are_not_sure():
    """Unless both have it from one road, whose own peaks they share."""
    drives = lambda seed, line: [frame([22.0, 22.3, 21.8], rng := np.random.default_rng([seed, 4]), line), frame([16.0], rng, 2.0 * line)]
    fitted = [turns.line(*drives(seed, 0.11)[0], None, {}) is not None for seed in range(40)]
    both = [turns.line(*drives(seed, 0.11)[0], *drives(seed, 0.11)[1]) for seed in range(40)]
    assert sum(fitted) < 8 and sum(found is not None and abs(found.period - 0.8) < 0.01 for found in both) > 24
    assert not any(turns.line(*drives(seed, 0.0)[0], *drives(seed, 0.0)[1]) for seed in range(40))


@pytest.mark.parametrize(("coherence", "expected"), [(0.0, 30.0), (0.1, 23.5), (0.4, 20.0), (0.99, 20.0)])
def test_what_two_drives_have_from_one_road_counts_once(coherence, expected):
    """20 and 10 e-foldings: of independent drives their sum, of one cause the one of the fitted ones."""
    assert turns._together(20.0, 10.0, coherence) == pytest.approx(expected, rel=0.05)
    assert turns._together(20.0, 20.0, 0.999) == pytest.approx(20.0, rel=0.01)


def test_a_hum_is_told_from_what_turns_by_the_drive_at_another_speed():
    """One of 20 Hz comes back every 1.1 m at one speed, and every 0.8 m at another."""
    rng = np.random.default_rng(2)
    hum = turns.line(*frame([22.0, 22.0, 22.0], rng, hum=0.5), *frame([16.0], rng, hum=0.5))
    assert hum.unit == "s" and hum.period == pytest.approx(0.05, rel=0.002) and "20 Hz" in hum.words(RADIUS)
    turning = turns.line(*frame([22.0, 22.0, 22.0], rng, line=0.5, period=1.1), *frame([16.0], rng, line=0.5, period=1.1))
    assert turning.unit == "m" and turning.period == pytest.approx(1.1, rel=0.002)


def test_what_comes_back_only_on_the_fitted_drives_is_not_it():
    """But for one held-out drive in twenty, in which chance does as much there, by way or by time."""
    confirmed, heard = 0, 0
    for seed in range(20):
        fitted = frame([22.0, 22.0, 22.0], rng := np.random.default_rng([seed, 2]), hum=0.5)
        confirmed += turns.line(*fitted, *frame([16.0], rng)) is not None
        heard += turns.line(*fitted, None, {}) is not None
    assert confirmed <= 4 and heard == 20


@pytest.mark.parametrize("band", [(0.8, 3.8), (0.8, 42.0)])
def test_of_records_that_are_too_slow_or_too_short_nothing_is_asked(band):
    rng = np.random.default_rng(3)
    one, residuals = frame([22.0, 22.3], rng, line=0.5)
    length = 6001 if band[1] < 10 else 150
    one.experiment.records = [replace(record, band=band, place=record.place[:length]) for record in one.experiment.records]
    assert turns.line(one, {index: part[:, :length] for index, part in residuals.items()}, None, {}) is None


def test_a_line_makes_outside_of_nothing_and_of_a_road_alone_and_is_said_beside_a_name():
    of = lambda kind, share=0.9: Verdict(kind, (), (), share, share)
    assert heard(of("nothing"), "an error comes back", False).verdict == "outside"
    assert heard(of("suspect"), "an error comes back", True).verdict == "outside"
    assert heard(of("suspect"), "an error comes back", False).verdict == "suspect"
    assert heard(of("named"), "an error comes back", False).verdict == "named"
    assert "comes back" in heard(of("named"), "an error comes back", False).reasons[-1]
    assert heard(of("named", 0.7), "an error comes back", False).verdict == "outside"
    assert heard(of("nothing"), "", False) == of("nothing")
