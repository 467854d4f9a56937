"""Where model and measurement differ, which physical effect is missing, and what it is worth."""

from importlib import import_module

MODULES = {"diagnose": "diagnosis", "discover": "discovery", "rank": "naming"}
"""Module of each function of the package. It is imported when the function is asked for: a step that compares needs no search."""


def __getattr__(name):
    if name in MODULES:
        return getattr(import_module(f".{MODULES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
