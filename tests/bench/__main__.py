"""How fast the study is: every `bench_*.py` beside this file, as a table and as JSON.

    python tests/bench [name ...]

Each file has a function ``bench`` that returns figures by name; a figure is a number, or a
mapping of names to figures. The table goes to the terminal, the JSON to results/bench.json, in
which benchmarks that are not run this time keep their figures.
"""

from __future__ import annotations

import importlib
import json
import os
import platform
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
OUTPUT = FOLDER.parents[1] / "results" / "bench.json"


def main(names: list[str]) -> None:
    sys.path[:0] = [str(FOLDER), str(FOLDER.parents[1])]
    found = sorted(path.stem.removeprefix("bench_") for path in FOLDER.glob("bench_*.py"))
    unknown = [name for name in names if name not in found]
    if unknown:
        sys.exit(f"error: no benchmark {unknown[0]!r}; there are {', '.join(found)}")
    figures = {}
    for name in names or found:
        figures[name] = importlib.import_module(f"bench_{name}").bench()
        for label, value in rows(figures[name]):
            print(f"{name:12} {label:52} {text(value):>14}", flush=True)
    machine = {"processor": platform.processor() or platform.machine(), "cores": os.cpu_count()}
    OUTPUT.parent.mkdir(exist_ok=True)
    figures = kept(machine, found) | figures
    OUTPUT.write_text(json.dumps({"machine": machine, "figures": figures}, indent=1) + "\n", encoding="utf-8")


def kept(machine: Mapping, found: list[str]) -> dict:
    """The figures of benchmarks that still exist, as the last run on the same machine left them."""
    try:
        last = json.loads(OUTPUT.read_text(encoding="utf-8"))
        return {name: last["figures"][name] for name in last["figures"] if name in found and last["machine"] == machine}
    except (OSError, ValueError, KeyError):
        return {}


def rows(figures: Mapping, above: str = "") -> Iterator[tuple[str, object]]:
    """Name and value of every figure, those of inner mappings under joined names."""
    for name, value in figures.items():
        if isinstance(value, Mapping):
            yield from rows(value, f"{above}{name}: ")
        else:
            yield f"{above}{name}", value


def text(value) -> str:
    """A figure as a person reads it: whole from a hundred on, else three digits."""
    if isinstance(value, int | float):
        return f"{value:,.0f}" if abs(value) >= 100 else f"{value:.3g}"
    return str(value)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main(sys.argv[1:])
