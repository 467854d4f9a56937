"""How every step is called: files and configuration in, files out, one clear line on a user's mistake."""

from __future__ import annotations

import argparse
import gc
import json
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError

NOTE = "note: "
"""Begins a line of a log that a person who waits is shown as well."""


@dataclass(frozen=True)
class Command:
    """A step as a command of its own, ``python -m ridecomfort.steps.<step>``.

    ``main`` is called with one keyword argument per option. Options are files
    (``inputs``, ``outputs``; those in ``many`` take several and give a list,
    those in ``optional`` may be left out or empty and give None, or an empty list), plain ``texts``, and
    ``--config``, a JSON object of exactly the settings that the step uses.
    """

    main: Callable
    inputs: Sequence[str] = ()
    outputs: Sequence[str] = ("output",)
    many: Sequence[str] = ()
    optional: Sequence[str] = ()
    texts: Sequence[str] = ()

    def parser(self) -> argparse.ArgumentParser:
        module = sys.modules[self.main.__module__]
        spec = getattr(module, "__spec__", None)
        parser = argparse.ArgumentParser(
            prog=f"python -m {spec.name}" if spec else None, description=module.__doc__
        )
        for name in (*self.inputs, *self.optional, *self.outputs):
            parser.add_argument(
                f"--{name.replace('_', '-')}",
                dest=name,
                type=Path,
                metavar="FILE",
                nargs=("*" if name in self.optional else "+") if name in self.many else "?" if name in self.optional else None,
                default=[] if name in self.many else None,
                required=name not in self.optional,
            )
        for name in self.texts:
            parser.add_argument(f"--{name.replace('_', '-')}", dest=name, required=True)
        parser.add_argument("--config", type=json.loads, default={}, metavar="JSON")
        return parser

    def run(self, arguments: Sequence[str] | None = None) -> None:
        """Parse, call, and leave the process with status 1 on a user's mistake."""
        gc.freeze()  # what is imported stays: searching it for garbage takes a second when the process ends
        options = self.parser().parse_args(arguments)
        start = time.perf_counter()
        try:
            self.main(**vars(options))
        except InputError as problem:
            sys.exit(f"error: {problem}")
        print(f"done in {time.perf_counter() - start:.1f} s", file=sys.stderr)


def note(words: str) -> None:
    """Say in the log what a person should see without opening it."""
    print(f"{NOTE}{words}", file=sys.stderr, flush=True)


def counted(function: Callable, what: str, every: int = 50) -> Callable:
    """The function, with a line every so many calls that says how many there were, for what ends nobody knows when."""
    start, calls = time.perf_counter(), 0

    def call(*arguments, **options):
        nonlocal calls
        calls += 1
        if calls % every == 0:
            print(f"{calls} {what} in {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
        return function(*arguments, **options)

    return call


def countdown(total: int, what: str) -> Callable[[int], None]:
    """A function to call with the number done so far; every tenth of them it says how long it still takes."""
    start = time.perf_counter()

    def say(done: int) -> None:
        if done == total or done % max(1, total // 10) == 0:
            left = (time.perf_counter() - start) * (total - done) / done
            print(f"{done} of {total} {what}, {left:.0f} s left", file=sys.stderr, flush=True)

    return say
