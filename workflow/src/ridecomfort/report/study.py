"""What a report is made from: the results of every site, and how the study was set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import xarray as xr

from ..study import JOIN
from .catalogue import label, of_the_paper


STANDIN = "Stand-in data: "
"""How every sentence begins that says so."""


@dataclass(frozen=True)
class Site:
    """One site's results; what the study does not have (a site without drives) is None.

    ``files`` names the file of each dataset, ``speed_limit_km_h`` and ``sampling`` are
    the site's settings, ``standin`` says that its road and drives are made up.
    """

    name: str
    road: xr.Dataset
    samples: xr.Dataset
    thresholds: xr.Dataset
    iso2631: xr.Dataset
    iri: xr.Dataset
    inspection: xr.Dataset | None = None
    comparison: xr.Dataset | None = None
    standin: bool = False
    title: str = ""
    calibrated_on: str | None = None
    speed_limit_km_h: float | None = None
    sampling: Mapping = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """How the site is called in print."""
        return label(self.name)


@dataclass(frozen=True)
class Compared:
    """A measured site: its aligned drives, and what the model did on them. ``files`` as for Site, ``standin_calibrations`` as for Study."""

    name: str
    measured: xr.Dataset
    comparison: xr.Dataset
    standin: bool = False
    files: Mapping[str, str] = field(default_factory=dict)
    standin_calibrations: Sequence[str] = ()

    @property
    def label(self) -> str:
        """How the site is called in print."""
        return label(self.name)

    def beside(self, model: str) -> str:
        """The site and the model that its drives are compared with, in print."""
        return f"{self.label}, model {model.replace(JOIN, f' {JOIN} ')}, {self.comparison.attrs['located_state']}"

    def standin_mark(self) -> str | None:
        """As of a Study."""
        return standin_mark(_labels([self], self.standin_calibrations))


@dataclass(frozen=True)
class Difference:
    """Where model and measurement differ, on every measured site, and the error ladder (``discrepancy.ladder``).

    The calibrations of the model by the site that they were made on, with their files; ``standin_calibrations`` as for Study.
    """

    sites: tuple[Compared, ...]
    ladder: xr.Dataset
    ladder_file: str = ""
    model: str = "base"
    calibrations: Mapping[str, xr.Dataset] = field(default_factory=dict)
    calibration_files: Mapping[str, str] = field(default_factory=dict)
    standin_calibrations: Sequence[str] = ()

    def site(self, name: str) -> Compared:
        """The measured site of that name."""
        return next(site for site in self.sites if site.name == name)

    def standin_note(self) -> str | None:
        """As of a Study."""
        return standin_note(_labels(self.sites, self.standin_calibrations))

    def standin_mark(self) -> str | None:
        """As of a Study."""
        return standin_mark(_labels(self.sites, self.standin_calibrations))


@dataclass(frozen=True)
class Diagnosis:
    """Which effects the model lacks: verdict.json and ranking.nc; ``standin`` labels the sites that are stand-ins, ``switched_on`` are the
    effects that the model has, in the order of the study's configuration, and ``held`` the sizes that it holds of them, by name.

    ``score`` is what the hidden truth of stand-ins says of the verdict (``steps.standin_score``), None without it. ``told_before``: what a
    verdict on a ``model`` without them said of effects that are switched on, by name. ``later``: verdicts on the model with what was named
    switched on, and so on, by model.
    """

    verdict: Mapping
    ranking: xr.Dataset
    files: Mapping[str, str] = field(default_factory=dict)
    model: str = "base"
    sites: tuple[str, ...] = ()
    standin: tuple[str, ...] = ()
    score: Mapping | None = None
    switched_on: tuple[str, ...] = ()
    held: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    told_before: Mapping[str, Mapping] = field(default_factory=dict)
    later: Mapping[str, Mapping] = field(default_factory=dict)

    def standin_note(self) -> str | None:
        """As of a Study."""
        return standin_note(list(self.standin))

    def standin_mark(self) -> str | None:
        """As of a Study."""
        return standin_mark(list(self.standin))

    def subject(self) -> str:
        """Which model was diagnosed, and on which sites, as a sentence."""
        return f"Diagnosed: the model {self.model} on {', '.join(label(site) for site in self.sites)}."

    def calibrated(self) -> str:
        """What of that model was calibrated, as a sentence; empty where nothing was."""
        names = self.ranking.attrs.get("calibrated", "")
        return f"Calibrated in it: {names}." if names else ""


@dataclass(frozen=True)
class Study:
    """The sites in order, the calibrations by the site that they were made on, and the settings.

    ``standin_calibrations`` are the names of the stand-in sites that a vehicle is calibrated on, whether or not they are among the sites.
    ``assessment`` is what the sites together say of the methods (``comfort.assessment.gather``).
    ``settings`` is the configuration that the report was made with (plain data), ``software``
    maps names of software to versions. ``difference`` and ``diagnosis`` are None where nothing was measured or diagnosed.
    """

    sites: tuple[Site, ...]
    calibrations: Mapping[str, xr.Dataset] = field(default_factory=dict)
    calibration_files: Mapping[str, str] = field(default_factory=dict)
    standin_calibrations: Sequence[str] = ()
    assessment: xr.Dataset | None = None
    assessment_file: str = ""
    model: str = "base"
    settings: Mapping = field(default_factory=dict)
    software: Mapping[str, str] = field(default_factory=dict)
    difference: Difference | None = None
    diagnosis: Diagnosis | None = None

    def site(self, name: str) -> Site | None:
        """The site of that name, None where the study has none."""
        return next((site for site in self.sites if site.name == name), None)

    @property
    def of_the_paper(self) -> bool:
        """Whether there is anything published to stand beside these sites."""
        return of_the_paper(site.name for site in self.sites)

    @property
    def compared(self) -> tuple[Site, ...]:
        """The sites with measured drives."""
        return tuple(site for site in self.sites if site.comparison is not None)

    @property
    def standin(self) -> tuple[Site, ...]:
        """The sites whose road and drives are stand-ins."""
        return tuple(site for site in self.sites if site.standin)

    def standin_note(self) -> str | None:
        """The sentence that goes wherever results of stand-in sites, or of vehicles calibrated on them, are shown; None without them."""
        return standin_note(_labels(self.sites, self.standin_calibrations))

    def standin_mark(self, sites: Iterable[str] | None = None) -> str | None:
        """The words that go into figures of stand-in sites (of those among ``sites``, of any), None without them."""
        return standin_mark(_labels(self.sites, self.standin_calibrations, sites))


def _labels(sites: Iterable[Site | Compared], calibrations: Iterable[str], shown: Iterable[str] | None = None) -> list[str]:
    """Labels of stand-ins, each once: those of the sites, then those that a vehicle is calibrated on; only of those ``shown`` where given."""
    names = dict.fromkeys([*(site.name for site in sites if site.standin), *calibrations])
    return [label(name) for name in dict.fromkeys(names if shown is None else shown) if name in names]


def foot_notes(sites: Iterable[Site | Compared]) -> list[str]:
    """What is said of sites on whose drives the driver's foot is heard (attribute ``driver`` of a comparison), a sentence each."""
    told = ((site.label, site.comparison.attrs.get("driver")) for site in sites)
    return [f"{label}: {said}: slower than that, a_x is no test of the model." for label, said in told if said]


def standin_note(labels: Sequence[str]) -> str | None:
    """The sentence that says of these sites that they are stand-ins, None without any."""
    if not labels:
        return None
    return (
        f"{STANDIN}the roads and measured drives of {', '.join(labels)} are made from seeds to match what the "
        "paper publishes of them; they are not the paper's own."
    )


def standin_mark(labels: Sequence[str]) -> str | None:
    """The words for a figure's corner that say of these sites that they are stand-ins, None without any."""
    return f"{STANDIN}{', '.join(labels)}" if labels else None
