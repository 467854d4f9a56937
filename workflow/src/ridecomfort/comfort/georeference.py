"""From the plane of a road to longitude and latitude."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SEMI_MAJOR, FLATTENING = 6378137.0, 1 / 298.257223563
"""m and 1; the ellipsoid of WGS 84 (NIMA TR8350.2)."""

ECCENTRICITY2 = FLATTENING * (2.0 - FLATTENING)


@dataclass(frozen=True)
class GeoReference:
    """Where a road's x = y = 0 lies (WGS 84, degrees), and by how many degrees its x axis is turned from east to north.

    The plane touches the ellipsoid there: 10 km off, a distance from there is wrong by less than 1 part in a million.
    """

    longitude: float
    latitude: float
    rotation_deg: float = 0.0

    def __call__(self, x, y) -> tuple[np.ndarray, np.ndarray]:
        """Longitude and latitude in degrees of points at x and y in m."""
        turn, lon, lat = np.deg2rad([self.rotation_deg, self.longitude, self.latitude])
        x, y = np.asarray(x, float), np.asarray(y, float)
        east, north = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
        radius = SEMI_MAJOR / np.sqrt(1.0 - ECCENTRICITY2 * np.sin(lat) ** 2)
        outward = radius * np.cos(lat) - north * np.sin(lat)
        up = radius * (1.0 - ECCENTRICITY2) * np.sin(lat) + north * np.cos(lat)
        distance = np.hypot(outward, east)
        # Bowring (1976): one step is exact to far below a millimetre near the ground.
        minor = SEMI_MAJOR * (1.0 - FLATTENING)
        angle = np.arctan2(up * SEMI_MAJOR, distance * minor)
        latitude = np.arctan2(
            up + ECCENTRICITY2 / (1.0 - ECCENTRICITY2) * minor * np.sin(angle) ** 3,
            distance - ECCENTRICITY2 * SEMI_MAJOR * np.cos(angle) ** 3,
        )
        return np.rad2deg(lon + np.arctan2(east, outward)), np.rad2deg(latitude)
