"""The models that a study puts side by side: base, then effect after effect, those of the study before those of verdicts."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..study import BASE, JOIN, Study, digest, effect_files, effects_of

FOLLOWED = ("named", "cluster")
"""Verdicts whose effects are added; of a cluster the first of each, called by all of its names."""

MOST = 3
"""Models that a study diagnoses by itself, one after another, at most."""


@dataclass(frozen=True)
class Chain:
    """Names of ``models``, each with one effect more than the one before it, and what the later rungs are called."""

    models: tuple[str, ...]
    titles: tuple[str, ...]

    def files(self, study: Study, name: str) -> list[str]:
        """The files of this name (``comparison.nc``) of every measured site, all models of one after those of another."""
        return [f"results/{site}/{model}/{name}" for site in study.measured for model in self.models]


def rung_titles(effects: Sequence[str], alike: Mapping[str, Sequence[str]] | None = None) -> list[str]:
    """What the rungs of effects are called, in the order in which they were added; ``alike`` cannot be told from them."""
    return ["+ " + " or ".join([name, *(alike or {}).get(name, ())]) for name in effects]


def chain(study: Study, *verdicts: Mapping) -> Chain:
    """The chain of a study, continued by the effects that verdicts name, that on its model first, then that on what the first one made of it.

    A verdict is the content of verdict.json. Effects that are in the model already, or that there is no file of, add nothing.
    """
    found = [effect for verdict in verdicts if verdict["verdict"] in FOLLOWED for effect in verdict["effects"]]
    known = effect_files(study.effects_folder)
    named = [effect["name"] for effect in found if effect["name"] in known]
    alike = {effect["name"]: effect.get("like", ()) for effect in found}
    effects = list(dict.fromkeys([*study.switched_on, *named]))
    models = [JOIN.join(sorted(effects[:count])) or BASE for count in range(len(effects) + 1)]
    return Chain(tuple(models), tuple(rung_titles(effects, alike)))


def known(study: Study) -> Chain:
    """The chain as far as it is known now: with the verdict on the study's model, and those on what comes of it, where they are there and to be
    followed."""
    return chain(study, *diagnosed(study).values()) if study.forward else chain(study)


def diagnosed(study: Study, ask: Callable[[str], object] = lambda model: None) -> dict[str, dict]:
    """The verdicts that a study goes forward by, as far as they are known now, each by the model that it is on: the study's own, then, each time, that
    with all that was named until then, as long as something more is; MOST at most.

    ``ask`` is called with each model before the verdict on it is looked for. One that was fitted on another site, to other drives or with another
    vehicle does not count, nor one that is older than that before it: it goes on from what was said there earlier.
    """
    found: dict[str, dict] = {}
    made = 0.0
    while len(found) < MOST and (model := chain(study, *found.values()).models[-1]) not in found:
        ask(model)
        verdict, first = _verdict(study, model), next(iter(found.values()), None)
        if verdict is None or first is not None and verdict.get("digests") != first.get("digests"):
            break
        before, made = made, Path(verdict_file(model)).stat().st_mtime
        if made < before:
            break
        found[model] = verdict
    return found


def later(study: Study) -> list[str]:
    """Files of the verdicts but the first that a study goes forward by, as far as they are known now."""
    return [verdict_file(model) for model in list(diagnosed(study))[1:]] if study.forward else []


def _verdict(study: Study, model: str) -> dict | None:
    """The verdict on a model, reached on the site and with the vehicle that would be diagnosed first; None without one."""
    file, first = Path(verdict_file(model)), study.diagnosed[:1]
    if not file.is_file():
        return None
    verdict = json.loads(file.read_text())
    vehicles = [digest(study.folder / study.vehicle(site)) for site in first]
    is_of_it = verdict.get("sites", ())[:1] == first and [verdict.get("vehicle_digest")] == vehicles
    return verdict if is_of_it else None


def below(study: Study, model: str) -> str | None:
    """The model from whose calibration that of ``model`` begins a search: the one before it in the chain, None for base.

    A model that is not in the chain begins from base.
    """
    if model == BASE:
        return None
    models = known(study).models
    return models[models.index(model) - 1] if model in models else BASE


def aligned_before(study: Study, site: str, model: str) -> str:
    """File of a site's measured drives from which their alignment for a model begins: as they are aligned for the model before it where
    a vehicle is fitted to them; else, and for base, as they were aligned first."""
    before = below(study, model) if study.is_fitted(site) else None
    return f"results/{site}/measured.nc" if before is None else study.aligned(site, before)


def verdict_file(model: str) -> str:
    """Where the verdict on a model lies, from the project folder."""
    return f"results/diagnosis/{model}/verdict.json"


def ladder_settings(study: Study, comparisons: Sequence[str]) -> str:
    """Configuration of the step ``ladder`` as JSON: models, titles, and whether each site's own drives were fitted.

    The models are those of the files ``comparisons`` (results/<site>/<model>/...): a verdict that came after they were asked for would
    speak of others.
    """
    models = list(dict.fromkeys(Path(file).parts[2] for file in comparisons))
    fitted = {site: study.calibrated_on(site) == site for site in study.measured}
    return json.dumps({"sites": fitted, "models": models, "titles": ladder_titles(study, models)})


def ladder_titles(study: Study, models: Sequence[str]) -> list[str]:
    """What the rungs of these models after base are called, with what verdicts cannot tell from their effects."""
    sets = [set(effects_of(model)) for model in models]
    effects = [name for before, after in zip(sets, sets[1:]) for name in sorted(after - before)]
    return rung_titles(effects, {effect["name"]: effect.get("like", ()) for found in diagnosed(study).values() for effect in found["effects"]})
