from __future__ import annotations

import pytest

from ridecomfort.vehicle import parameters


@pytest.fixture(scope="session")
def car(repository):
    """The mid-size car of the study."""
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
