"""Where model and measurement differ, which physical effect is missing, and what it is worth."""

from .diagnose import diagnose
from .discover import discover
from .rank import rank

__all__ = ["diagnose", "discover", "rank"]
