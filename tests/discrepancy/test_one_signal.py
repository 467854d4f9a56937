"""One signal that is wrong by itself, in one of several repeats or in all of them, is told from what a model lacks."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import one_signal, unlike
from ridecomfort.discrepancy.span import taken_apart

from .coloured import coloured
from .linear import RATE, SAMPLES, Linear

NOISE = 0.02


class Recorded(Linear):
    """Three repeats of a car that does the same in each of them, and has ``more`` of an effect than its model; of a record number: its measured
    signals as ``spoilt`` by the instrument."""

    def __init__(self, seed, more=0.0, spoilt=lambda number, signals: signals, repeats=3):
        super().__init__(seed, {})
        self.records = self.records[:repeats]
        random = np.random.default_rng(seed)
        self.driven, self.stiffness, self.effect = (coloured(random, SAMPLES) for _ in range(3))
        self.noise = [NOISE * coloured(random, SAMPLES) for _ in self.records]
        true = self.driven + more * self.effect + 0.05 * self.stiffness
        self.signals = [spoilt(number, true) + noise for number, noise in enumerate(self.noise)]

    def measured(self, index):
        return self.signals[index]

    def residual(self, values, index):
        return self.driven - self.signals[index]


def late(channels, samples, numbers=(0, 1, 2)):
    """Signals of which one, or some, come later by so many samples, in the records of these numbers."""
    def spoilt(number, signals):
        found = signals.copy()
        for channel in np.atleast_1d(channels) if number in numbers else ():
            found[channel] = unlike.delayed(signals[channel], samples)
        return found

    return spoilt


def scaled(channel, share, numbers=(0, 1, 2)):
    """Signals of which one is too large by a share, in the records of these numbers."""
    def spoilt(number, signals):
        found = signals.copy()
        found[channel] *= 1.0 + share * (number in numbers)
        return found

    return spoilt


def framed(model):
    residuals = {index: model.residual({}, index) for index in range(len(model.records))}
    flat = {index: taken_apart(np.ones((1, 4, SAMPLES))) for index in residuals}
    return exp.frame(model, residuals, flat), residuals


def of_all(model):
    frame, residuals = framed(model)
    return one_signal.of_all(model, frame, residuals, [dict.fromkeys(residuals, model.stiffness)])


def of_repeats(model):
    return one_signal.of_repeats(model, *framed(model))


@pytest.mark.parametrize("more", [0.0, 0.3], ids=["right", "lacking"])
@pytest.mark.parametrize("seed", range(3))
def test_of_a_car_that_is_alike_in_all_repeats_nothing_is_told(seed, more):
    assert of_repeats(Recorded(seed, more)) == [] == of_all(Recorded(seed, more))


@pytest.mark.parametrize("more", [0.0, 0.3], ids=["right", "lacking"])
def test_a_scale_that_one_repeat_alone_has_is_told_whatever_the_model_lacks(more):
    (said,) = of_repeats(Recorded(1, more, scaled(2, 0.08, numbers=[1])))
    assert said.startswith("drive 1: c, beside what the model does there and in drive 0, drive 2, is ")
    assert "too large" in said and float(said.split(" is ")[1].split(" %")[0]) == pytest.approx(8.0, abs=0.8)


def test_a_delay_that_one_repeat_alone_has_is_told():
    (said,) = of_repeats(Recorded(2, 0.0, late(1, 0.8, numbers=[2])))
    assert said.startswith("drive 2: b, beside what the model does there and in drive 0, drive 1, comes ") and " ms too late" in said


def test_a_clock_that_is_late_in_all_signals_is_none_of_one():
    whole = lambda number, signals: np.stack([unlike.delayed(row, 0.8 * (number == 1)) for row in signals])
    assert of_repeats(Recorded(3, 0.0, whole)) == []


def test_what_a_model_lacks_where_not_all_repeats_drove_is_no_scale_of_a_signal():
    """It is three tenths wrong in the second half, which the third repeat did not drive."""
    half = SAMPLES // 2
    model = Recorded(4)
    for number, signals in enumerate(model.signals):
        signals[0, half:] += 0.3 * model.driven[0, half:]
        model.signals[number] = signals if number < 2 else signals[:, :half]
    model.records[2] = replace(model.records[2], place=model.records[2].place[:half])
    residuals = {number: model.driven[:, : signals.shape[1]] - signals for number, signals in enumerate(model.signals)}
    assert one_signal.of_repeats(model, SimpleNamespace(indices=[0, 1, 2]), residuals) == []


def test_of_two_repeats_that_differ_either_may_be_wrong():
    said = of_repeats(Recorded(1, 0.0, scaled(2, 0.06, numbers=[1]), repeats=2))
    assert [words.partition(":")[0] for words in said] == ["drive 0", "drive 1"]
    assert "too small, if these are right" in said[0] and "too large, if these are right" in said[1]


@pytest.mark.parametrize("samples", [1.2, -2.0])
def test_a_delay_of_one_signal_in_all_drives_is_found_beside_what_is_calibrated(samples):
    (said,) = of_all(Recorded(1, 0.0, late(3, samples)))
    way = "late" if samples > 0 else "early"
    assert said.startswith(f"d comes {abs(1e3 * samples / RATE):.0f} ms too {way} beside the other signals of the fitted drives")


def test_a_delay_of_all_rates_is_that_of_the_gyroscope():
    model = Recorded(1, 0.0, late([2, 3], 1.2))
    model.channels = ("a_x", "a_z", "roll_rate", "pitch_rate")
    (said,) = of_all(model)
    assert said.startswith("the rates come 12 ms too late beside the other signals of the fitted drives")


def test_a_scale_of_one_signal_in_all_drives_is_found_beside_what_is_calibrated():
    (said,) = of_all(Recorded(1, 0.0, scaled(0, -0.1)))
    assert "too small beside the other signals" in said and float(said.split(" is ")[1].split(" %")[0]) == pytest.approx(10.0, abs=0.5)


def test_what_leaves_much_of_the_error_is_not_what_is_wrong():
    assert of_all(Recorded(1, 0.5, late(3, 1.2))) == []
