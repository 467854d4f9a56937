"""Ride comfort on real roads: from a scanned surface to critical sections."""

__version__ = "0.1.0"
