"""How rough the roads are: spectra and coherence of the wheel tracks, and what smoothing changes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ...road import roughness
from .. import style
from ..study import Study
from ..tables.roads import used

TRACK_COLOURS = tuple(style.LINES[place][0] for place in (0, 5, 2, 3))
"""Of the right and the left wheel track, or of as many as are configured from the right to the left."""

TRACK_WIDTHS = (2.0, 0.9, 0.9, 0.9)
"""Points; the second line is narrower, so that tracks that are alike show both."""

WAVENUMBERS = (0.005, 5.0)
"""cycles/m shown."""


def spectrum(study: Study, name: str) -> Figure:
    """Displacement spectra of a site's wheel tracks on the ISO 8608 classes, and their coherence."""
    site = study.site(name)
    found = used(site)
    drawn = style.figure(style.DOUBLE, 3.3)
    density, common = drawn.subplots(1, 2, width_ratios=(1.5, 1))
    n = np.array(WAVENUMBERS)
    _classes(density, n)
    if "displacement_psd" in found:
        _tracks(density, site.inspection, found)
        if found.sizes["track"] > 1:
            _coherence(common, found)
        else:
            common.text(0.5, 0.5, "one wheel track only", transform=common.transAxes, ha="center")
    else:
        for axes in (density, common):
            axes.text(0.5, 0.5, "the road is too short,\nor a wheel track is not on it", transform=axes.transAxes, ha="center")
    density.set(xscale="log", yscale="log", xlim=n, ylim=(1e-10, 10.0))
    density.set_xlabel("wavenumber $n$ [cycles/m]")
    density.set_ylabel("displacement spectral density $G_d$ [m³]")
    density.set_title(f"{site.label}: wheel tracks on the classes of ISO 8608")
    common.set(xscale="log", xlim=n, ylim=(0, 1.02))
    common.set_xlabel("wavenumber $n$ [cycles/m]")
    common.set_ylabel("coherence [-]")
    common.set_title("left and right track")
    return drawn


def _classes(axes, n) -> None:
    """Bands of the classes A to H, each a factor 4 wide and falling with the square of the wavenumber."""
    for number, letter in enumerate(roughness.CLASSES):
        middle = roughness.CLASS_B_UPPER * 4.0 ** (number - 1.5)
        low, high = 0.0 if letter == "A" else middle / 2, np.inf if letter == roughness.CLASSES[-1] else middle * 2
        fall = (n / roughness.REFERENCE_WAVENUMBER) ** -2
        colour = "#F1F3F5" if number % 2 else "#DCE1E6"
        lowest, highest = np.maximum(low * fall, 1e-12), np.minimum(high * fall, 1e3)
        axes.fill_between(n, lowest, highest, color=colour, linewidth=0, zorder=0)
        level = middle * (n[1] / roughness.REFERENCE_WAVENUMBER) ** -2
        axes.text(1.15 * n[1], level, letter, fontsize=7, color="#5F6B73", va="center")


def _tracks(axes, stages, found) -> None:
    before = stages["smoothed_psd"].sel(stage="measured")
    changed = bool(np.isfinite(before).all()) and not np.array_equal(before, found["smoothed_psd"])
    tracks = found["track"].values
    # Of two tracks the right one stands first, wherever the reference line lies.
    sides = ("right", "left") if len(tracks) == 2 else [f"{track:g} m" for track in tracks]
    for colour, width, side, track in zip(TRACK_COLOURS, TRACK_WIDTHS, sides, tracks):
        one = found.sel(track=track)
        level, waviness = one["unevenness"].item(), one["waviness"].item()
        text = f"{side}: class {one['class'].item()}, $G_d(n_0)$ = {1e6 * level:.1f} cm³, w = {waviness:.2f}"
        axes.plot(found["wavenumber"], one["displacement_psd"], color=colour, linewidth=0.3, alpha=0.35)
        axes.plot(found["band"], one["smoothed_psd"], color=colour, linewidth=width, label=text)
        fitted = np.array(roughness.FITTED)
        line = level * (fitted / roughness.REFERENCE_WAVENUMBER) ** -waviness
        axes.plot(fitted, line, color=colour, linewidth=0.8, linestyle=(0, (4, 2)))
        if changed:
            axes.plot(found["band"], before.sel(track=track), color=colour, linewidth=0.9, linestyle=":")
    axes.plot([], [], color=style.MEASURED, linewidth=0.8, linestyle=(0, (4, 2)), label="straight line fitted")
    if changed:
        axes.plot([], [], color=style.MEASURED, linewidth=0.9, linestyle=":", label="as measured")
    axes.legend(loc="upper right")


def _coherence(axes, found) -> None:
    n, values = found["wavenumber"].values, found["coherence"].values
    axes.plot(n, values, color=style.FAINT, linewidth=0.3, alpha=0.7)
    limits = roughness.bands(1.5 * n[0], n[-1])
    centres = np.sqrt(limits.prod(axis=1))
    within = [values[(n >= low) & (n < high)] for low, high in limits]
    known = [number for number, part in enumerate(within) if part.size]
    axes.plot(centres[known], [within[number].mean() for number in known], color=style.SIGNAL, linewidth=1.1)


def smoothing(study: Study) -> Figure:
    """What smoothing with cross-validated splines would change: a row for each site."""
    rows = len(study.sites)
    drawn = style.figure(style.DOUBLE, 0.4 + 1.9 * rows)
    grid = drawn.subplots(rows, 3, squeeze=False)
    for (error, density, vibration), site in zip(grid, study.sites):
        found = site.inspection
        for (colour, marker), direction in zip(style.LINES, ("along", "across")):
            one = found.sel(direction=direction)
            tried, missed = one["trial_cutoff"].values, 1e3 * one["held_out_error"].values
            error.loglog(tried, missed, color=colour, label=f"{direction}: {one['cutoff'].item():.2f} m")
            error.plot(tried[missed.argmin()], missed.min(), marker, color=colour, markersize=4)
        low, high = error.get_ylim()
        style.number_decades(error.yaxis, (1, 2, 5))
        if high < 10 * low:
            error.yaxis.set_major_locator(MaxNLocator(4))
        error.set_ylabel("held-out error [mm]")
        error.legend(title="cut-off of least error", title_fontsize=7)
        error.set_title(site.label)
        for colour, stage in ((style.MEASURED, "repaired"), (style.CALIBRATED, "smoothed")):
            one = found.sel(stage=stage)
            style_of = {"color": colour, "linewidth": 1.3 if stage == "repaired" else 0.9}
            if "smoothed_psd" in one:
                text = f"{stage}: IRI {one['iri_track'].mean().item():.3f} m/km"
                density.loglog(found["band"], one["smoothed_psd"].mean("track"), label=text, **style_of)
            text = f"{stage}: rms {one['a_z_rms'].item():.4f} m/s²"
            vibration.semilogy(found["frequency"][1:], one["acceleration_psd"][1:], label=text, **style_of)
        density.set_ylabel("$G_d$ [m³]")
        vibration.set_ylabel("density of $a_z$ [m²/s³]")
        vibration.set_xlim(0, 50)
        if "smoothed_psd" in found:
            density.set_ylim(top=100 * density.get_ylim()[1])
            density.legend(loc="upper right")
        vibration.set_ylim(top=30 * vibration.get_ylim()[1])
        vibration.legend(loc="upper right")
    for axes, text in zip(grid[-1], ("cut-off tried [m]", "wavenumber $n$ [cycles/m]", "frequency [Hz]")):
        axes.set_xlabel(text)
    return drawn
