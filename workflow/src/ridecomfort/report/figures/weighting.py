"""fig:validation_iso: how exact the frequency weighting is, and how exact the paper's way would be."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ...comfort import streaming, weighting
from .. import style
from ..study import Site, Study

SECONDS = 16.0
"""Length of the sample signal (sec:ride_comfort_results)."""

MARGIN = 3.0
"""Seconds before and after the sample that are weighted too, so that no transient is shown; a quarter of a signal that is short."""

RATE = 100.0
WEIGHTING = "Wk"


def validation_iso(study: Study) -> Figure:
    """A sample of vertical acceleration, weighted exactly and the paper's way; both against the analogue filter."""
    sample, origin = sample_signal(study)
    margin = int(min(MARGIN * RATE, 0.25 * sample.size))
    shown = slice(margin, min(margin + int(SECONDS * RATE), sample.size - margin))
    exact = weighting.weight(sample, RATE, WEIGHTING)[shown]
    papers = streaming.bilinear(WEIGHTING, RATE)
    bilinear = papers.filter(sample)[shown]
    sample = sample[shown]
    time = np.arange(sample.size) / RATE
    sine, amplitude = response_of_weight(WEIGHTING, RATE)
    frequency = np.geomspace(0.5, 0.499 * RATE, 400)
    analogue = weighting.named(WEIGHTING).factor(frequency)

    drawn = style.figure(style.DOUBLE, 4.6)
    grid = drawn.add_gridspec(3, 2, width_ratios=(1.5, 1.0))
    raw, weighted, difference = (drawn.add_subplot(grid[row, 0]) for row in range(3))
    raw.plot(time, sample, color=style.MEASURED, linewidth=0.6)
    raw.set_ylabel("$a_z$ [m/s²]")
    raw.set_title(f"(a) sample: {origin}")
    weighted.plot(time, exact, color=EXACT, linewidth=0.7, label="this study")
    weighted.plot(time, bilinear, color=BILINEAR, linewidth=0.7, dashes=(3, 1), label="bilinear, not prewarped")
    weighted.set_ylabel("$a_w$ [m/s²]")
    weighted.set_title(f"(b) weighted by {WEIGHTING}")
    weighted.legend(loc="upper right", ncols=2, borderaxespad=0)
    low, high = weighted.get_ylim()
    weighted.set_ylim(low, high + 0.25 * (high - low))
    difference.plot(time, bilinear - exact, color=BILINEAR, linewidth=0.6)
    difference.set_ylabel("difference [m/s²]")
    ratio = 100 * np.sqrt(np.mean((bilinear - exact) ** 2) / np.mean(exact**2))
    difference.set_title(f"(c) bilinear − this study: rms {ratio:.1f} % of the weighted signal")
    difference.set_xlabel("time [s]")
    for axes in (raw, weighted, difference):
        axes.set_xlim(0, sample.size / RATE)
    for axes in (raw, weighted):
        axes.tick_params(labelbottom=False)
    drawn.align_ylabels([raw, weighted, difference])

    factor, error = drawn.add_subplot(grid[:2, 1]), drawn.add_subplot(grid[2, 1])
    warped = np.abs(papers.response(frequency))
    factor.loglog(frequency, analogue, color=style.FAINT, linewidth=2.6, label="analogue filter (ISO 2631-1)")
    factor.loglog(sine, amplitude, "o", color=EXACT, markersize=2.6, label="this study, sines")
    factor.loglog(frequency, warped, color=BILINEAR, dashes=(3, 1), label="bilinear, not prewarped")
    factor.set_ylim(0.02, 2)
    factor.set_ylabel("weighting factor [-]")
    factor.set_title(f"(d) {WEIGHTING} at {RATE:g} Hz")
    factor.legend(loc="lower center")
    error.semilogx(frequency, _decibel(warped / analogue), color=BILINEAR, dashes=(3, 1))
    deviation = _decibel(amplitude / weighting.named(WEIGHTING).factor(sine))
    error.semilogx(sine, deviation, "o", color=EXACT, markersize=2.6)
    error.set_ylim(-6, 2)
    error.set_ylabel("error [dB]")
    largest = float(np.max(np.abs(deviation)))
    words = "below 0.001 dB" if largest < 0.001 else f"at most {largest:.3f} dB"
    error.set_title(f"(e) this study: {words}")
    error.set_xlabel("frequency [Hz]")
    for axes in (factor, error):
        axes.set_xticks([0.5, 1, 2, 5, 10, 20, 50], ["0.5", "1", "2", "5", "10", "20", "50"])
        axes.minorticks_off()
    factor.tick_params(labelbottom=False)
    factor.set_yticks([0.02, 0.05, 0.1, 0.2, 0.5, 1], ["0.02", "0.05", "0.1", "0.2", "0.5", "1"])
    return drawn


EXACT, BILINEAR = style.OURS, style.PAPER


def sampled(study: Study) -> Site:
    """The site that the sample signal comes from."""
    return study.compared[0] if study.compared else study.sites[0]


def sample_signal(study: Study) -> tuple[np.ndarray, str]:
    """16 s of vertical acceleration in m/s2 at 100 Hz, with 3 s before and after or what there is of it, and where they come from.

    The middle of the first measured drive; without drives, of the mean over the runs at its mean speed.
    """
    site = sampled(study)
    if study.compared:
        comparison = site.comparison.isel(drive=0)
        values = comparison["measured"].sel(signal="a_z").values
        time, origin = comparison["time"].values, f"measured on {site.label}"
    else:
        values = site.thresholds["a_z"].values
        speed = np.interp(site.thresholds["s"], site.iri["s"], site.iri["v_x"])
        time = np.cumsum(np.gradient(site.thresholds["s"].values) / speed)
        origin = f"mean of the runs on {site.label}"
    present = np.isfinite(values)
    time, values = time[present], values[present]
    length = SECONDS + 2 * MARGIN
    start = time[0] + max(0.0, 0.5 * (time[-1] - time[0] - length))
    count = min(int(length * RATE), int((time[-1] - start) * RATE) + 1)
    return np.interp(start + np.arange(count) / RATE, time, values), origin


def response_of_weight(name: str, rate: float, count: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz and amplitudes that sines of amplitude 1 have after ``comfort.weighting.weight``."""
    frequencies = np.geomspace(0.5, 0.45 * rate, count)
    time = np.arange(int(120 * rate)) / rate
    settled = slice(int(60 * rate), int(100 * rate))
    amplitudes = []
    for frequency in frequencies:
        phase = 2 * np.pi * frequency * time
        answer = weighting.weight(np.sin(phase), rate, name)[settled]
        basis = np.stack([np.sin(phase[settled]), np.cos(phase[settled])], axis=1)
        amplitudes.append(np.hypot(*np.linalg.lstsq(basis, answer, rcond=None)[0]))
    return frequencies, np.array(amplitudes)


def _decibel(ratio: np.ndarray) -> np.ndarray:
    return 20 * np.log10(ratio)
