"""What is judged of a series: nothing slower than the vehicle answers for, everything else as it was; and whether its sign is right."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import simulate
from ridecomfort.discrepancy.judged import against, band, coherence, doubt, judged
from ridecomfort.drive.axes import correlation, taken_for
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests.vehicle.roads import road, rough

TIME = np.arange(2000) / 100.0
SLOW, MIDDLE, FAST = (np.sin(2 * np.pi * frequency * TIME) for frequency in (0.2, 1.0, 11.0))

INSIDE = slice(300, -300)
"""Samples 3 s from the ends: series are cut as if they went on mirrored there."""


def test_slow_parts_go_and_fast_ones_stay():
    (found,) = judged((SLOW + FAST)[None], 100.0, ["a_z"])
    np.testing.assert_allclose(found[INSIDE], FAST[INSIDE], atol=0.01)


def test_what_the_driver_makes_reaches_higher_in_some_signals():
    speed, heave = judged(np.stack([MIDDLE, MIDDLE]), 100.0, ["a_x", "a_z"])
    assert np.abs(speed[INSIDE]).max() < 0.03 and heave[INSIDE] == pytest.approx(MIDDLE[INSIDE], abs=0.1)


def test_bands_add_up_to_the_series():
    parts = [band(SLOW + MIDDLE + FAST, 100.0, edges) for edges in ((0.0, 0.5), (0.5, 5.0), (5.0, 60.0))]
    np.testing.assert_allclose(parts[1][INSIDE], MIDDLE[INSIDE], atol=0.03)
    np.testing.assert_allclose(sum(parts), SLOW + MIDDLE + FAST, atol=1e-9)


def test_a_drive_that_ends_slower_than_it_begins_does_not_jump():
    """Half a metre per second squared less of deceleration at the end, of which nothing is fast."""
    braking = judged(np.linspace(-0.5, 0.0, 2000)[None], 100.0, ["a_x"])
    assert np.abs(braking).max() < 2e-3


def measured_and_simulated(repository, roughness, bend):
    """Signals (signal, sample) of a drive at 20 m/s of a car with instruments of some noise, and of a model whose dampers are a third softer."""
    car = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    u = np.arange(0.0, 500.05, 0.1)
    surface = road(500.0, height=lambda *place: rough(*place, roughness=roughness), curvature=bend * np.sin(2 * np.pi * u / 150.0))
    course = simulate.prepare(surface)
    vehicles = car, car.replace(damping_front=0.67 * car["damping_front"], damping_rear=0.67 * car["damping_rear"])
    true, model = (np.stack([run[name].values for name in SIGNALS]) for run in (simulate.run(course, one, speed=20.0) for one in vehicles))
    count = min(true.shape[1], model.shape[1])
    noise = np.array([0.03] * 3 + [0.001] * 3)[:, None] * np.random.default_rng(1).standard_normal((6, count))
    return true[:, 200:count] + noise[:, 200:], model[:, 200:count]


@pytest.mark.parametrize(
    ("roughness", "bend"), [(24e-6, 0.0), (1e-6, 0.004)], ids=["a rough road", "a smooth road that bends"]
)
def test_a_wrong_sign_is_told_of_what_the_road_or_its_bends_move_and_of_no_right_one(repository, roughness, bend):
    """Of all but a_x, in which such a drive has hardly more than noise."""
    measured, simulated = measured_and_simulated(repository, roughness, bend)
    assert not against(measured, simulated, 100.0, SIGNALS).any()
    turned = against(-measured, simulated, 100.0, SIGNALS)
    assert (turned[1:] < -0.5).all()


def test_exchanged_columns_are_told_by_what_each_goes_with(repository):
    """On a road that bends, at one speed: a_x has hardly more than noise, and yaw rate does in bends what a_y does, in another unit."""
    measured, simulated = measured_and_simulated(repository, 4e-6, 0.004)
    assert taken_for(measured, simulated, SIGNALS) == [""] * len(SIGNALS)
    exchanged = measured[[1, 0, 2, 3, 4, 5]]
    assert taken_for(exchanged, simulated, SIGNALS)[0] == "a_y"
    rates = measured[[0, 1, 2, 4, 3, 5]]
    assert taken_for(rates, simulated, SIGNALS)[3:] == ["pitch_rate", "roll_rate", ""]
    assert doubt("a_x", "a_y", 0.0, 1.0, 1.0) == "a_x does what the model does in a_y: are columns exchanged, or is the sensor turned?"


def test_slow_parts_that_a_bank_turns_round_are_no_wrong_sign():
    """A roll rate that agrees in what is judged, with nine times as much of the other sign below it."""
    random = np.random.default_rng(3)
    simulated = random.standard_normal(6000)
    slow = 3.0 * np.sqrt(2.0) * np.sin(2 * np.pi * 0.1 * np.arange(6000) / 100.0)
    pair = np.stack([simulated - slow, simulated + slow])[:, None]
    assert correlation(*pair)[0] < -0.7
    assert against(*pair, 100.0, ["roll_rate"])[0] == 0.0


@pytest.mark.parametrize(("phase", "is_told"), [(2.0, False), (np.pi, True)])
def test_what_runs_against_the_model_by_something_else_is_no_wrong_sign(phase, is_told):
    """A yaw rate that answers to the road a quarter of a wave otherwise, as of links that steer, and a third of whose power is the driver's."""
    random = np.random.default_rng(2)
    spectrum = np.fft.rfft(random.standard_normal((2, 6000)))
    simulated, hands = np.fft.irfft(spectrum * np.array([[1.0], [0.7]]))
    pair = np.stack([np.fft.irfft(np.fft.rfft(simulated) * np.exp(1j * phase)) + hands, simulated])[:, None]
    assert correlation(*judged(pair, 100.0, ["yaw_rate"]))[0] < -0.3
    assert (against(*pair, 100.0, ["yaw_rate"])[0] < 0.0) == is_told


def test_what_is_coherent_is_the_power_that_a_filter_could_make_of_the_other():
    """Of independent noise nothing, however short the record, and of a signal with half as much noise beside it two thirds."""
    random = np.random.default_rng(4)
    other, noise = random.standard_normal((2, 20, 3000))
    late = np.roll(other, 5, axis=-1)
    assert coherence(noise, other, 100.0).mean() < 0.1
    assert coherence(late + np.sqrt(0.5) * noise, other, 100.0).mean() == pytest.approx(2 / 3, abs=0.05)
