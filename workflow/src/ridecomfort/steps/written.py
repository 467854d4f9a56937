"""Tables and figures as files, in every form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from .. import pool
from ..report import style, table
from ..store import replacing


def tables(made: Mapping[str, table.Table], folder: Path) -> None:
    """Write tables by name into a folder, in every form that a table has."""
    for name, each in made.items():
        for suffix, form in table.WRITERS.items():
            with replacing(folder / f"{name}{suffix}") as part:
                part.write_text(form(each), encoding="utf-8")


def figures(drawn: Mapping[str, Callable], folder: Path, workers: int = 1) -> None:
    """Draw figures, each by its function without arguments and so many at a time, and write them into a folder as PNG and PDF."""

    def write(name: str) -> None:
        with style.styled():
            figure = drawn[name]()
        for suffix in style.METADATA:
            with replacing(folder / f"{name}{suffix}") as part:
                style.save(figure, part)

    for _ in pool.mapped(workers)(write, drawn):
        pass
