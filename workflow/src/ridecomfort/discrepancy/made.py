"""Effects that are made for a search, beside those of the user."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ..effects import library


@contextmanager
def beside(effects_folder, sources: Mapping[str, str]) -> Iterator[library.Unchanging]:
    """A folder, there for a while, with the effects of ``effects_folder`` (None for none) and those of ``sources``, by name."""
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(Path(effects_folder).glob("*.py")) if effects_folder else ():
            (Path(folder) / path.name).write_bytes(path.read_bytes())
        for name, source in sources.items():
            (Path(folder) / f"{name}.py").write_text(source, encoding="utf-8")
        yield library.Unchanging(folder)
