"""Maps over several processes that share what the function holds, without sending it, and over threads."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor

_shared: list[Callable] = []


def _call(job):
    return _shared[-1](job)


def workers() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def mapped(count: int) -> Callable[[Callable, Iterable], Iterator]:
    """A ``map`` over ``count`` forked processes; the plain one where there is no fork or only one is wanted."""
    if count < 2 or "fork" not in multiprocessing.get_all_start_methods():
        return map

    def each(function: Callable, jobs: Iterable) -> Iterator:
        jobs = list(jobs)
        if len(jobs) < 2:
            return map(function, jobs)
        _shared.append(function)
        try:
            with multiprocessing.get_context("fork").Pool(min(count, len(jobs))) as pool:
                return iter(list(pool.imap(_call, jobs)))  # of several that fail the first is told
        finally:
            _shared.pop()

    return each


def side_by_side(count: int) -> Callable[[Callable, Iterable], Iterator]:
    """A ``map`` over threads for ``count`` cores, worth it where most of the work is compiled; the plain one within a fork, where the
    other cores are taken. Up to two threads a core: three equal jobs then share two cores in one and a half times one, not in two."""

    def each(function: Callable, jobs: Iterable) -> Iterator:
        jobs = list(jobs)
        if min(count, len(jobs)) < 2 or multiprocessing.parent_process() is not None:
            return map(function, jobs)
        with ThreadPoolExecutor(min(2 * count, len(jobs))) as threads:
            return iter(list(threads.map(function, jobs)))

    return each
