"""What a search is judged beside: reasons to doubt the data, of drives that are fitted and of those held out alike."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import naming, suspect
from ridecomfort.vocabulary import SIGNALS


@pytest.fixture
def asked_of_signals(monkeypatch):
    """What is asked of drives, clocks and roads finds nothing."""
    for name in ("of_drives", "of_clocks", "of_fit"):
        monkeypatch.setattr(suspect, name, lambda *_: [])
    monkeypatch.setattr(suspect, "road_noise", lambda road: 0.0)


def doubts(spoilt: np.ndarray) -> list[str]:
    """Doubts about two drives that the model does but for noise, the second of them held out, whose signals are multiplied by ``spoilt``."""
    random, names = np.random.default_rng(0), list(SIGNALS)
    simulated = random.standard_normal((2, 6, 3000))
    measured = simulated + 0.1 * random.standard_normal(simulated.shape)
    measured[1] *= spoilt[:, None]
    records = [SimpleNamespace(name=name, rate=100.0, site="a") for name in ("fitted", "held out")]
    again = SimpleNamespace(road=SimpleNamespace(road=None))
    came = SimpleNamespace(records=records, channels=names, measured=lambda index: measured[index], replays=[again, again])
    state = SimpleNamespace(fit=SimpleNamespace(residuals={0: simulated[0] - measured[0]}), squares=np.ones((1, 6)))
    selection = SimpleNamespace(
        states=(state, state), has_repeats=True, floor_squares=np.zeros((1, 6)), accepted=(), frame=SimpleNamespace(indices=[0]),
        check={1: simulated[1] - measured[1]},
    )  # fmt: skip
    return naming.suspicions(came, selection)


def test_the_sign_and_the_unit_of_a_signal_of_a_drive_held_out_are_asked_about_too(asked_of_signals):
    """Such a drive decides on every effect."""
    assert doubts(np.ones(6)) == []
    spoilt = np.where([name == "a_y" for name in SIGNALS], -1.0, np.where(np.arange(6) == SIGNALS.index("yaw_rate"), 57.3, 1.0))
    of_sign, of_unit = doubts(spoilt)
    assert of_sign.startswith("held out: a_y runs against the model") and of_unit.startswith("held out: yaw_rate is 57")
