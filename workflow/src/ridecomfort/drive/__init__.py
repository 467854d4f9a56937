"""Measured drives: reading, checking, gravity, sensor position, alignment with the road."""
