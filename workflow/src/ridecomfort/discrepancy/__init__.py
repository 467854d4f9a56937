"""Where model and measurement differ, which physical effect is missing, and what it is worth."""

from .discover import discover
from .rank import rank

__all__ = ["discover", "rank"]
