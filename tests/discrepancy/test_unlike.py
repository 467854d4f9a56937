"""A comparison tells which of several repeats has a signal of another scale or time than the others."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import unlike

from .coloured import coloured

RATE, SAMPLES = 100.0, 6000
NAMES = ["a_y", "a_z", "roll_rate", "pitch_rate"]


def compared(spoil=lambda number, signals: signals, aside=(0.0, 0.0, 0.0)):
    """Three drives at 20 m/s beside a model that lacks a tenth of what the car does; behind its run-in."""
    random, time = np.random.default_rng(5), np.arange(SAMPLES) / RATE
    true, lacking = coloured(random, SAMPLES), 0.1 * coloured(random, SAMPLES)
    measured = np.stack([spoil(number, true) + 0.01 * coloured(random, SAMPLES) for number in range(3)])
    residual = np.stack([true + lacking] * 3) - measured
    residual[:, :, :200] = np.nan
    series = lambda values: (("drive", "time"), np.broadcast_to(values, (3, SAMPLES)))
    over = ("drive", "signal", "time")
    return xr.Dataset(
        {"measured": (over, measured), "residual": (("state", *over), residual[None]), "s": series(20.0 * time), "v_x": series(20.0),
         "e": series(np.array(aside)[:, None])},
        {"time": time, "drive": ["first", "second", "third"], "signal": NAMES, "state": ["calibrated"]},
    )  # fmt: skip


def later(number, signals):
    return np.stack([unlike.delayed(row, 1.2 if number == 1 and name == "roll_rate" else 0.0) for name, row in zip(NAMES, signals)])


def larger(number, signals):
    return signals * np.where((number == 2) & (np.array(NAMES) == "pitch_rate"), 1.08, 1.0)[:, None]


def test_repeats_that_are_alike_are_not_told_whatever_the_model_lacks():
    assert unlike.of_comparison(compared()) == []


def test_a_signal_that_is_late_in_one_of_them_is_told():
    (said,) = unlike.of_comparison(compared(later))
    assert said == "second: roll_rate, beside what the model does there and in first, third, comes 12 ms too late, if these are right: its filter, or its channel?"


def test_and_one_that_is_too_large():
    (said,) = unlike.of_comparison(compared(larger))
    assert said.startswith("third: pitch_rate, beside what the model does there and in first, second, is ") and "too large" in said
    assert float(said.split(" is ")[1].split(" %")[0]) == pytest.approx(8.0, abs=0.8)


def test_drives_that_repeat_none_are_held_against_none():
    assert unlike.of_comparison(compared(later, aside=(0.0, 2.0, 0.0))) == []


def test_a_signal_is_delayed_between_its_samples():
    time = np.arange(400) / 100.0
    wave = lambda late: np.exp(-(((time - 2.0 - late) / 0.1) ** 2))
    assert unlike.delayed(wave(0.0), 1.37) == pytest.approx(wave(0.0137), abs=1e-6)
