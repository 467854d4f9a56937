"""The command ``ridecomfort``: one subcommand per module of ``ridecomfort.commands``."""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import sys
from collections.abc import Sequence

from . import __version__, commands
from .errors import InputError


def parser() -> argparse.ArgumentParser:
    """The parser with every subcommand that there is a module for."""
    answer = argparse.ArgumentParser(prog="ridecomfort", description=commands.__doc__.splitlines()[0])
    answer.add_argument("--version", action="version", version=__version__)
    subcommands = answer.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in sorted(module.name for module in pkgutil.iter_modules(commands.__path__)):
        module = importlib.import_module(f"{commands.__name__}.{name}")
        summary = module.__doc__.splitlines()[0]
        subparser = subcommands.add_parser(name, help=summary, description=module.__doc__)
        module.arguments(subparser)
        subparser.set_defaults(run=module.run)
    return answer


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a subcommand; a user's mistake is one line and status 1."""
    options = parser().parse_args(arguments)
    try:
        options.run(options)
    except InputError as problem:
        sys.exit(f"error: {problem}")


if __name__ == "__main__":
    main()
