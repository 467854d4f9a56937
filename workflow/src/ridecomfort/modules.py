"""Which files of the package a module rests on, so that editing the library reruns what depends on it."""

from __future__ import annotations

import ast
import hashlib
import os
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parent

LOADS = {
    "effects/compose.py": ("vehicle/kernel.py", "effects/neutral.py"),
    "drive/readers/__init__.py": ("drive/readers/*.py",),
}
"""What modules load by other means than an import."""

IMPORT = re.compile(r"^[ \t]*((?:from[ \t]+[.\w]+[ \t]+)?import[ \t](?:[^\n(]*\([^)]*\)|[^\n]*))", re.MULTILINE)
"""What an import looks like in the text of a module. To parse all of every module takes a second of each call of Snakemake."""

DATA = (".yaml", ".json", ".csv", ".html", ".css", ".js")
"""Suffixes of files that modules read from their own folder."""


def of_step(step: str) -> list[str]:
    """Paths of the modules that ``ridecomfort.steps.<step>`` imports, its own included, and their data.

    Paths are relative to the working directory. Found in the source text without importing anything, so that a workflow of a thousand
    jobs starts fast. A step that is not written yet rests on nothing.
    """
    found = with_imports(_files(("steps", step)))
    found |= {data for path in found for data in path.parent.glob("*.*") if data.suffix in DATA}
    return sorted(os.path.relpath(path) for path in found)


def with_imports(files: Iterable[Path]) -> set[Path]:
    """These files, those of the package or of a user, with the modules of the package that they import and that those import in turn."""
    found: set[Path] = set()
    waiting = list(files)
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting.extend(_imported(path))
    return found


def compiled() -> str:
    """Hexadecimal digits that change with any module that holds compiled functions.

    numba notices that the file of a cached function was edited, but not that of a function
    which was compiled into it; a cache folder of this name never holds stale code.
    """
    digest = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        content = path.read_bytes()
        if b"numba" in content:
            digest.update(content)
    return digest.hexdigest()[:12]


def imports(text: str) -> Iterator[ast.Import | ast.ImportFrom]:
    """The imports anywhere in the text of a module, those within functions included; words of a docstring are none."""
    for found in IMPORT.finditer(text):
        try:
            yield from ast.parse(found.group(1)).body
        except SyntaxError:
            continue


@cache
def _imported(path: Path) -> frozenset[Path]:
    """The package's modules that one file imports anywhere in its text."""
    found: set[Path] = set()
    for node in imports(path.read_text(encoding="utf-8", errors="replace")):
        if isinstance(node, ast.Import):
            for alias in node.names:
                found |= _files(_inside(alias.name))
        else:
            parts = _source(path, node)
            if parts is not None:
                found |= _files(parts)
                for alias in node.names:
                    found |= _files((*parts, alias.name))
    own = path.relative_to(PACKAGE).as_posix() if PACKAGE in path.parents else ""
    for pattern in LOADS.get(own, ()):
        found.update(PACKAGE.glob(pattern))
    return frozenset(found - {path})


def _source(path: Path, node: ast.ImportFrom) -> tuple[str, ...] | None:
    """Parts of the module that a ``from`` imports from, below the package; None outside of it."""
    named = tuple(node.module.split(".")) if node.module else ()
    if node.level == 0:
        return _inside(node.module)
    if PACKAGE not in path.parents:
        return None
    parents = path.relative_to(PACKAGE).parts[: -node.level]
    return (*parents, *named)


def _inside(name: str) -> tuple[str, ...] | None:
    parts = name.split(".")
    return tuple(parts[1:]) if parts[0] == PACKAGE.name else None


def _files(parts: tuple[str, ...] | None) -> set[Path]:
    """The file of a module and the ``__init__`` of every package above it; empty where there is none."""
    if parts is None:
        return set()
    module = PACKAGE.joinpath(*parts).with_suffix(".py") if parts else None
    package = PACKAGE.joinpath(*parts, "__init__.py")
    if module is not None and module.is_file():
        found = {module}
    elif package.is_file():
        found = {package}
    else:
        return set()
    found |= {PACKAGE.joinpath(*parts[:depth], "__init__.py") for depth in range(len(parts))}
    return {file for file in found if file.is_file()}
