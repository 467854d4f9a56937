"""Fixtures that every test may use."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

# Tests run side by side; threads of one that wait for cores slow all of them down, most in small matrices. NumPy asks once, as it is imported.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import pytest

from ridecomfort import modules
from tests.projects import EFFECT, write

REPOSITORY = Path(__file__).resolve().parent.parent

os.environ.setdefault("NUMBA_CACHE_DIR", str(REPOSITORY / ".cache" / "numba" / modules.compiled()))
os.environ.setdefault("RIDECOMFORT_CACHE", str(REPOSITORY / ".cache"))

FIRST = ("blind", "study")
"""Folders whose files are begun first. The first of them compiles the kernel of the library, which that of the second does without:
two workers that need it at once would both compile it."""


def pytest_collection_modifyitems(items):
    """The workflow's files first: a long one that is begun last would keep one worker busy and leave the other idle."""

    def place(item):
        is_long = any(item.get_closest_marker(name) for name in ("slow", "long"))
        folder = item.path.parent.name
        return not is_long, FIRST.index(folder) if folder in FIRST else len(FIRST)

    items.sort(key=place)


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the checkout."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared() -> Path:
    """Reference material that lies beside the checkout; tests skip where it is absent."""
    folder = REPOSITORY.parent / "shared"
    if not (folder / "references").is_dir():
        pytest.skip("the reference material ../shared is not beside this checkout")
    return folder


@pytest.fixture(scope="session")
def nominal(repository):
    """The mid-size car of the study, as quarter cars drive it."""
    from tests import quarter_cars  # not before Numba knows where its cache lies

    return quarter_cars.vehicle(repository)


@pytest.fixture
def project(repository, tmp_path):
    """A project folder with a copy of the configuration and a user's site without drives."""
    shutil.copytree(repository / "config", tmp_path / "config")
    (tmp_path / "road.crg").touch()
    write(tmp_path, "own", {"road": {"file": "road.crg"}})
    return tmp_path


@pytest.fixture
def own_effects(project):
    (project / "mine").mkdir()
    for name in ("pull", "headwind"):
        (project / "mine" / f"{name}.py").write_text(EFFECT.format(name=name))
    return {"sites": ["own"], "effects_folder": "mine"}
