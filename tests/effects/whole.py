"""Drives with any effect in one kernel that holds them all, so that it is compiled only once."""

from __future__ import annotations

import os
from pathlib import Path

from ridecomfort import simulate
from ridecomfort.effects import library

FOLDER = Path(os.environ.get("RIDECOMFORT_EFFECTS", Path(__file__).parent.parent / "contract" / "user_effects"))
"""A user's effects; name your own folder in the environment to run the contract over it."""

ENTRIES = library.find(FOLDER)
NEUTRAL = {name: entry.effect.neutral for name, entry in ENTRIES.items()}


def drive(road, car, *, effects=(), **options):
    """A drive with these effects (names, or name to sizes) and all others at neutral."""
    sizes = effects if isinstance(effects, dict) else dict.fromkeys(effects)
    values = {name: ENTRIES[name].effect.values(given) for name, given in sizes.items()}
    return simulate.run(road, car, effects={**NEUTRAL, **values}, effects_folder=FOLDER, **options)


def act(name):
    """The function of an effect."""
    return ENTRIES[name].act
