"""What a driver's foot did faster than a recorded speed tells: by the accelerometer.

A driver begins to brake within some tenths of a second. A speed with 14 mm/s of noise tells nothing of that, and a model that follows
its low-passed copy brakes too softly: at 0.8 to 2.8 Hz an error of 3 percent of the power of pitch rate, in which links against diving
are not seen. The accelerometer tells it, less what gravity and the turning of the body add at its place. A clean speed may tell no more: one
of wheels, whose radii change as the body bounces, or one that was recorded once a second.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from scipy import fft
from scipy.ndimage import uniform_filter1d
from scipy.signal import welch

from ..vocabulary import SIGNALS, STANDARD_GRAVITY
from .record import upward
from .sampling import rate_of
from .slow import DRIVER_BANDWIDTH, smooth, speed_noise

LEAST, HIGHEST = 0.2, 2.5
"""Hz from which on an accelerometer tells a speed, since it drifts below, and up to which a driver is brought to it: the speed controller, which
looks 0.3 s ahead, drives nothing of a wave of 3.3 Hz."""

MOST, TRUSTED = 0.5, 0.0025
"""Hz from which on an accelerometer is heard however clean the speed, if its noise makes no more of a speed than so many m/s (rms)."""

NOISE, WINDOW, DROWNED = (3.0, 8.0), 10.0, 2.0
"""Hz between which an acceleration along the road is noise, not a driver's; s of the spectra of that; and times the density of this noise that a
foot must reach, somewhere below DRIVER_BANDWIDTH, to be heard."""

ALIKE = 5
"""Neighbouring frequencies of such a spectrum that are taken together to tell how much of what is heard is noise."""

FLAT = 0.7
"""Share of the cut-off of a record up to which its filter is flat (``sampling.HALF_WIDTH``)."""

FADING = 2.0
"""s over which what is missing fades in behind the run-in of the model."""

HELPED = 0.5
"""Share of what is missing of the speed that a driver who is asked for it leaves at most."""

ORDER = 4
"""Order of the low-pass at the upper end, forwards and backwards."""


def listening(again, vehicle, effects=()):
    """The ``Following`` of a drive, ``again``, its driver brought to the measured speed and path, and to what the accelerometer tells of his
    foot. Not where that helps little: the driver of another simulator may answer otherwise. Raises InputError when the model cannot be driven."""
    slow = again.following(vehicle, effects)
    by_foot = band(slow.replay, slow.simulated)
    if by_foot is None:
        return slow
    before = replace(slow, replay=replace(slow.replay, by_foot=by_foot, foot=missing_acceleration(slow.replay, slow.simulated)))
    after = before.brought(vehicle, effects)
    return after if after.missed("speed") <= HELPED * before.missed("speed") else slow


def without_noise(again, simulated):
    """A drive, ``again``, whose driver is asked for as much of what was heard of his foot as is likely to be his, and not the accelerometer's noise
    by what it leaves of a simulation (Wiener's filter); the same where he is not heard.

    All of it would move the model by noise, which its own record then takes for links that hold the body up against driving: the p-value of
    these was below 5 percent in four of 14 nulls. What the filter leaves out of a foot stays in the error; nothing in the model is driven by it.
    """
    if again.by_foot is None or again.foot is None:
        return again
    rate, (lower, upper) = rate_of(again.time), again.by_foot
    frequency, density = _density(again.foot, again)
    inside = (frequency >= lower) & (frequency <= upper)
    if not inside.any():
        return again
    of_noise = np.clip(_noise(*_density(missing_acceleration(again, simulated), again), again) / uniform_filter1d(density, ALIKE)[inside], 0.0, 1.0)
    heard = _faster(np.cumsum(again.foot) / rate, rate, lower)
    length = fft.next_fast_len(heard.size, real=True)
    share = np.interp(fft.rfftfreq(length, 1.0 / rate), frequency[inside], of_noise)
    by_chance = fft.irfft(share * fft.rfft(heard, length), length)[: heard.size]
    return replace(again, by_chance=driven(by_chance, rate, again.by_foot))


def words(bands: Iterable[tuple[float, float] | None]) -> str:
    """What is said of drives whose drivers are listened to in these bands (Hz), None where one is not; empty where none is."""
    heard = [band for band in bands if band is not None]
    if not heard:
        return ""
    lower, upper = (sorted({f"{band[end]:.1f}" for band in heard}) for end in (0, 1))
    to = lambda ends: ends[0] if len(ends) == 1 else f"{ends[0]}-{ends[-1]}"
    return f"what the accelerometer tells along the road from {to(lower)} Hz up to {to(upper)} Hz is taken for the driver's foot, which the model drives"


def missing_speed(again, simulated, by_speed: np.ndarray, band: tuple[float, float]) -> np.ndarray:
    """By how much a simulation of a drive (``again``, a ``Replay``) was too slow in m/s, (time,): below the ``band`` (Hz) as the recorded speed
    says (``by_speed``), within it as the accelerometer does."""
    rate = rate_of(again.time)
    gained = np.cumsum(missing_acceleration(again, simulated)) / rate
    return driven(gained + smooth(by_speed - gained, rate, band[0]), rate, band)


def driven(missing: np.ndarray, rate: float, band: tuple[float, float]) -> np.ndarray:
    """What of a missing speed (m/s) a driver is asked for: what is no faster than the ``band`` (Hz)."""
    return smooth(missing, rate, band[1], order=ORDER)


def missing_acceleration(again, simulated) -> np.ndarray:
    """By how much the centre of gravity was accelerated more along the body's x axis than in a simulation, in m/s2, (time,); nil in the run-in.

    Of a drive (``again``, a ``Replay``) and what its model did (``simulated``): the difference of the accelerometers, without what the difference
    of the rates tells of gravity, and of a sensor that is not there: on a roof 0.9 m above it a pitch of 1 mrad at 1.3 Hz is 0.06 m/s2.
    """
    rate = rate_of(again.time)
    fading = _fading(again.compared, rate)
    difference = (again.measured() - simulated.signals) * fading
    rates = difference[[SIGNALS.index(name) for name in ("roll_rate", "pitch_rate", "yaw_rate")]]
    along = difference[SIGNALS.index("a_x")]
    if again.drive.attrs.get("gravity", 0):
        turned = _faster(np.cumsum(rates[:2], axis=-1) / rate, rate, LEAST)
        true = upward(simulated.roll + turned[0], simulated.pitch + turned[1])
        along = along + STANDARD_GRAVITY * (again.up[0] - true[0]) * fading
    _, left, above = again.demand["sensor"]
    return along - above * np.gradient(rates[1], 1.0 / rate) + left * np.gradient(rates[2], 1.0 / rate)


def band(again, simulated) -> tuple[float, float] | None:
    """Hz from which and up to which a driver is brought to the accelerometer of a drive; None where that tells nothing that the model has not
    done. The noise of both is taken for white, that of the accelerometer with all that the model lacks at NOISE."""
    frequency, density = _density(missing_acceleration(again, simulated), again)
    noise = _noise(frequency, density, again)
    lower = _lower(noise, speed_noise(again.drive["v_x"].values, rate_of(again.time)))
    if not np.any(density[(frequency >= lower) & (frequency <= DRIVER_BANDWIDTH)] > DROWNED * noise):
        return None
    drowned = frequency[(frequency > DRIVER_BANDWIDTH) & (density < DROWNED * noise)]
    return lower, min(HIGHEST, float(drowned[0])) if drowned.size else HIGHEST


def _density(acceleration: np.ndarray, again) -> tuple[np.ndarray, np.ndarray]:
    """Hz, and the spectral density of an acceleration (time,) where a drive is compared."""
    rate, kept = rate_of(again.time), again.compared
    return welch(acceleration[kept], rate, nperseg=min(int(kept.sum()), int(WINDOW * rate)))


def _noise(frequency: np.ndarray, density: np.ndarray, again) -> float:
    """Density of the noise of what is missing in a drive; nan, by which nothing is heard, where its record was filtered below NOISE."""
    upper = min(NOISE[1], FLAT * float(again.drive.attrs["cut_off"]))
    inside = (frequency >= NOISE[0]) & (frequency <= upper)
    return float(np.median(density[inside])) if inside.any() else np.nan


def _lower(of_acceleration: float, of_speed: float) -> float:
    """Hz from which on an accelerometer of this noise ((m/s2)^2/Hz) is heard beside a speed of that ((m/s)^2/Hz)."""
    as_noisy = np.sqrt(of_acceleration / of_speed) / (2.0 * np.pi) if of_speed > 0.0 else np.inf
    trusted = of_acceleration / (2.0 * np.pi * TRUSTED) ** 2
    return float(max(LEAST, min(as_noisy, max(MOST, trusted))))


def _faster(series: np.ndarray, rate: float, lowest: float) -> np.ndarray:
    return series - smooth(series, rate, lowest)


def _fading(compared: np.ndarray, rate: float) -> np.ndarray:
    """One where a drive is compared, nil elsewhere, fading in over FADING, (time,)."""
    inside = np.cumsum(compared) / (FADING * rate)
    return np.where(compared, np.minimum(inside, 1.0), 0.0)
