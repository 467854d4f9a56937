"""From x and y to longitude and latitude."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.comfort.georeference import ECCENTRICITY2, SEMI_MAJOR, GeoReference

LATITUDE = 47.0


def metres_per_degree() -> tuple[float, float]:
    """East and north at LATITUDE, from the radii of curvature of the ellipsoid."""
    share = 1 - ECCENTRICITY2 * np.sin(np.deg2rad(LATITUDE)) ** 2
    prime, meridian = SEMI_MAJOR / share**0.5, SEMI_MAJOR * (1 - ECCENTRICITY2) / share**1.5
    return np.deg2rad(prime * np.cos(np.deg2rad(LATITUDE))), np.deg2rad(meridian)


def test_the_origin_is_where_it_is_said_to_be():
    assert GeoReference(15.4, LATITUDE)(0.0, 0.0) == pytest.approx((15.4, LATITUDE), abs=1e-12)


def test_metres_become_degrees_by_the_radii_of_curvature():
    east, north = metres_per_degree()
    longitude, latitude = GeoReference(15.4, LATITUDE)([100.0, 0.0], [0.0, 100.0])
    assert (longitude - 15.4) * east == pytest.approx([100.0, 0.0], abs=1e-4)
    assert (latitude - LATITUDE) * north == pytest.approx([0.0, 100.0], abs=2e-3)


def test_degrees_of_latitude_have_their_published_lengths():
    """WGS 84: 110.574 km at the equator, 111.694 km at the poles (a degree of latitude)."""
    for latitude, length in ((0.0, 110_574.0), (89.99, 111_694.0)):
        _, found = GeoReference(0.0, latitude)(0.0, 1000.0)
        assert 1000.0 / abs(float(found) - latitude) == pytest.approx(length, abs=10.0)


def test_a_turned_road():
    """Its x axis points north: turned by a quarter from east."""
    longitude, latitude = GeoReference(15.4, LATITUDE, 90.0)(100.0, 0.0)
    assert longitude == pytest.approx(15.4, abs=1e-9) and latitude > LATITUDE
