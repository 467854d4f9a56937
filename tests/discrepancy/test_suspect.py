"""Noise of a scanner is found in a road that holds it, with its size, and not in one that does not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from ridecomfort.discrepancy import nuisances, suspect
from ridecomfort.vocabulary import SIGNALS
from tests.vehicle import roads


@pytest.fixture(scope="module")
def rough():
    return roads.road(600.0, height=roads.rough)


def test_a_road_of_iso_8608_holds_no_noise(rough):
    assert suspect.road_noise(rough) == 0.0


@pytest.mark.parametrize(
    ("jump", "wander", "is_suspect"), [(0.010, 0.15, True), (0.004, 0.15, False), (0.010, 0.006, False)]
)
def test_clocks_are_suspect_that_wander_where_alignment_saw_it_too(jump, wander, is_suspect):
    """Three records at 20 m/s whose clocks jump half way by what is left of it in the fit; ``wander``: m that alignment took out."""
    drive = xr.Dataset({"v_x": ("time", np.full(1000, 20.0))}, attrs={"distance_wander": wander})
    shift = np.where(np.arange(1000) < 500, 0.0, jump)
    fitted = SimpleNamespace(shifts=lambda other, index: shift)
    came = SimpleNamespace(replays=[SimpleNamespace(drive=drive)] * 3)
    reasons = suspect.of_clocks(came, SimpleNamespace(experiment=fitted, indices=[0, 1, 2]))
    assert [("10 ms" in reason) for reason in reasons] == ([True] if is_suspect else [])


def fitted(monkeypatch, rates: dict[str, float], bends: float, noise: float = 0.1):
    """Half a minute of a record whose signals are these many times what the model says, and its yaw rate in ``bends``, and what
    ``suspect.of_fit`` says of it."""
    monkeypatch.setattr(suspect.turning, "gyroscope_gain", lambda drive, road: (bends, 0.002))
    random, names = np.random.default_rng(3), list(SIGNALS)
    simulated = random.standard_normal((6, 3000))
    factors = np.array([rates.get(name, 1.0) for name in names])[:, None]
    measured = factors * simulated + noise * random.standard_normal(simulated.shape)
    known = {"drive": SimpleNamespace(attrs={}), "road": SimpleNamespace(road=None)}
    record, again = SimpleNamespace(name="first", rate=100.0), SimpleNamespace(**known)
    came = SimpleNamespace(records=[record], replays=[again], channels=names, measured=lambda index: measured)
    amounts = np.zeros(30)
    amounts[nuisances.OF_RATES] = (1.0 - factors[3:].mean()) / nuisances.GAIN
    frame = SimpleNamespace(indices=[0], experiment=SimpleNamespace(shifts=lambda *_: np.zeros(3)), amounts=lambda *_: amounts)
    return suspect.of_fit(came, frame, {0: simulated - measured})


@pytest.mark.parametrize("bends", [1.03, np.nan])
def test_a_gyroscope_of_which_all_rates_are_too_large_has_a_gain(monkeypatch, bends):
    (reason,) = fitted(monkeypatch, {"roll_rate": 1.03, "pitch_rate": 1.03, "yaw_rate": 1.03}, bends)
    assert "gain of 1.030 of the gyroscope" in reason


def test_of_a_drive_the_sign_of_what_runs_against_the_model_by_itself_is_asked_for_and_of_what_hands_move_not():
    random, names = np.random.default_rng(5), list(SIGNALS)
    simulated = random.standard_normal((6, 3000))
    measured = simulated + 0.1 * random.standard_normal(simulated.shape)
    measured[names.index("a_y")] *= -1.0
    measured[names.index("yaw_rate")] = random.standard_normal(3000) - 0.5 * simulated[names.index("yaw_rate")]
    came = SimpleNamespace(records=[SimpleNamespace(name="first", rate=100.0)], channels=names, measured=lambda index: measured)
    (reason,) = suspect.of_signals(came, {0: simulated - measured})
    assert reason.startswith("first: a_y runs against the model")


def test_a_vehicle_that_rolls_less_is_no_gyroscope_with_a_gain(monkeypatch):
    assert fitted(monkeypatch, {"roll_rate": 0.90}, np.nan) == []


def test_rates_that_are_too_large_where_the_road_does_not_bend_alone_are_no_gyroscope_with_a_gain(monkeypatch):
    assert fitted(monkeypatch, {"roll_rate": 1.03, "pitch_rate": 1.03, "yaw_rate": 1.03}, 1.001) == []


@pytest.mark.parametrize(("place", "said"), [(0.1, "cubic"), (0.9, "linear")])
@pytest.mark.parametrize("driven", [(True, False, False), (False, True, True)])
def test_records_place_a_road_between_its_points_alike_however_each_site_was_driven(place, said, driven):
    """0 as cubic interpolation, 1 as linear: the share of the way from the one that was driven to the other is of each record its own."""
    roads = [SimpleNamespace(road=SimpleNamespace(surface=SimpleNamespace(smooth=is_smooth))) for is_smooth in driven]
    amounts = [np.zeros(30) for _ in driven]
    for own, is_smooth in zip(amounts, driven):
        own[nuisances.BETWEEN] = -(place if is_smooth else 1.0 - place) / nuisances.OTHERWISE
    came, frame = SimpleNamespace(replays=roads), SimpleNamespace(indices=[0, 1, 2], amounts=lambda index, _: amounts[index])
    found = suspect.smoothness(came, frame, amounts)
    assert found == pytest.approx(place)
    assert f"better with {said} interpolation" in suspect.of_road(came, frame, found)[0]


def test_the_size_of_white_noise_is_estimated(rough):
    noisy = rough.copy()
    noisy["elevation"] = rough["elevation"] + 1e-3 * np.random.default_rng(2).standard_normal(rough["elevation"].shape)
    assert suspect.road_noise(noisy) == pytest.approx(1e-3, rel=0.15)


@pytest.mark.filterwarnings("error")
def test_points_too_far_apart_and_a_road_without_any_height_tell_no_noise(rough):
    coarse = roads.road(600.0, 0.24, height=roads.rough)
    assert suspect.road_noise(coarse) == 0.0 and suspect.road_noise(0.0 * rough) == 0.0
