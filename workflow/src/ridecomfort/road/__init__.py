"""Roads: made of files or scans, checked, cleaned, and their heights anywhere."""

from ..lazy import on_demand

__getattr__ = on_demand(__name__, ("clean", "crg", "surface"))
