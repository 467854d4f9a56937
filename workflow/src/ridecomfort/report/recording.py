"""The plot of one recording or profile that ``ridecomfort comfort`` writes."""

from __future__ import annotations

from collections.abc import Callable

from ..comfort.alone import Result
from . import notation, style

HEIGHT = 2.4
"""Inches of each panel."""


def draw(result: Result, path) -> None:
    """Write the plot of a result as PNG or PDF, by the ending of the path."""
    panels: dict[str, Callable] = {"iso2631": _ride, "thresholds": _styles, "iri": _roughness}
    with style.styled():
        figure = panels[result.method](result)
        figure.suptitle(notation.literal(result.title), x=0.01, ha="left", fontsize=8)
    style.save(figure, path)


def _ride(result: Result):
    figure = style.figure(style.DOUBLE, HEIGHT)
    axes, scale = figure.subplots(1, 2, sharey=True, width_ratios=[16, 1])
    signals = result.signals
    for (color, _), name in zip(style.LINES, ("a_wx", "a_wy", "a_wz")):
        if name in signals:
            axes.plot(signals["time"], signals[name], color=color, linewidth=0.6, label=f"$a_{{w{name[-1]}}}$")
    axes.plot(signals["time"], signals["a_v"], color=style.MEASURED, label="$a_v$")
    top = 1.15 * float(signals["a_v"].max())
    # Bands overlap: every other one stands beside its neighbours.
    for place, (name, (lower, upper)) in enumerate(result.edges.items()):
        if lower < top:
            upper = min(upper, top)
            scale.bar(place % 2, upper - lower, bottom=lower, width=0.95, color=style.SEVERITY[name])
            color = "white" if name in ("VU", "EU") else "black"
            scale.text(place % 2, 0.5 * (lower + upper), name, fontsize=5, ha="center", va="center", color=color)
    scale.set_axis_off()
    axes.set(xlabel="Time [s]", ylabel="Running rms [m/s²]", ylim=(0, top), xlim=_ends(signals["time"]))
    axes.legend(loc="upper left", ncols=4)
    return figure


def _styles(result: Result):
    names = list(result.signals.data_vars)
    figure = style.figure(style.DOUBLE, 0.7 * HEIGHT * len(names))
    for axes, name in zip(figure.subplots(len(names), sharex=True, squeeze=False)[:, 0], names):
        axes.plot(result.signals["time"], result.signals[name], color=style.SIGNAL, linewidth=0.6)
        for label, band in result.edges[name].items():
            axes.axhline(band.lower, color=style.SEVERITY[label], linewidth=0.8, label=label)
            axes.axhline(band.upper, color=style.SEVERITY[label], linewidth=0.8)
        axes.set(ylabel=style.axis_label(name), xlim=_ends(result.signals["time"]))
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderpad=0.0, ncols=3)
    axes.set_xlabel("Time [s]")
    return figure


def _roughness(result: Result):
    figure = style.figure(style.DOUBLE, HEIGHT)
    axes = figure.subplots()
    for (color, _), name in zip(style.LINES, result.signals.data_vars):
        axes.stairs(
            result.table[f"{name} [m/km]"], [*result.table["from [m]"], result.table["to [m]"].iloc[-1]],
            color=color, baseline=None, label=name,
        )
    axes.set(xlabel="Distance [m]", ylabel=f"IRI [{notation.unit(result.unit)}]", xlim=_ends(result.signals["s"]))
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderpad=0.0, ncols=4)
    return figure


def _ends(values) -> tuple[float, float]:
    return float(values[0]), float(values[-1])
