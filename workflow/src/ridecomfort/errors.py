"""The one exception that a user's mistake raises, how a command ends on it, and what may have been meant."""

from __future__ import annotations

import difflib
from collections.abc import Collection


class InputError(ValueError):
    """A file, value or name given by the user that the study cannot work with.

    The message is one line that names the file, the place in it, the value and
    what was expected. Commands print it and exit with status 1; no traceback.
    """

    def __init__(self, problem: str, *, file=None, place: str | None = None):
        where = ": ".join(str(part) for part in (file, place) if part is not None)
        super().__init__(f"{where}: {problem}" if where else problem)


def hint(name, known: Collection[str], otherwise: str = "known are") -> str:
    """What may have been meant by a name that is not ``known``: the one most like it, else all there are behind the words ``otherwise``."""
    close = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {close[0]!r}?" if close else f"{otherwise} {', '.join(known)}"
