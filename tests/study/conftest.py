"""The workflow run as a user runs it, on a short road of its own, in a folder of its own."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from ridecomfort.road import crg
from tests.study import called

LENGTH, SPACING = 250.0, 0.1


@dataclass(frozen=True)
class Answer:
    """What a call of Snakemake said, and its exit status."""

    status: int
    text: str

    @property
    def jobs(self) -> list[str]:
        """The jobs of a dry run, ``rule site ...``, without the reasons behind them."""
        planned = [line.split(": ")[0] for line in self.text.splitlines() if ": " in line]
        return [job for job in planned if job.split(" ")[0] in RULES]

    @property
    def errors(self) -> list[str]:
        return [line.split("error: ", 1)[1] for line in self.text.splitlines() if "error: " in line]


RULES = (
    "road measured realigned calibrate sample simulate space thresholds iso2631 iri agreement maps comparison critical ladder located compared "
    "diagnosis diagnosed standin_score tables figures report"
).split()


@dataclass(frozen=True)
class Project:
    """A project folder with the repository's workflow and a configuration of its own."""

    folder: Path
    repository: Path

    def snakemake(self, *arguments: str) -> Answer:
        """``python -m snakemake`` with these arguments in the project's folder."""
        words = ["--snakefile", str(self.repository / "Snakefile"), "--directory", str(self.folder), *arguments]
        return Answer(*called.snakemake(words))

    def site(self, name: str, **content) -> None:
        """Write a site's file; without a road of its own it lies on the test road."""
        content = {"road": {"file": "road.crg"}, "speed": {"limit_km_h": 60}, **content}
        file = self.folder / "config" / "sites" / f"{name}.yaml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(yaml.safe_dump(content))

    def study(self, **content) -> None:
        (self.folder / "config" / "study.yaml").write_text(yaml.safe_dump(content))

    def copied(self, folder: Path) -> Project:
        """The same project in another folder, to be changed there."""
        shutil.copytree(self.folder, folder, dirs_exist_ok=True)
        return Project(folder, self.repository)

    def files(self) -> set[str]:
        """Every result, hidden and half-written ones included, but for logs."""
        paths = (path.relative_to(self.folder) for path in (self.folder / "results").rglob("*") if path.is_file())
        return {str(path) for path in paths if path.parts[1] not in ("logs", "benchmarks")}


def test_road() -> xr.Dataset:
    """A straight road with waves of several lengths, different under the left and the right wheels."""
    u = SPACING * np.arange(round(LENGTH / SPACING) + 1)
    v = 0.1 * np.arange(-20, 21)
    rng = np.random.default_rng(7)
    lengths, phases = np.geomspace(1.0, 30.0, 12), rng.uniform(0, 2 * np.pi, (2, 12))
    left, right = (
        (2e-4 * lengths * np.sin(2 * np.pi * u[:, None] / lengths + phase)).sum(axis=1) for phase in phases
    )
    share = (v + 2.0) / 4.0
    flat = {name: ("u", np.zeros_like(u)) for name in ("y", "heading", "curvature", "slope", "bank")}
    elevation = left[:, None] * share + right[:, None] * (1 - share)
    return xr.Dataset({"elevation": (("u", "v"), elevation), "x": ("u", u), **flat}, coords={"u": u, "v": v})


test_road.__test__ = False


def new_project(folder: Path, repository: Path) -> Project:
    project = Project(folder, repository)
    project.site("one")
    project.site("two")
    project.study(sites=["one", "two"], runs=6, simulation={"runs_per_shard": 4})
    shutil.copytree(repository / "config" / "vehicles", folder / "config" / "vehicles")
    crg.write(folder / "road.crg", test_road(), comment="a road for a test")
    return project


@pytest.fixture
def project(tmp_path, repository) -> Project:
    """A project in which nothing has run yet."""
    return new_project(tmp_path, repository)


@pytest.fixture(scope="package")
def finished(tmp_path_factory, repository) -> Project:
    """A project in which both sites have run. Tests only look at it, or make it whole again."""
    project = new_project(tmp_path_factory.mktemp("study"), repository)
    answer = project.snakemake("-j2", "one", "two")
    assert answer.status == 0, answer.text
    return project
