"""The modules a step rests on: found as Python itself finds them, and no others."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from ridecomfort import discrepancy, modules

STEPS = sorted(
    path.stem
    for path in (modules.PACKAGE / "steps").glob("*.py")
    if "__main__" in path.read_text(encoding="utf-8")
)

LOADED = """
import importlib, sys
importlib.import_module("ridecomfort.steps." + sys.argv[1])
for name, module in sorted(sys.modules.items()):
    if name.split(".")[0] == "ridecomfort" and getattr(module, "__file__", None):
        print(module.__file__)
"""


RULES = """
import sys
from ridecomfort import config, stepsettings
from ridecomfort.drive import readers
from ridecomfort.report import catalogue
from ridecomfort.steps import models
readers.suffixes()
print(*{name.split(".")[0] for name in sys.modules})
"""


@pytest.fixture(scope="module")
def found():
    return {step: {Path(path).resolve() for path in modules.of_step(step)} for step in STEPS}


@pytest.mark.parametrize("step", ["sample", "space", "thresholds", "compare"])
def test_covers_what_python_loads(step, found):
    run = subprocess.run([sys.executable, "-c", LOADED, step], capture_output=True, text=True, check=True)
    loaded = {Path(line).resolve() for line in run.stdout.splitlines()}
    assert loaded <= found[step]


def test_rules_are_read_without_what_only_computing_needs():
    run = subprocess.run([sys.executable, "-c", RULES], capture_output=True, text=True, check=True)
    assert not {"numba", "pandas", "scipy", "xarray", "matplotlib"} & set(run.stdout.split())


def test_leaves_out_what_a_step_does_not_use(found):
    names = {path.relative_to(modules.PACKAGE).as_posix() for path in found["sample"]}
    assert "sample.py" in names and "steps/command.py" in names and "store.py" in names
    assert not any(name.startswith(("vehicle/", "comfort/", "report/", "standin/")) for name in names)


@pytest.mark.parametrize("step", ["compare", "critical", "ladder", "located", "tables"])
def test_what_compares_does_not_rest_on_the_search_for_effects(step, found):
    names = {path.relative_to(modules.PACKAGE).as_posix() for path in found[step]}
    assert any(name.startswith("discrepancy/") for name in names)
    assert not {f"discrepancy/{search}.py" for search in ("select", "judge", "naming", "discovery", "diagnosis")} & names


def test_the_functions_of_the_comparison_are_there_when_asked_for():
    assert all(getattr(discrepancy, name).__name__ == name for name in discrepancy.MODULES)
    with pytest.raises(AttributeError, match="no attribute 'guess'"):
        discrepancy.guess


def test_only_its_own_steps_use_the_stand_ins(found):
    users = {step for step, paths in found.items() if any("standin" in path.parts for path in paths)}
    assert users and all(step.startswith("standin_") for step in users)


def test_paths_do_not_depend_on_where_the_project_lies():
    assert not any(Path(path).is_absolute() for path in modules.of_step("sample"))


def test_imports_are_those_that_python_reads():
    for path in modules.PACKAGE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        read = [node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.Import, ast.ImportFrom))]
        assert sorted(map(ast.dump, modules.imports(text))) == sorted(map(ast.dump, read)), path


def test_words_of_a_docstring_are_no_import():
    assert not list(modules.imports('"""Drives\nfrom a road import more\nimport of heights\n"""\n'))


def test_every_import_form_is_followed(tmp_path, monkeypatch):
    package = tmp_path / "ridecomfort"
    texts = {
        "__init__.py": "",
        "errors.py": "",
        "one.py": "",
        "two.py": "def f():\n    from . import errors\n",
        "steps/__init__.py": "",
        "steps/try_it.py": "import numpy\nimport ridecomfort.one\nfrom ridecomfort.road import grid\nfrom ..two import f\n",
        "road/__init__.py": "",
        "road/grid.py": "",
        "road/other.py": "",
    }
    for name, text in texts.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    monkeypatch.setattr(modules, "PACKAGE", package)
    found = {Path(path).resolve().relative_to(package).as_posix() for path in modules.of_step("try_it")}
    assert found == set(texts) - {"road/other.py"}


def test_a_file_from_elsewhere_brings_what_it_imports_of_the_package_and_nothing_by_dots(tmp_path):
    own = tmp_path / "own.py"
    own.write_text("# A name in Latin-1: \xfc\nfrom . import errors\nfrom ridecomfort.effects.lag import lag\n", encoding="latin-1")
    found = modules.with_imports([own])
    assert {path.name for path in found} == {"own.py", "lag.py", "__init__.py", "lazy.py"}


def test_every_step_that_loads_effects_lists_their_files(repository):
    """An effect is loaded by its name, so that no import tells which files a step rests on."""
    inputs = {}
    for file in (repository / "workflow" / "rules").glob("*.smk"):
        for rule in file.read_text().split('code=modules.of_step("')[1:]:
            step, rest = rule.split('"', 1)
            inputs[step] = rest.split("output:")[0]
    listing = {step for step, files in inputs.items() if "effects=" in files}
    assert listing == {"calibrate", "realigned", "compare", "simulate", "diagnose", "standin_drives", "standin_score"}
