"""The three comfort methods, from signals to critical sections, and how they agree."""

from ..lazy import on_demand

__getattr__ = on_demand(__name__, ("iri", "iso2631", "sections"))
