"""A speed that is missed by millimetres a second, made good without driving again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ridecomfort import simulate
from ridecomfort.drive import pedals
from ridecomfort.drive.paced import paced
from ridecomfort.drive.replay import replay
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import braked


def test_what_is_foretold_of_another_speed_is_what_a_driver_who_comes_nearer_changes(repository):
    """Waves of 2 mm/s at 1.3 Hz and of 5 mm/s at 0.5 Hz."""
    car, course = parameters.read(repository / "config" / "vehicles" / "midsize.yaml"), braked.course()
    drive, _ = braked.drive(course, car)
    again = pedals.listening(replay(drive, course, simulate.run), car).replay
    missing = 0.002 * np.sin(2 * np.pi * 1.3 * again.time) + 0.005 * np.sin(2 * np.pi * 0.5 * again.time)
    foretold = paced(again, car).made_good(missing)
    nearer = again.corrected({"speed": missing})
    driven = (nearer(car).signals - again(car).signals)[:, again.compared]
    for name in ("a_x", "pitch_rate"):
        own = SIGNALS.index(name)
        assert np.std((foretold[own] - driven[own])[200:-200]) < 0.1 * np.std(driven[own][200:-200]), name
    assert paced(replace(again, by_foot=None), car) is None
