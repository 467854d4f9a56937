"""Cross-spectra of errors over all channels, and series made white by them.

An error of one channel comes with errors of the others and colours them; taken for
independent noise it makes every candidate look certain. Series are multiplied by the
inverse root of their cross-spectral density, so that what is left is white in time,
of unit variance and independent between channels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from scipy.fft import dct, idct, irfft, next_fast_len, rfft
from scipy.ndimage import uniform_filter1d

SEGMENT = 4.0
"""s of the segments of the spectra (Hann window, half overlapping)."""

BANDWIDTH = 1.0
"""Hz over which a spectrum is smoothed."""

EDGE = 1.0
"""s at both ends of a series that are left out when white: what came before the first sample is not known."""

STRIDE = 256
"""Samples to whole numbers of which the length of a transform is rounded up."""

LEAST = 1e-8
"""Added to the power of each channel, as a share of its mean over frequency, so that the matrix can be inverted even where one channel
copies another."""

BURST = 0.3
"""s over which an error of the integration is taken together: it is made where a wheel meets an edge or leaves the ground."""

SMOOTHEST = 0.05
"""Share of its mean below which local power does not count as less: a sample on a smooth stretch weighs at most twenty times as much."""


@dataclass(frozen=True)
class Spectrum:
    """Cross-spectral density in units of white noise: a white series of unit variance has the unit matrix.

    ``frequency`` (Hz), ``density`` (frequency, channel, channel); ``lowest`` (Hz): frequency by channel below which it says nothing of a
    channel.
    """

    frequency: np.ndarray
    density: np.ndarray
    lowest: tuple[float, ...] = ()

    def __add__(self, other: Spectrum) -> Spectrum:
        """Sum of two spectra on the frequencies of the first."""
        return replace(self, density=self.density + _at(other, self.frequency))

    def __mul__(self, factor: float) -> Spectrum:
        return replace(self, density=factor * self.density)

    def no_larger(self, other: Spectrum) -> Spectrum:
        """The same with the power of every channel brought down to that of ``other`` where it is larger and the other has any; coherences stay."""
        most = np.einsum("fii->fi", _at(other, self.frequency)).real
        own = np.einsum("fii->fi", self.density).real
        scale = np.sqrt(np.minimum(1.0, np.divide(most, own, out=np.ones_like(own), where=(own > 0) & (most > 0))))
        return replace(self, density=self.density * scale[:, :, None] * scale[:, None, :])

    @property
    def judged(self) -> np.ndarray:
        """Whether it says something of a channel at a frequency, (frequency, channel)."""
        return self.frequency[:, None] >= np.array(self.lowest or (0.0,) * self.density.shape[-1])

    def regular(self) -> np.ndarray:
        """The density so that it can be inverted; one, and unrelated to others, where it says nothing of a channel."""
        both = self.judged[:, :, None] & self.judged[:, None, :]
        return np.where(both, _regular(self.density), np.eye(self.density.shape[-1]))

    def power(self, band: tuple[float, float], rate: float) -> np.ndarray:
        """Mean square (channel,) within a band of a series sampled at ``rate`` (Hz)."""
        kept = (self.frequency >= band[0]) & (self.frequency <= band[1])
        own = self.density[kept][:, range(self.density.shape[-1]), range(self.density.shape[-1])].real
        return (own * self.judged[kept]).mean(axis=0) * 2 * (band[1] - band[0]) / rate

    def log_determinant(self, band: tuple[float, float]) -> float:
        """Mean of log det over the band: the Gaussian information of one sample is half of it (Whittle 1953)."""
        kept = (self.frequency >= band[0]) & (self.frequency <= band[1])
        return float(np.mean(np.linalg.slogdet(self.regular()[kept])[1]))


def cross_spectrum(
    series: Sequence[np.ndarray], rate: float, lowest: tuple[float, ...] = (), bandwidth: float = BANDWIDTH
) -> Spectrum:
    """Cross-spectral density of series (channel, sample) of one condition, by Welch's method.

    ``rate`` in Hz. Segments are averaged over all series and frequencies over ``bandwidth`` (Hz). What is slower than
    ``lowest`` (Hz, by channel) is taken out beforehand: it may be a hundred times larger, and windows leak.
    """
    length = min(int(round(SEGMENT * rate)), min(part.shape[1] for part in series))
    window = np.hanning(length + 1)[:-1]
    window /= np.sqrt(np.sum(window**2))
    total, count = 0.0, 0
    for part in series:
        part = _faster(part, rate, lowest)
        starts = np.arange(0, part.shape[1] - length + 1, max(length // 2, 1))
        pieces = np.stack([part[:, start : start + length] for start in starts])
        bins = np.fft.rfft(pieces * window, axis=-1)
        total = total + np.einsum("nif,njf->fij", bins, bins.conj())
        count += len(starts)
    density = total / count
    frequency = np.fft.rfftfreq(length, 1.0 / rate)
    width = max(1, int(round(bandwidth / frequency[1])) // 2 * 2 + 1)
    # No average reaches across an edge below which a channel says nothing.
    sections = np.split(np.arange(frequency.size), np.searchsorted(frequency, sorted(set(lowest))))
    parts = [uniform_filter1d(density[own], width, axis=0, mode="nearest") for own in sections if own.size]
    return Spectrum(frequency, np.concatenate(parts), lowest)


def _faster(series: np.ndarray, rate: float, lowest: tuple[float, ...]) -> np.ndarray:
    """Series (channel, sample) without what is slower than ``lowest`` (Hz, by channel). At its ends a series is mirrored: one that ends slower
    than it begins would jump there, if it were taken to come round again."""
    if not lowest:
        return series
    frequency = 0.5 * rate * np.arange(series.shape[1]) / series.shape[1]
    kept = frequency >= np.array(lowest)[:, None]
    return idct(np.where(kept, dct(series, axis=1), 0.0), axis=1)


@dataclass(frozen=True)
class Whitening:
    """Makes series with a known spectrum white within a band (Hz); outside it nothing is left.

    ``scale``: rms of the white series over its samples where that is known to vary; it is divided out.
    """

    spectrum: Spectrum
    rate: float
    band: tuple[float, float]
    scale: np.ndarray | None = None

    def __post_init__(self):
        values, vectors = np.linalg.eigh(self.spectrum.regular())
        root = np.einsum("fik,fk,fjk->fij", vectors, values**-0.5, vectors.conj())
        root *= self.spectrum.judged[:, :, None]
        object.__setattr__(self, "_root", root)
        object.__setattr__(self, "_known", {})

    def __call__(self, series: np.ndarray, start: int = 0, total: int | None = None) -> np.ndarray:
        """White series of the same shape (..., channel, sample), in the precision of ``series``.

        ``start``, ``total``: of a piece, its first sample in the record and the samples of that.
        """
        count = series.shape[-1]
        total = count if total is None else total
        white = irfft(self._filter(count, np.asarray(series)), self._length(count), axis=-1)[..., :count]
        edge = min(int(EDGE * self.rate), total // 10)
        white[..., : max(edge - start, 0)] = 0.0
        white[..., max(total - edge - start, 0) :] = 0.0
        if self.scale is None:
            return white
        return white / self.scale[start : start + count].astype(white.dtype)

    def _length(self, count: int) -> int:
        whole = STRIDE * -(-count // STRIDE)  # few lengths, so that few filters have to be kept
        return next_fast_len(whole + int(SEGMENT * self.rate), real=True)

    def _filter(self, count: int, series: np.ndarray) -> np.ndarray:
        length = self._length(count)
        bins = rfft(series, length, axis=-1)
        key = length, bins.dtype
        if key not in self._known:
            frequency = np.fft.rfftfreq(length, 1.0 / self.rate)
            root = _interpolate(self.spectrum.frequency, self._root, frequency)
            root[(frequency < self.band[0]) | (frequency > self.band[1])] = 0.0
            self._known[key] = np.ascontiguousarray(root.transpose(1, 2, 0), bins.dtype)
        return _times(self._known[key], bins.reshape(-1, *bins.shape[-2:])).reshape(bins.shape)


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def _times(matrix, bins):
    """A matrix at every frequency, (channel, channel, frequency), times (series, channel, frequency)."""
    found = np.empty_like(bins)
    count, channels, frequencies = bins.shape
    for k in range(count):
        for i in range(channels):
            for f in range(frequencies):
                found[k, i, f] = matrix[i, 0, f] * bins[k, 0, f]
            for j in range(1, channels):
                for f in range(frequencies):
                    found[k, i, f] += matrix[i, j, f] * bins[k, j, f]
    return found


def local_scale(white: np.ndarray, rate: float, seconds: float = 4.0) -> np.ndarray:
    """Running rms (sample,) over all channels of a white series (channel, sample), against its mean over the record.

    Errors are larger where the road is rough; where they are, a sample weighs less. What ``Whitening`` leaves out at both ends does not count.
    """
    power = np.mean(white**2, axis=0)
    inside = power > 0.0
    if not inside.any():
        return np.ones(power.shape)
    over = lambda values: uniform_filter1d(values, max(1, int(seconds * rate)), mode="nearest")
    mean, share = power[inside].mean(), over(inside.astype(float))
    local = over(power) / np.where(share > 0.0, share, 1.0)
    return np.sqrt(np.maximum(local / mean, SMOOTHEST))


def beside(scale: np.ndarray, wrong: np.ndarray, rate: float, seconds: float = BURST) -> np.ndarray:
    """A ``scale`` (sample,) with the running rms over all channels of a white error (channel, sample) beside it."""
    power = uniform_filter1d(np.mean(wrong**2, axis=0), max(1, int(seconds * rate)), mode="nearest")
    return np.sqrt(scale**2 + power)


def _regular(density: np.ndarray) -> np.ndarray:
    """The density with every channel's own power raised by LEAST of its mean, so that it can be inverted."""
    count = density.shape[-1]
    own = density[..., range(count), range(count)].real
    raised = density.copy()
    raised[..., range(count), range(count)] = own * (1 + 1e-6) + LEAST * own.mean(axis=0) + 1e-300
    return raised


def _at(spectrum: Spectrum, frequency: np.ndarray) -> np.ndarray:
    return _interpolate(spectrum.frequency, spectrum.density, frequency)


def _interpolate(known: np.ndarray, values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Linear interpolation along the first axis; ends are held."""
    place = np.clip(np.interp(wanted, known, np.arange(known.size)), 0, known.size - 1)
    left = np.minimum(place.astype(int), known.size - 2)
    part = (place - left)[:, None, None]
    return values[left] * (1 - part) + values[left + 1] * part
