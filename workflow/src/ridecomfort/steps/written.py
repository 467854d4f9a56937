"""Tables and figures as files, in every form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from ..report import style, table
from ..store import replacing


def tables(made: Mapping[str, table.Table], folder: Path) -> None:
    """Write tables by name into a folder, in every form that a table has."""
    for name, each in made.items():
        for suffix, form in table.WRITERS.items():
            with replacing(folder / f"{name}{suffix}") as part:
                part.write_text(form(each), encoding="utf-8")


def figures(drawn: Mapping[str, Callable], folder: Path) -> None:
    """Draw figures, each by its function without arguments, and write them into a folder as PNG and PDF."""
    for name, draw in drawn.items():
        with style.styled():
            figure = draw()
        for suffix in style.METADATA:
            with replacing(folder / f"{name}{suffix}") as part:
                style.save(figure, part)
