"""A verdict against the effects that are known to have been hidden."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..effects import library

FOUND, CLUSTERED, MISSED, WRONG, KNOWN = "named", "in the cluster", "missed", "named wrongly", "in the model"


def score(verdict: Mapping, hidden: Mapping[str, Mapping[str, float]], known: Sequence[str] = (), effects_folder=None) -> dict:
    """What a verdict (the content of verdict.json) says of every hidden effect ({name: {parameter: size}}, SI units).

    ``known`` are effects that the diagnosed model had already. Returns plain data: ``verdict`` and ``rows``, one for each size of
    every effect that was hidden or named (and for what shapes it otherwise than is typical): effect, hidden, found (in words),
    parameter, unit, true_size, size, interval, covered; None where there is no such thing.
    """
    named = {effect["name"]: effect for effect in verdict["effects"] if _is_told(verdict, effect)}
    alike = {other: name for name, effect in named.items() for other in effect["like"]}
    entries, rows = library.find(effects_folder), []
    for name in [*hidden, *(name for name in named if name not in hidden)]:
        found = KNOWN if name in known else FOUND if name in named else CLUSTERED if name in alike else MISSED
        stands_for = set(named.get(name, {}).get("like", ())) & set(hidden)
        found = found if name in hidden else CLUSTERED if stands_for else WRONG
        sizes = {size["parameter"]: size for size in named.get(name, {}).get("sizes", ())}
        parameters = entries[name].effect.parameters if name in entries else ()
        units = {parameter.name: parameter.unit for parameter in parameters}
        usual = {parameter.name: parameter.typical for parameter in parameters if parameter.neutral == parameter.typical}
        for parameter in dict.fromkeys([*hidden.get(name, {}), *sizes]):
            size, true = sizes.get(parameter), hidden.get(name, {}).get(parameter)
            if size is None and true == usual.get(parameter, float("nan")):
                continue
            interval = size["interval"] if size else None
            rows.append(
                {
                    "effect": name,
                    "hidden": name in hidden,
                    "found": found,
                    "parameter": parameter,
                    "unit": units.get(parameter, ""),
                    "true_size": true,
                    "size": size["size"] if size else None,
                    "interval": interval,
                    "covered": interval[0] <= true <= interval[1] if interval and true is not None else None,
                }
            )
    return {"verdict": verdict["verdict"], "rows": rows}


def _is_told(verdict: Mapping, effect: Mapping) -> bool:
    """Whether a verdict says of an effect that it is there: not of what the library alone comes up to where something else is missing, nor of
    effects of the vehicle where the data are suspect."""
    kind = verdict["verdict"]
    is_beside = kind == "outside" and bool(verdict.get("is_beside_form"))
    return kind in ("named", "cluster") or is_beside or kind == "suspect" and bool(effect.get("is_of_measurement"))
