"""A road, and a drive of another car than the nominal one on it."""

from __future__ import annotations

import pytest

from tests import quarter_cars


@pytest.fixture(scope="session")
def road():
    return quarter_cars.road(length=560.0)


@pytest.fixture(scope="session")
def drive(road, nominal):
    return quarter_cars.driven(road, quarter_cars.other(nominal))
