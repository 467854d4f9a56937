"""Where model and measurement differ, which physical effect is missing, and what it is worth.

The modules, by what they are for and in the order in which they rest on one another:

- errors of drives that a model is meant to explain: spectrum, span, response, judged, nuisances, experiment, floor, wheels, elsewhere, car, onemass
- where model and measurement differ, and by how much: explain, bursts, shared, classes, unlike, realign, compare, locate, findings, critical,
  ladder
- which effect is missing: candidates, opening, probe, exemplar, evidence, across, event, propose, refit, rung, allowance, exclusion, selection, tries,
  foresight, balance, confirm, cluster, contest, consistency, turns, select, off_file, beyond, ranking
- what is said of it: verdict, found, suspect, one_signal, reasoning, judge, amended, naming
- a force that is in no library: terms, places, meanings, made, form, discovery, curves, signature, missing_force
- all of it together: reconsider, righted, diagnosis, score
"""

from importlib import import_module

MODULES = {"diagnose": "diagnosis", "discover": "discovery", "rank": "naming"}
"""Module of each function of the package. It is imported when the function is asked for: a step that compares needs no search."""


def __getattr__(name):
    if name in MODULES:
        return getattr(import_module(f".{MODULES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
