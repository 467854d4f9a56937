"""Random surface of a stand-in road: an isotropic Gaussian field with the spectrum of ISO 8608."""

from __future__ import annotations

import numpy as np
from scipy.fft import irfft, next_fast_len
from scipy.signal import fftconvolve
from scipy.special import gamma, kv

REFERENCE_WAVENUMBER = 0.1
"""cycles/m at which ISO 8608:2016 states the displacement spectrum."""

UNIT_DENSITY = 1e-6
"""m3; one-sided displacement spectral density at the reference wavenumber of a field of unit gain."""

CHUNK = 2048


def coherence(wavenumber, distance, waviness: float) -> np.ndarray:
    """Coherence (not squared) of two parallel tracks ``distance`` m apart on an isotropic surface.

    For a one-sided spectrum ``wavenumber ** -waviness`` along every track, isotropy leaves no choice but
    ``2 q^(w/2) K_{w/2}(2 q) / Gamma(w/2)`` with ``q = pi * wavenumber * distance``. Arguments broadcast;
    wavenumber in cycles/m.

    Dodds and Robson (1973), J. Sound Vib. 31(2), 175-183; Kamash and Robson (1978), J. Sound Vib. 57(1),
    89-100. Ammon's and Bormann's fits follow measured pairs of tracks more closely (Mucka 2015, Int. J.
    Vehicle Design 67(1)); isotropy needs no fitted numbers and holds for all columns of a grid at once.
    """
    q = np.pi * np.asarray(wavenumber, dtype=float) * np.abs(distance)
    order = 0.5 * waviness
    with np.errstate(invalid="ignore", over="ignore"):
        value = 2.0 * q**order * kv(order, 2.0 * q) / gamma(order)
    return np.where(q < 1e-9, 1.0, value)


def fields(
    rng: np.random.Generator,
    count: int,
    spacing: float,
    v: np.ndarray,
    *,
    wavinesses,
    wavenumber_minimum: float,
    wavenumber_maximum: float,
) -> list[np.ndarray]:
    """Surfaces in m of shape (count, len(v)), one for each waviness, made of the same random numbers.

    Every track has the one-sided spectrum ``UNIT_DENSITY * (n / 0.1) ** -waviness`` (ISO 8608:2016)
    between the wavenumber limits (cycles/m) and none outside; tracks cohere as ``coherence`` says.
    Sharing the numbers lets a mixture of the surfaces stand for a waviness in between.
    """
    # The period is longer than the road by the longest wave, so that its end does not resemble its start.
    period = next_fast_len(count + round(1.0 / (wavenumber_minimum * spacing)), real=True)
    wavenumber = np.arange(period // 2 + 1) / (period * spacing)
    inside = (wavenumber >= wavenumber_minimum) & (wavenumber <= wavenumber_maximum)
    wavenumber = wavenumber[inside]
    draws = rng.standard_normal((len(wavenumber), len(v), 2)).view(complex)[..., 0]
    distance = np.abs(v[:, None] - v[None, :])
    distances, index = np.unique(distance.round(6), return_inverse=True)
    index = index.reshape(distance.shape)
    surfaces = []
    for waviness in wavinesses:
        spectrum = np.zeros((period // 2 + 1, len(v)), dtype=complex)
        density = UNIT_DENSITY * (wavenumber / REFERENCE_WAVENUMBER) ** -waviness
        # irfft divides by the period; a density S holds a variance S / (period * spacing) per line.
        amplitude = 0.5 * period * np.sqrt(density / (period * spacing))
        rows = np.flatnonzero(inside)
        for start in range(0, len(wavenumber), CHUNK):
            part = slice(start, start + CHUNK)
            correlation = coherence(wavenumber[part, None], distances, waviness)[:, index]
            correlation[:, np.arange(len(v)), np.arange(len(v))] += 1e-9
            mixed = np.linalg.cholesky(correlation) @ draws[part, :, None]
            spectrum[rows[part]] = amplitude[part, None] * mixed[..., 0]
        surfaces.append(irfft(spectrum, n=period, axis=0)[:count])
    return surfaces


def modulate(surface: np.ndarray, gain: np.ndarray) -> np.ndarray:
    """The surface with its *slope* along u multiplied by ``gain`` (over u, or over u and v).

    Scaling the slope and not the height lets the level of roughness change along the road
    without a step or a ramp where it changes: long waves pass on as they are.
    """
    gain = gain if gain.ndim == 2 else gain[:, None]
    steps = 0.5 * (gain[1:] + gain[:-1]) * np.diff(surface, axis=0)
    return np.concatenate([gain[:1] * surface[:1], gain[:1] * surface[:1] + np.cumsum(steps, axis=0)])


def smooth_noise(rng: np.random.Generator, count: int, spacing: float, length: float) -> np.ndarray:
    """A Gaussian process (count) of unit variance and correlation ``exp(-(distance / length)^2 / 2)``."""
    reach = round(4.0 * length / spacing)
    kernel = np.exp(-((np.arange(-reach, reach + 1) * spacing / length) ** 2))
    kernel /= np.sqrt(np.sum(kernel**2))
    return fftconvolve(rng.standard_normal(count + 2 * reach), kernel, mode="valid")
