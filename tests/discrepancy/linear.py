"""A model that is linear in everything, as an Experiment: what the search should find is known exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from ridecomfort.discrepancy import judge, select
from ridecomfort.discrepancy.experiment import Candidate, Record, Size

from .coloured import coloured

RATE, SAMPLES = 100.0, 3000


class Linear:
    """Residual = noise + sum of (value - truth) * column; three repeats share columns, a fourth drive has its own."""

    channels = ("a", "b", "c", "d")
    each_record = staticmethod(map)
    inexact: ClassVar[dict] = {}

    def __init__(self, seed, truth, noise=1.0, twins=None, library=6):
        rng = np.random.default_rng(seed)
        place = np.arange(SAMPLES) / RATE
        self.records = [
            Record(f"drive {k}", "check" if k == 3 else "fit", "road", "slow" if k == 3 else "usual", RATE, (0.3, 40.0), place, 1.0)
            for k in range(4)
        ]
        self.free = (Size("stiffness", "N/m", 0.0, -50.0, 50.0, 0.1),)
        self.candidates = tuple(
            Candidate(f"effect_{k}", (Size(f"effect_{k}.size", "N", 0.0, 0.0, 5.0, 0.1),)) for k in range(library)
        )
        keys = [size.key for size in self.free] + [candidate.sizes[0].key for candidate in self.candidates]
        responses = {condition: {key: coloured(rng, SAMPLES) for key in keys} for condition in ("usual", "slow")}
        for condition in responses.values() if twins else ():
            condition[twins[1]] = condition[twins[0]] + 0.003 * condition[twins[1]]
        self.columns = [responses[record.condition] for record in self.records]
        self.noise = [noise * coloured(rng, SAMPLES) for _ in self.records]
        self.truth = truth

    def residual(self, values, index):
        changed = dict.fromkeys(self.columns[index], 0.0) | {k: v for k, v in values.items() if k in self.columns[index]}
        terms = (changed[key] - self.truth.get(key, 0.0) for key in self.columns[index])
        return self.noise[index] + sum(t * column for t, column in zip(terms, self.columns[index].values()))

    def nuisances(self, values, index):
        return np.ones((1, 4, SAMPLES))

    def retuned(self, values, indices, exactly=False):
        return self, {index: self.residual(values, index) for index in indices}

    def realigned(self, amounts):
        return self

    def would_differ(self, one, other, index):
        return {}

    def taking(self, other, indices):
        return self

    def coarser(self, values, residuals):
        return self, residuals


def rounds(model, most):
    """What came of each round of a search of at most so many."""
    return select.select(model, {"stiffness": 0.0}, most=most).rounds


def judged(model, suspicions=()):
    """What a search of at most three rounds found on such a model, and the verdict on it."""
    selection = select.select(model, {"stiffness": 0.0}, most=3)
    return selection, judge.judge(selection, model.candidates, suspicions)


def alone(model):
    """The same drives where none repeats another."""
    model.records = [replace(record, condition=record.name) for record in model.records]
    return model
