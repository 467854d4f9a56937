"""The effects there are: those of this folder and those of a user's own."""

from __future__ import annotations

import importlib.util
import inspect
import keyword
import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from numbers import Real
from pathlib import Path
from types import MappingProxyType

from ..errors import InputError, hint
from .contract import PORTS, Effect, Parameter

FOLDER = Path(__file__).parent
HOUSE = {"__init__", "compose", "contract", "in_python", "lag", "library", "neutral", "swing", "table", "wave"}
"""Files of this folder that are not effects."""

BASE = "base"
"""Name of the model without effects, which no effect may have."""


@dataclass(frozen=True, eq=False)  # each is loaded once, and to compare all that they hold takes a millisecond of each drive
class Entry:
    """An effect with the file it comes from and its function."""

    effect: Effect
    act: Callable
    path: Path

    @cached_property
    def is_of_library(self) -> bool:
        """Whether it is one of this folder, not of a user's."""
        return self.path.parent == FOLDER


class Unchanging(os.PathLike):
    """A ``folder`` of effects whose files nobody changes as long as it is used: they are read once, not looked after before every drive."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.entries = MappingProxyType(find(folder))

    def __fspath__(self) -> str:
        return str(self.folder)


def find(folder=None) -> Mapping[str, Entry]:
    """Every effect by name: the library's own and, with ``folder``, those of a user's folder.

    Raises InputError for a file that is not an effect, for a name that does not match its
    file and for a user's effect that takes the name of one of the library.
    """
    if isinstance(folder, Unchanging):
        return folder.entries
    entries = dict(of_the_library())
    if folder is not None:
        folder = Path(folder)
        if not folder.is_dir():
            raise InputError("no such folder", file=folder, place="effects_folder")
        own = _entries(folder, files(folder))
        for name in own.keys() & entries.keys():
            raise InputError(f"effect {name!r} is already in the library", file=own[name].path)
        entries.update(own)
    return entries


def choose(effects: str | Iterable[str] | Mapping[str, Mapping[str, float]] | None, folder=None):
    """The named effects with the sizes to use: list of (Entry, {parameter: value}), in the order in which they act.

    ``effects``: a name or names (typical sizes), a mapping of name to sizes, a list of names and such mappings, as in the study's
    configuration, or None for no effects. Raises InputError for a
    name or a parameter that does not exist, saying which there are.
    """
    listed = [effects] if isinstance(effects, (str, Mapping)) else effects or ()
    sizes = {name: own for one in listed for name, own in (one.items() if isinstance(one, Mapping) else [(one, None)])}
    if not sizes:
        return []
    entries = find(folder)
    chosen = []
    for name in sorted(sizes):
        if name not in entries:
            otherwise = "known are" if folder else "effects_folder names no folder with others; known are"
            raise InputError(f"unknown effect {name!r}; {hint(name, sorted(entries), otherwise)}")
        effect = entries[name].effect
        for parameter in sizes[name] or {}:
            if parameter not in effect.neutral:
                raise InputError(f"effect {name!r} has no parameter {parameter!r}; {hint(parameter, list(effect.neutral), 'it has')}")
        chosen.append((entries[name], effect.values(sizes[name])))
    return sorted(chosen, key=lambda one: one[0].effect.rank)


def check_plausible(chosen) -> None:
    """Raise InputError for the first value of the effects from ``choose`` that lies outside of what is plausible."""
    for entry, values in chosen:
        for parameter in entry.effect.parameters:
            low, high = parameter.plausible
            if not low <= values[parameter.name] <= high:
                raise InputError(
                    f"{entry.effect.name}: {parameter.name}: {values[parameter.name]:g} {parameter.unit}, "
                    f"expected {low:g} to {high:g} {parameter.unit} ({parameter.meaning})"
                )


@lru_cache
def of_the_library() -> Mapping[str, Entry]:
    """The library's own effects by name, read once like any module of the package: looking for its files takes a twentieth of a drive."""
    return _entries(FOLDER, files(FOLDER))


def files(folder: Path) -> tuple[tuple[str, int], ...]:
    """Names of the effects that lie in a folder, in their order, and when each file was changed.

    What begins with ``_`` or ``.``, as what editors leave behind does, is no effect. Raises InputError for a link to nothing.
    """
    with os.scandir(folder) as listed:
        found = [(file.name[:-3], file) for file in listed if file.name.endswith(".py") and not file.name.startswith(("_", "."))]
    return tuple(sorted((name, _changed(file)) for name, file in found if folder != FOLDER or name not in HOUSE))


def _changed(file: os.DirEntry) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError as problem:
        raise InputError(f"cannot be read ({problem.strerror})", file=file.path) from None


@lru_cache(maxsize=64)  # asked for before every simulated drive
def _entries(folder: Path, files: tuple[tuple[str, int], ...]) -> Mapping[str, Entry]:
    return MappingProxyType({name: _load(folder / f"{name}.py", changed) for name, changed in files})


@lru_cache(maxsize=512)
def _load(path: Path, changed: int) -> Entry:
    """The effect of a file; read again only once it has ``changed``."""
    if not (path.stem.isidentifier() and path.stem.isascii()):  # the name of a model, of its files and of the kernel's modules
        raise InputError(f"{path.stem!r} is no name of an effect (expected letters without accents, digits and _, no digit first)", file=path)
    if path.stem == BASE or keyword.iskeyword(path.stem):
        taken = "the model without effects has that name" if path.stem == BASE else "Python has a meaning for it"
        raise InputError(f"{path.stem!r} is no name of an effect ({taken})", file=path)
    spec = importlib.util.spec_from_file_location(f"ridecomfort_effect_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as problem:
        raise InputError(f"cannot be loaded: {type(problem).__name__}: {problem}", file=path) from None
    effect, act = getattr(module, "effect", None), getattr(module, "act", None)
    if not isinstance(effect, Effect) or not callable(act):
        raise InputError("expected `effect = Effect(...)` and a function `act`", file=path)
    for what in ("name", "sentence", "source", "port"):
        if not isinstance(getattr(effect, what), str):
            raise InputError(f"{getattr(effect, what)!r:.60}, expected text", file=path, place=what)
    if not isinstance(effect.order, int) or isinstance(effect.order, bool):
        raise InputError(f"{effect.order!r:.60}, expected a whole number", file=path, place="order")
    if effect.name != path.stem:
        raise InputError(f"holds effect {effect.name!r}, expected the name of the file", file=path)
    if effect.port not in PORTS:
        raise InputError(f"unknown port {effect.port!r}; known are {', '.join(PORTS)}", file=path)
    for what, known in (("also_sees", PORTS[effect.port].may_see), ("also_returns", PORTS[effect.port].may_return)):
        found = getattr(effect, what)
        if not (isinstance(found, tuple) and all(one in known for one in found)):
            raise InputError(f"{found!r:.60}, expected a tuple of names among {known}, what port {effect.port} has", file=path, place=what)
    if not (isinstance(effect.also_probed, tuple) and all(_is_number(share) and share > 0 for share in effect.also_probed)):
        raise InputError(f"{effect.also_probed!r:.60}, expected a tuple of positive numbers", file=path, place="also_probed")
    _check_parameters(effect, path)
    _check_arguments(effect, act, path)
    return Entry(effect, act, path)


def _check_parameters(effect: Effect, path: Path) -> None:
    """Raise InputError unless the parameters of an effect are Parameters with a name, two values and a range, which holds the typical
    one, each, and its states names."""
    for what, kind in (("parameters", Parameter), ("states", str)):
        found = getattr(effect, what)
        if not isinstance(found, tuple) or not all(isinstance(one, kind) for one in found):
            raise InputError(f"{what} are {found!r:.60} (expected a tuple of {kind.__name__}: one alone needs a comma behind it)", file=path)
    for parameter in effect.parameters:
        if not (isinstance(parameter.name, str) and parameter.name.isidentifier()):
            raise InputError(f"{parameter.name!r:.60} is no name of a parameter (expected letters, digits and _, no digit first)", file=path, place="parameters")
        for what in ("neutral", "typical"):
            if not _is_number(getattr(parameter, what)):
                raise InputError(f"{what} is {getattr(parameter, what)!r:.60} (expected a finite number)", file=path, place=parameter.name)
        try:
            low, high = parameter.plausible
        except (TypeError, ValueError):
            low, high = None, None
        if not (_is_number(low) and _is_number(high) and low < high):
            raise InputError(f"plausible is {parameter.plausible!r} (expected two numbers, the lower one first)", file=path, place=parameter.name)
        if not low <= parameter.typical <= high:
            expected = f"expected a value that is plausible, {low:g} to {high:g}"
            raise InputError(f"typical is {parameter.typical:g} ({expected})", file=path, place=parameter.name)


def _is_number(value) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _check_arguments(effect: Effect, act: Callable, path: Path) -> None:
    """Raise InputError where ``act`` does not take what its port sees, its states and its parameters, in this order, by which a kernel is
    handed them."""
    expected = [*PORTS[effect.port].sees, *effect.also_sees, *effect.states, *(parameter.name for parameter in effect.parameters)]
    taken = list(inspect.signature(act).parameters)
    if len(taken) != len(expected) or any(name != own and name in expected for name, own in zip(taken, expected)):
        raise InputError(f"act takes ({', '.join(taken)}), expected ({', '.join(expected)})", file=path)
