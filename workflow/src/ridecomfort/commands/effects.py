"""The library of effects: what each one is, its parameters with units, its port and its source."""

from __future__ import annotations

from pathlib import Path

from ..effects import library, table


def arguments(parser) -> None:
    parser.add_argument("names", nargs="*", metavar="EFFECT", help="only these effects")
    parser.add_argument("--folder", type=Path, metavar="FOLDER", help="a folder with effects of your own as well")
    parser.add_argument("--csv", action="store_true", help="as a table of comma-separated values, one row a parameter")


def run(options) -> None:
    entries = library.find(options.folder)
    if options.names:
        library.choose(options.names, options.folder)
        entries = {name: entries[name] for name in options.names}
    print(table.frame(entries).to_csv(index=False) if options.csv else table.text(entries), end="")
