"""From a set of effects to a compiled kernel, kept on disk between jobs.

Effects are joined into a small module of ports, and the kernel is compiled against it in
place of ``neutral``. Both are written to a folder named after their content, so that a
changed effect is compiled anew and everything else is found again.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numba
import numpy as np

from ..errors import InputError
from .contract import COMPILED, PORTS, Effect
from .library import Entry, of_the_library

PACKAGE = Path(__file__).parent.parent
SOURCES = ("vehicle/kernel.py", "vehicle/ground.py", "vehicle/driver.py", "vehicle/motion.py",
           "vehicle/constants.py", "vehicle/scratch.py", "vehicle/tyre.py", "road/surface.py", "effects/neutral.py", "effects/lag.py", "effects/wave.py",
           "vocabulary.py")  # fmt: skip
"""What the compiled kernel is made of; a change in any of them compiles anew."""


@dataclass(frozen=True)
class Kernel:
    """A compiled kernel, and how many states its effects have."""

    drive: Callable
    state_count: int


def cache_folder() -> Path:
    """Where compiled kernels are kept: $RIDECOMFORT_CACHE, or the user's cache folder."""
    named = os.environ.get("RIDECOMFORT_CACHE")
    if named:
        return Path(named).absolute()
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "ridecomfort"


def compose(entries: Sequence[Entry]) -> Kernel:
    """The kernel with these effects at its ports; those that are not compiled are left out.

    It is handed what ``parameters`` makes of their values.
    """
    return _compose(tuple(entry for entry in entries if entry.effect.port in COMPILED))


def in_company(chosen: Sequence[tuple[Entry, Mapping[str, float]]]) -> list[tuple[Entry, Mapping[str, float]]]:
    """The same and, where any of it is of the library, the rest of the library at neutral values, in the order in which they act.

    One kernel serves for all sets of the library's effects then: a neutral one costs half a percent of a drive, a kernel of
    its own fifteen seconds.
    """
    if not any(entry.is_of_library and entry.effect.port in COMPILED for entry, _ in chosen):
        return list(chosen)
    company = _neutral() | {entry.effect.name: (entry, values) for entry, values in chosen}
    return sorted(company.values(), key=lambda one: one[0].effect.rank)


@lru_cache
def _neutral() -> dict[str, tuple[Entry, Mapping[str, float]]]:
    """Every compiled effect of the library at its neutral values, by name."""
    return {name: (entry, entry.effect.neutral) for name, entry in of_the_library().items() if entry.effect.port in COMPILED}


def parameters(chosen: Sequence[tuple[Entry, Mapping[str, float]]]) -> np.ndarray:
    """What a kernel of these effects is handed: their values, each effect's in its own order, for each whether any of them
    is not neutral, and for each port whether any of its effects is. A neutral effect changes nothing, so that it need not be asked."""
    own = [(entry.effect, values) for entry, values in chosen if entry.effect.port in COMPILED]
    sizes = [values[parameter.name] for effect, values in own for parameter in effect.parameters]
    switches = [not effect.parameters or values != effect.neutral for effect, values in own]
    acting = {effect.port for (effect, _), switch in zip(own, switches) if switch}
    return np.array(sizes + switches + [port in acting for port in COMPILED], dtype=float)


def refusal(entries: Sequence[Entry], problem: Exception) -> InputError:
    """What to say to a user whose effect numba does not compile, in one line that names its file."""
    text = str(problem)
    named = [entry for entry in entries if f"_{entry.effect.name}.py" in text or f"= act_{entry.effect.name}(" in text]
    own = [entry for entry in entries if not entry.is_of_library]
    guilty = next((entry for entry in own if entry in named), next(iter(own or entries)))
    said = (line.strip() for line in text.splitlines() if line.strip() and not line.startswith("Failed in nopython mode"))
    returned = [*PORTS[guilty.effect.port].returns, *guilty.effect.also_returns, *(f"d{state}/dt" for state in guilty.effect.states)]
    return InputError(f"act cannot be compiled: {next(said, text)} (expected to return {', '.join(returned)})", file=guilty.path)


@lru_cache(maxsize=64)
def _compose(entries: tuple[Entry, ...]) -> Kernel:
    ports, states = ports_source([entry.effect for entry in entries])
    digest = hashlib.sha256(numba.__version__.encode() + sys.version.encode() + ports.encode())
    for path in [PACKAGE / name for name in SOURCES] + [entry.path for entry in entries]:
        digest.update(path.read_bytes())
    folder = cache_folder() / f"kernel_{digest.hexdigest()[:16]}"
    if not folder.is_dir():
        _write(folder, ports, entries)
    return Kernel(_load(folder).drive, states)


def _write(folder: Path, ports: str, entries: Sequence[Entry]) -> None:
    """All files of a kernel at once: a second job that comes at the same time finds all or nothing."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(dir=folder.parent))
    for entry in entries:
        shutil.copyfile(entry.path, part / f"{folder.name}_{entry.effect.name}.py")
    (part / f"{folder.name}_ports.py").write_text(ports.replace("{kernel}", folder.name), encoding="utf-8")
    kernel = (PACKAGE / "vehicle" / "kernel.py").read_text(encoding="utf-8")
    kernel = kernel.replace("from ridecomfort.effects.neutral import", f"from {folder.name}_ports import")
    (part / f"{folder.name}.py").write_text(kernel, encoding="utf-8")
    try:
        part.rename(folder)
    except OSError:
        shutil.rmtree(part)
        if not folder.is_dir():
            raise


def _load(folder: Path):
    """The kernel's module; its neighbours are imported by the names that it knows them by."""
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module(folder.name)
    finally:
        sys.path.remove(str(folder))


def ports_source(effects: Sequence[Effect]) -> tuple[str, int]:
    """Text of a module of ports that calls these effects, and their number of states.

    ``{kernel}`` in the text stands for the name of the folder that it will lie in.
    """
    lines = ['"""Ports of the vehicle with these effects connected: ' + (", ".join(e.name for e in effects) or "none")]
    lines += ['"""', "", "from numba import njit", ""]
    for effect in effects:
        lines.append(f"from {{kernel}}_{effect.name} import act as act_{effect.name}")
    lines += ["", 'PHYSICS = {"error_model": "numpy", "_nrt": False}', ""]
    lines += [f'act_{effect.name} = njit(forceinline=True, **PHYSICS)(act_{effect.name})' for effect in effects]
    first_parameter, first_state, places = 0, 0, []
    first_switch = sum(len(effect.parameters) for effect in effects)
    for number, effect in enumerate(effects):
        places.append((effect, first_parameter, first_state, first_switch + number))
        first_parameter += len(effect.parameters)
        first_state += len(effect.states) * (4 if PORTS[effect.port].per_wheel else 1)
    for number, name in enumerate(COMPILED, first_switch + len(effects)):
        lines += ["", ""] + _port_source(name, number, [place for place in places if place[0].port == name])
    return "\n".join(lines) + "\n", first_state


def _port_source(name: str, any_switch: int, places) -> list[str]:
    port = PORTS[name]
    given = [*port.sees, *(seen for seen in port.may_see if seen not in port.returns)]
    returned = (*port.returns, *port.may_return)
    lines = ['@njit(forceinline=True, **PHYSICS)', f"def {name}_port({', '.join((*given, 'parameters', 'states', 'slopes'))}):"]
    lines += [f"    {result} = 0.0" for result in returned if result not in given]
    if places:
        lines.append(f"    if parameters[{any_switch}] == 0.0:")
        lines.append(f"        return {', '.join(returned)}")
    for effect, parameter, state, switch in places:
        count = len(effect.states)
        offset = f"{state} + {count} * wheel" if port.per_wheel else f"{state}"
        arguments = [*port.sees, *effect.also_sees]
        arguments += [f"states[{offset} + {k}]" for k in range(count)]
        arguments += [f"parameters[{parameter + k}]" for k in range(len(effect.parameters))]
        results = [f"new_{result}" for result in (*port.returns, *effect.also_returns)]
        targets = ", ".join(results + [f"slopes[{offset} + {k}]" for k in range(count)])
        lines.append(f"    if parameters[{switch}] != 0.0:")
        lines.append(f"        {targets} = act_{effect.name}({', '.join(arguments)})")
        for result in (*port.returns, *effect.also_returns):
            lines.append(f"        {result} {'=' if result in given else '+='} new_{result}")
    lines.append(f"    return {', '.join(returned)}")
    return lines


