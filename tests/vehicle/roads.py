"""Roads for tests of the vehicle, made from closed forms or seeds."""

from __future__ import annotations

import numpy as np
import xarray as xr


def road(length=200.0, spacing=0.1, *, height=None, curvature=0.0, width=4.0) -> xr.Dataset:
    """A road with ``height(u, v)`` in m and constant or given curvature."""
    u = np.arange(0.0, length + spacing / 2, spacing)
    v = np.linspace(-width / 2, width / 2, round(width / 0.1) + 1)
    elevation = np.zeros((u.size, v.size))
    if height is not None:
        elevation = elevation + height(u[:, None], v[None, :])
    along = np.broadcast_to(np.asarray(curvature, dtype=float), u.shape)
    level = np.zeros(u.size)
    return xr.Dataset(
        {
            "elevation": (("u", "v"), elevation),
            "curvature": ("u", along.copy()),
            "slope": ("u", level),
            "bank": ("u", level),
        },
        coords={"u": u, "v": v},
    )


def rough(u, v, seed=1, roughness=16e-6, waviness=2.0, spacing=0.1):
    """Random heights with the spectrum of ISO 8608 (class B: 16e-6 m3 at 0.1 cycles/m), mixed across."""
    rng = np.random.default_rng(seed)
    count = u.size
    wavenumber = np.fft.rfftfreq(count, spacing)
    tracks = []
    for _ in range(5):
        amplitude = np.zeros(wavenumber.size)
        amplitude[1:] = np.sqrt(2 * roughness * (wavenumber[1:] / 0.1) ** -waviness * wavenumber[1])
        phase = rng.uniform(0, 2 * np.pi, wavenumber.size)
        tracks.append(np.fft.irfft(amplitude * np.exp(1j * phase) * count / 2, count))
    places = np.linspace(v.min(), v.max(), 5)
    return np.array([np.interp(v[0], places, row) for row in np.array(tracks).T])
