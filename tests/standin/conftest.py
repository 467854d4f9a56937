"""The stand-in sites as the study reads them, and a short one for quick tests."""

from __future__ import annotations

import copy

import pytest
import yaml

from ridecomfort.comfort import iri, iriclass
from ridecomfort.road import crg
from ridecomfort.standin import site


@pytest.fixture(scope="session")
def settings(repository) -> dict:
    """config/standin.yaml."""
    return yaml.safe_load((repository / "config" / "standin.yaml").read_text())


@pytest.fixture(scope="session")
def published(shared) -> dict:
    """What the paper publishes."""
    return yaml.safe_load((shared / "paper" / "published.yaml").read_text())


@pytest.fixture(scope="session")
def made(settings, tmp_path_factory) -> dict:
    """Each site: the road read back from its OpenCRG file, and the truth about it."""
    folder = tmp_path_factory.mktemp("standin")
    answer = {}
    for name in settings["sites"]:
        road, truth = site.make_road(name, settings, iri.iri, iriclass.Edges().at)
        crg.write(folder / f"{name}.crg", road)
        answer[name] = crg.read(folder / f"{name}.crg", interpolation="cubic"), truth
    return answer


@pytest.fixture(scope="session")
def short(settings) -> dict:
    """Settings with one site, half a kilometre of gentle road whose classes may be as they come."""
    few = copy.deepcopy(settings)
    ts2 = few["sites"]["ts2"]
    ts2["length"] = 500
    ts2["plan"] |= {"curves_per_km": 4, "turning_gon_per_km": 150}
    few["level"] |= {"draws": 500, "tolerance": 1.0}
    few["sites"] = {"ts2": ts2}
    return few


@pytest.fixture
def make(short):
    """A function that makes the short road from a seed."""
    return lambda seed: site.make_road("ts2", {**short, "seed": seed}, iri.iri, iriclass.Edges().at)
