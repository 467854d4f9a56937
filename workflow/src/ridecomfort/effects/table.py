"""The library of effects in words: what each one is, its sizes, where it acts and who says so."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import pandas as pd

from .contract import PORTS
from .library import Entry

COLUMNS = ("effect", "port", "parameter", "unit", "neutral", "typical", "lowest", "highest", "meaning", "sentence", "source")


def frame(entries: Mapping[str, Entry]) -> pd.DataFrame:
    """One row a parameter, columns COLUMNS; ``lowest`` and ``highest`` bound what is plausible."""
    rows = [
        (
            effect.name, effect.port, parameter.name, parameter.unit, parameter.neutral, parameter.typical,
            *parameter.plausible, parameter.meaning, effect.sentence, effect.source,
        )
        for effect in (entry.effect for entry in _in_order(entries))
        for parameter in effect.parameters
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=COLUMNS)


def text(entries: Mapping[str, Entry], width: int = 110) -> str:
    """The library to read in a terminal, by port, at most ``width`` characters wide."""
    lines, port = [], None
    for entry in _in_order(entries):
        effect = entry.effect
        if effect.port != port:
            port = effect.port
            lines += [f"Port {port}", *_filled(PORTS[port].meaning, width, "  "), ""]
        lines += [effect.name, *_filled(effect.sentence, width, "  ")]
        widest = max((len(parameter.name) for parameter in effect.parameters), default=0)
        for parameter in effect.parameters:
            low, high = parameter.plausible
            sizes = f"{low:g} to {high:g}, typically {parameter.typical:g}"
            if parameter.neutral != parameter.typical:
                sizes += f", none at {parameter.neutral:g}"
            head = f"    {parameter.name:{widest}}  [{parameter.unit}]  "
            lines += _filled(f"{sizes}: {parameter.meaning}", width, " " * (widest + 8), head)
        lines += [*_filled(f"Source: {effect.source}", width, "  "), ""]
    return "\n".join(lines)


def _in_order(entries: Mapping[str, Entry]) -> list[Entry]:
    order = list(PORTS)
    return sorted(entries.values(), key=lambda entry: (order.index(entry.effect.port), entry.effect.name))


def _filled(words: str, width: int, indent: str, first: str | None = None) -> list[str]:
    return textwrap.wrap(words, width, initial_indent=indent if first is None else first, subsequent_indent=indent)
