"""A missing effect that is in no library: where it acts, what form it has, and an effect file that says so.

At every place where a force could act (strut, tyre, body) the force is written as a sum of
terms of what that place sees. Each term is simulated as an effect, so that the vehicle itself
carries it to the signals, and the terms are selected like effects of the library: over all
places at once, sparsely, decided by the drives held out (compare Brunton et al. 2016, PNAS
113:3932, for sparse regression on a library of terms).
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from .. import calibrated
from . import car as cars
from . import pool
from .experiment import Candidate, Size
from .places import FORCE, PLACES, STRONGEST, effect_source, in_words, parameter, scale
from .select import select
from .selection import Selection
from .verdict import plain, total_shares

@dataclass(frozen=True)
class Discovery:
    """A proposed effect: ``place``, its ``terms`` with factors by part of the car, ``form`` in words, shares removed, and
    the ``source`` of an effect file; all empty where nothing was found."""

    place: str
    terms: dict[str, dict[str, float]]
    form: str
    share: float
    held_out_share: float
    p_value: float
    source: str
    by_place: dict[str, float]
    """Fall of twice the negative log-likelihood with the best term of every place."""
    selection: Selection

    def json(self) -> dict:
        """What a verdict file says of it; null where a number is not known."""
        names = ("place", "form", "terms", "share", "held_out_share", "p_value", "by_place")
        return plain({name: getattr(self, name) for name in names})


def discover(
    measured: Mapping[str, tuple],
    vehicle,
    *,
    name: str = "discovered",
    calibration: xr.Dataset | None = None,
    effects: Mapping[str, Mapping[str, float]] | None = None,
    effects_folder=None,
    fitted_on: Sequence[str] | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    uncertain: Mapping[str, float] | None = None,
    most: int = 2,
    seed: int = 0,
    workers: int | None = None,
    options: Mapping | None = None,
    say: Callable[[str], None] = lambda words: None,
) -> Discovery:
    """Propose an effect that the library does not hold; arguments as for ``rank``, ``name`` is that of its file.

    ``most``: terms of its force. All terms of a proposal act at the place of the first.
    """
    vehicle, effects = calibrated.apply(calibration, vehicle, effects)
    count = pool.workers() if workers is None else workers
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(Path(effects_folder).glob("*.py")) if effects_folder else ():
            (Path(folder) / path.name).write_bytes(path.read_bytes())
        unknown = [(place, term) for place in PLACES for term in PLACES[place].terms]
        for place, term in unknown:
            text = effect_source(_name(place, term), place, {term: {}}, "A force that is looked for.")
            (Path(folder) / f"{_name(place, term)}.py").write_text(text, encoding="utf-8")
        experiment = cars.car(
            cars.sites_of(measured), vehicle, effects=effects, effects_folder=folder, fitted_on=fitted_on,
            bounds=bounds, uncertain=uncertain,
            library_names=[_name(place, term) for place, term in unknown], options=options,
            each_record=pool.side_by_side(count),
        )  # fmt: skip
        return _search(experiment, name, most, seed, pool.mapped(count), say)


def _search(experiment, name, most, seed, each, say) -> Discovery:
    start = cars.start_values(experiment)
    experiment.candidates = tuple(_terms(place) for place in PLACES)
    experiment.candidates = tuple(term for terms in experiment.candidates for term in terms)
    first = select(experiment, start, most=1, seed=seed, each=each, say=say)
    by_place = {
        place: max((g for n, g in zip(first.rounds[0].names, first.rounds[0].gain) if n.startswith(place)), default=0.0)
        for place in PLACES
    }
    if not first.accepted:
        return Discovery("", {}, "", float("nan"), float("nan"), 1.0, "", by_place, first)
    place = first.accepted[0].partition(":")[0]
    selection = first
    if most > 1:
        experiment.candidates = _terms(place)
        selection = select(experiment, start, most=most, seed=seed, each=each, say=say)
    values, terms = selection.final.values, {}
    for accepted in selection.accepted:
        term = accepted.partition(":")[2]
        terms[term] = {
            part: values[_key(place, term, part)] for part in PLACES[place].terms[term].parts if _key(place, term, part) in values
        }
    form = in_words(place, terms)
    share, held_out = total_shares(selection)
    winner = first.rounds[0].winner
    p_value = float(first.rounds[0].p_value[first.rounds[0].names.index(winner.name)])
    sentence = f"Found on measured drives, not in the library: at the {place}, {form}."
    return Discovery(
        place, terms, form, share, held_out, p_value, effect_source(name, place, terms, sentence), by_place, selection
    )


def _name(place: str, term: str) -> str:
    """Name of the effect that stands for one term of an unknown force."""
    return f"unknown_{place}_{term}"


def _key(place: str, term: str, part: str) -> str:
    return f"{_name(place, term)}.{parameter(term, part)}"


def _terms(place: str) -> tuple[Candidate, ...]:
    """Every term of a place as a candidate: a factor for each part of the car, of either sign."""
    candidates = []
    for name, term in PLACES[place].terms.items():
        one = scale(place, name)
        sizes = tuple(
            Size(_key(place, name, part), term.unit, 0.0, -STRONGEST / one, STRONGEST / one, FORCE / one)
            for part in term.parts
        )
        candidates.append(Candidate(f"{place}:{name}", sizes))
    return tuple(candidates)
