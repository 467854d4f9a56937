"""A real Duffing oscillator: the search must name its cubic spring (Wigren and Schoukens 2013, Silverbox)."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.discrepancy import floor, onemass, select

RATE = 1e7 / 2**14
STARTS = (40587, 49279, 57972, 66664, 75354, 84046, 92739, 101430, 110123, 118814)
"""First samples of the ten random-phase multisines, each after a rest."""
LENGTH = 8590
ARROW = slice(0, 40493)


@pytest.fixture(scope="module")
def silverbox(shared):
    volts = np.genfromtxt(shared / "data" / "silverbox" / "SNLS80mV.csv", delimiter=",", skip_header=1)[:, :2]
    volts = volts - volts[127600:128300].mean(axis=0)
    cuts = [slice(start, start + LENGTH) for start in STARTS] + [ARROW]
    return [volts[cut, 0] for cut in cuts], [volts[cut, 1] for cut in cuts]


def multisine(random) -> np.ndarray:
    """From 1 to 200 Hz, 20 mV rms."""
    frequency = np.fft.rfftfreq(LENGTH // 2, 1.0 / RATE)
    phases = np.exp(2j * np.pi * random.random(frequency.size))
    series = np.fft.irfft(((frequency > 1.0) & (frequency < 200.0)) * phases, LENGTH // 2)
    return 0.02 * series / series.std()


def test_records_repeat_one_another_where_their_inputs_are_the_same():
    random = np.random.default_rng(0)
    one, other = multisine(random), multisine(random)
    mass = onemass.OneMass([one, other, one], [one, other, one], RATE, ["fit", "fit", "check"], ["a", "b", "a again"], (1.0, 250.0))
    assert floor.repeats(mass, range(3)) == {"a": [0, 2]}


def test_the_cubic_spring_of_the_silverbox_is_named(silverbox):
    inputs, outputs = silverbox
    fitted = onemass.OneMass(
        inputs[:4] + [inputs[8]], outputs[:4] + [outputs[8]], RATE, ["fit"] * 4 + ["check"],
        ["multisine 1", "multisine 2", "multisine 3", "multisine 4", "multisine 9"], (1.0, 250.0),
    )  # fmt: skip
    found = select.select(fitted, {size.key: size.neutral for size in fitted.free}, most=1)
    assert found.accepted == ("cubic_spring",)
    assert found.rounds[0].cluster == ()
    unseen = onemass.OneMass(inputs[9:], outputs[9:], RATE, ["fit"] * 2, ["test", "arrow"], (1.0, 250.0))
    unseen._turn, unseen.free = fitted._turn, fitted.free
    millivolts = {
        name: [1e3 * np.std(unseen.residual(values, index)[0, 100:]) for index in (0, 1)]
        for name, values in (("linear", found.states[0].fit.values), ("cubic", found.states[1].fit.values))
    }
    assert millivolts["linear"][0] > 6.0
    assert millivolts["cubic"][0] < 1.3 and millivolts["cubic"][1] < 1.5
