"""The study: its sites, models and vehicles, and the files that it reads and makes."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePath

from . import modules
from .drive import readers
from .effects import library

VEHICLES = Path("config/vehicles")
DATA = Path("data")

BASE = library.BASE

JOIN = "+"
"""Between the names of effects in the name of a model."""

METHODS = ("thresholds", "iso2631", "iri")
"""The comfort methods."""

NO_CALIBRATION = "none"
"""What a site file's ``calibrated_on`` says to drive the nominal vehicle."""


@dataclass(frozen=True)
class Study:
    """The configuration of a study, complete and consistent.

    ``settings`` is config/study.yaml with its defaults, ``sites`` the configured sites
    and those that they are calibrated on, each with its defaults, ``standin`` the
    content of config/standin.yaml (empty without one). Paths are relative to ``folder``.
    """

    settings: Mapping
    sites: Mapping[str, Mapping]
    standin: Mapping = field(default_factory=dict)
    folder: Path = Path()

    @property
    def names(self) -> list[str]:
        """The configured sites, in their order."""
        return list(self.settings["sites"])

    @property
    def model(self) -> str:
        """Name of the configured model: ``base``, or its effects joined by ``+``."""
        return JOIN.join(self.effects()) or BASE

    @property
    def shards(self) -> list[str]:
        """Runs of each shard, first and last: ``0000-0249``, ``0250-0499``, ..."""
        runs, size = self.settings["runs"], self.settings["simulation"]["runs_per_shard"]
        width = max(4, len(str(runs - 1)))
        return [
            f"{first:0{width}}-{min(first + size, runs) - 1:0{width}}" for first in range(0, runs, size)
        ]

    def maps(self, site: str) -> list[str]:
        """Files of the maps of a site, one a method; those of a model with effects have a folder of its name."""
        folder = "results/maps" if self.model == BASE else f"results/maps/{self.model}"
        return [f"{folder}/{site}_{method}.geojson" for method in METHODS]

    def effects(self, model: str | None = None) -> dict[str, dict]:
        """The effects of a model by name, each with the values set for it; default is the configured model."""
        configured = self._configured()
        if model is None:
            return dict(sorted(configured.items()))
        return {name: configured.get(name, {}) for name in effects_of(model)}

    @property
    def switched_on(self) -> list[str]:
        """The effects of the configured model in the order in which they stand there: that of the error ladder."""
        return list(self._configured())

    def _configured(self) -> dict[str, dict]:
        configured = {}
        for entry in self.settings["effects"]:
            configured.update({entry: {}} if isinstance(entry, str) else entry)
        return configured

    def has_own_effects(self, model: str | None = None) -> bool:
        """Whether a model has effects that are not in the library."""
        return not set(self.effects(model)) <= set(effect_files())

    def effect_files(self, model: str) -> list[str]:
        """The files of a model's effects, and those of the package that they import."""
        known = effect_files(self.effects_folder)
        return self._with_imports(known[name] for name in self.effects(model) if name in known)

    def _with_imports(self, files: Iterable[Path]) -> list[str]:
        """Files, seen from the study's folder, with those of the package that they import."""
        return sorted(os.path.relpath(path, self.folder) for path in modules.with_imports(files))

    def vehicle(self, site: str) -> str:
        """File of the vehicle that drives on a site."""
        return str(VEHICLES / f"{self.sites[site].get('vehicle', self.settings['vehicle'])}.yaml")

    def calibrated_on(self, site: str) -> str | None:
        """Site on whose drives the vehicle of this site is calibrated, None for the nominal vehicle."""
        named = self.sites[site].get("calibrated_on")
        if named is None:
            return site if has_fit(self.sites[site]) else None
        return None if named == NO_CALIBRATION else named

    def is_fitted(self, site: str) -> bool:
        """Whether a vehicle is calibrated on the drives of a site: its own, or that of another site."""
        return self.calibrated_on(site) == site or site in self.calibrations

    def calibrated_elsewhere(self, site: str) -> str | None:
        """Another site on whose drives the vehicle of this site is calibrated, if any."""
        other = self.calibrated_on(site)
        return None if other == site else other

    def road(self, site: str) -> str:
        """File of a site's road; of a scanned one the file that the scan becomes."""
        return self.sites[site]["road"].get("file", f"results/{site}/road.crg")

    def scan(self, site: str) -> Mapping | None:
        """The scan that a site's road is made from, None where it has a file."""
        return self.sites[site]["road"].get("scan")

    def gridded(self, site: str) -> list[str]:
        """File of a scanned road before it was cleaned, none where the road has a file."""
        return [f"results/{site}/scan.nc"] if self.scan(site) else []

    def true_road(self, site: str) -> str:
        """File of a stand-in road as it is made; what is made of it by a scan, the study must find out."""
        return f"{DATA.as_posix()}/{site}/truth/road.crg" if self.scan(site) else self.road(site)

    def drives(self, site: str) -> list[str]:
        """Files of the drives measured on a site."""
        return [drive["file"] for drive in self.sites[site]["drives"]]

    def handed_in(self, site: str) -> list[str]:
        """Files of the drives that another simulator made for a site, one a run; none where the study's own drives."""
        named = self.sites[site].get("simulated")
        if named is None:
            return []
        folder = PurePath(named).as_posix()  # without a slash at its end
        suffixes = readers.suffixes()
        files = (path for path in (self.folder / folder).iterdir() if path.suffix.lower() in suffixes and not path.name.startswith("."))
        return [f"{folder}/{path.name}" for path in sorted(files, key=_in_order)]

    def aligned(self, site: str, model: str) -> str:
        """File of a site's measured drives as they are aligned for a model."""
        return f"results/{aligned_file(site, model, self.calibrated_on(site))}"

    @property
    def measured(self) -> list[str]:
        """The configured sites with measured drives."""
        return [site for site in self.names if self.sites[site]["drives"]]

    @property
    def calibrations(self) -> list[str]:
        """The sites on whose drives some configured site is calibrated."""
        found = (self.calibrated_on(site) for site in self.names)
        return list(dict.fromkeys(site for site in found if site))

    @property
    def diagnosed(self) -> list[str]:
        """The sites whose drives are searched for missing effects: those of the vehicle that is calibrated first.

        The site that it is calibrated on comes first; without any calibration, the first with drives to fit, and those of its vehicle.
        """
        first = self.calibrations[:1]
        if first:
            return [*first, *(site for site in self.measured if [self.calibrated_on(site)] == first and site not in first)]
        first = [site for site in self.measured if has_fit(self.sites[site])][:1]
        vehicle = [self.vehicle(site) for site in first]
        return [*first, *(site for site in self.measured if [self.vehicle(site)] == vehicle and site not in first)]

    def library_files(self) -> list[str]:
        """The file of every effect that may be missing, and those of the package that they import."""
        return self._with_imports(effect_files(self.effects_folder).values())

    def standin_files(self) -> list[str]:
        """Files of the effects that the stand-in drives may hide, and those of the package that they import."""
        known = effect_files()
        named = {name for entry in self.standin["measurement"]["effects"] for name in entry["among"]}
        return self._with_imports(known[name] for name in named if name in known)

    @property
    def made(self) -> list[str]:
        """The sites whose road and drives are made from seeds."""
        return [site for site in self.sites if self.sites[site]["standin"]]

    @property
    def forward(self) -> bool:
        """Whether the study goes on with the effects that its diagnosis names."""
        return bool(self.diagnosed) and self.settings["diagnosis"]["forward"]

    @property
    def scored(self) -> bool:
        """Whether the truth is known of all drives that are diagnosed, and the whole study scores the verdict against it."""
        return self.forward and all(self.sites[site]["standin"] for site in self.diagnosed)

    @property
    def effects_folder(self) -> Path | None:
        """Folder with effects of the user's own, None without one."""
        named = self.settings["effects_folder"]
        return None if named is None else self.folder / named


def aligned_file(site: str, model: str, calibrated_on: str | None) -> str:
    """File of a site's measured drives as they are aligned for a model, below the folder of results.

    A vehicle as its file has it, without effects, is what they are first aligned for.
    """
    return f"{site}/measured.nc" if model == BASE and calibrated_on is None else f"{site}/{model}/measured.nc"


def effects_of(model: str) -> list[str]:
    """The effects of a model, by its name."""
    return [] if model == BASE else model.split(JOIN)


def effect_files(folder: Path | None = None) -> dict[str, Path]:
    """The file of every effect there is, by name: those of the library and those of a user's folder."""
    folders = [library.FOLDER] if folder is None else [library.FOLDER, folder]
    files = [where / f"{name}.py" for where in folders for name, _ in library.files(where)]
    return {path.stem: path for path in sorted(files)}


def verdicts_on_less(results: Path, effects: Iterable[str]) -> list[Path]:
    """Files of the verdicts there are below ``results`` on models with fewer of these effects and no other, those on the fewest first."""
    files = [file for file in results.glob("diagnosis/*/verdict.json") if set(effects_of(file.parent.name)) < set(effects)]
    return sorted(files, key=lambda file: (len(effects_of(file.parent.name)), file))


def digest(*files) -> str:
    """Twelve hexadecimal digits that change when what any of these files holds does."""
    return hashlib.sha256(b"".join(hashlib.sha256(Path(file).read_bytes()).digest() for file in files)).hexdigest()[:12]


def has_fit(site: Mapping) -> bool:
    """Whether a site has drives that a vehicle can be calibrated on."""
    return any(drive["role"] == "fit" for drive in site["drives"])


def _in_order(path: PurePath) -> list:
    """What files are sorted by so that run10 comes behind run9."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name)]
