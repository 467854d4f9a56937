"""Ride comfort on real roads: from a scanned surface to critical sections."""

from .lazy import on_demand

__version__ = "0.1.0"

__getattr__ = on_demand(__name__, ("calibrate", "comfort", "discrepancy", "drive", "effects", "road", "simulate", "vehicle", "vocabulary"))
