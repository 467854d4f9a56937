"""Names that are reached from the package alone, and what that costs."""

from __future__ import annotations

import subprocess
import sys

import pytest

from ridecomfort import lazy
from ridecomfort.road import crg

REACHED = """
import sys
import ridecomfort
assert "numpy" not in sys.modules
names = ("road.crg.read", "road.crg.write", "road.surface.height", "simulate.run", "comfort.iso2631.weight", "comfort.iso2631.metrics", "comfort.iri.iri",
         "comfort.sections.critical", "calibrate.calibrate", "discrepancy.rank", "discrepancy.discover", "vehicle.parameters.read")
for name in names:
    found = ridecomfort
    for part in name.split("."):
        found = getattr(found, part)
    assert callable(found)
"""


def test_a_module_is_imported_when_it_is_asked_for():
    named = lazy.on_demand("ridecomfort.road", ("crg",))
    assert named("crg") is crg
    with pytest.raises(AttributeError, match="module 'ridecomfort.road' has no attribute 'surface'"):
        named("surface")


@pytest.mark.slow
def test_what_others_rely_on_is_reached_from_the_package_which_alone_loads_nothing():
    subprocess.run([sys.executable, "-c", REACHED], check=True)
