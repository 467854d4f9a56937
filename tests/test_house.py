"""The rules of the house: imports point one way, and nothing on the way to a verdict sees the truth."""

from __future__ import annotations

import ast
import re
import tomllib
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import ridecomfort
from ridecomfort import discrepancy

PACKAGE = Path(ridecomfort.__file__).parent
REPOSITORY = Path(__file__).resolve().parent.parent

ORDER = [
    {"vocabulary", "errors", "csvtable", "store", "schema", "pool", "modules"},
    {"road", "vehicle", "effects", "drive"},
    {"simulate", "space", "sample", "calibrated"},
    {"standin"},
    {"problem", "descent", "identifiability", "fitrecord", "calibrate"},
    {"comfort", "discrepancy"},
    {"report", "study", "config", "stepsettings"},
    {"steps", "commands", "__main__"},
]
"""Rooms in the order in which data flows: a module imports from its own row and those above. The stand-in sees the
simulator and nothing of what is to find its secrets."""


def row(room: str) -> int:
    return next(k for k, rooms in enumerate(ORDER) if room in rooms)


SEALED = re.compile(r"(^|[/\\])(truth|truth[/\\].*|drives\.json|road\.json)$")
"""What names where the truth about stand-ins lies: its folder as a part of a path, or one of its files."""


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py") if path.name != "__init__.py")


def imports(path: Path) -> set[tuple[str, ...]]:
    """What a module imports from the package, as parts of dotted names."""
    own = path.relative_to(PACKAGE).parts
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [tuple(alias.name.split(".")) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = tuple(node.module.split(".")) if node.module else ()
            base = ("ridecomfort", *own[: -node.level]) + module if node.level else module
            names = [(*base, alias.name) for alias in node.names]
        found |= {name[1:] for name in names if name[0] == "ridecomfort" and len(name) > 1}
    return found


def strings(path: Path) -> list[str]:
    """What a module says in quotes, pieces of f-strings among it, but for docstrings."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    told = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    return [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told]


def room(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_point_one_way(path):
    for name in imports(path):
        if (PACKAGE / name[0]).exists() or (PACKAGE / f"{name[0]}.py").exists():
            assert row(name[0]) <= row(room(path)), f"imports {'.'.join(name)}"


def test_no_modules_import_one_another():
    """Raises CycleError, which names them, where some do; types that are only written down count as well."""
    known = {path.relative_to(PACKAGE).with_suffix("").parts: path for path in modules()}
    found = {own: {name[:k] for name in imports(path) for k in (1, 2, 3) if name[:k] in known} for own, path in known.items()}
    assert sum(len(theirs) for theirs in found.values()) > len(found)
    list(TopologicalSorter(found).static_order())


def test_the_face_of_the_largest_room_names_its_modules_each_before_those_that_rest_on_it():
    groups = (group.split(": ", 1)[1] for group in re.split(r"\n- ", discrepancy.__doc__)[1:])
    listed = [name for group in groups for name in re.findall(r"\w+", group)]
    known = {path.stem: path for path in modules() if room(path) == "discrepancy"}
    assert sorted(listed) == sorted(known)
    for name, path in known.items():
        theirs = {other[1] for other in imports(path) if other[0] == "discrepancy" and other[1] in known}
        assert not theirs & set(listed[listed.index(name) + 1 :]), f"{name} rests on what is named after it"


def test_only_its_own_steps_import_the_stand_in():
    users = {path.name for path in modules() if room(path) != "standin" and any(n[0] == "standin" for n in imports(path))}
    assert users and all(name.startswith("standin_") for name in users)


def test_no_module_is_longer_than_a_person_reads_at_once():
    long = {str(path.relative_to(PACKAGE)): count for path in modules() if (count := len(path.read_text().splitlines())) > 500}
    assert not long


def test_the_package_holds_modules_and_the_data_that_it_declares():
    declared = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    data = {path for room, patterns in declared.items() for pattern in patterns for path in PACKAGE.parent.joinpath(*room.split(".")).glob(pattern)}
    others = {path for path in PACKAGE.rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc", ".nbi", ".nbc")}
    assert others == data and data


def test_nothing_on_the_way_to_a_verdict_names_the_truth():
    for name in ("drive", "effects", "vehicle", "discrepancy"):
        for path in (PACKAGE / name).rglob("*.py"):
            assert "truth/" not in path.read_text() and "standin.yaml" not in path.read_text(), path


def test_nothing_but_what_makes_and_scores_stand_ins_names_where_the_truth_lies():
    """As an argument of a step, too: what a rule hands over has a name there."""
    users = {path for path in PACKAGE.rglob("*.py") if any(map(SEALED.search, strings(path)))}
    others = {path.relative_to(PACKAGE).as_posix() for path in users if room(path) != "standin" and not path.name.startswith("standin_")}
    assert len(users) > 3 and others == {"study.py"}, "study.py says where a road that is to be scanned is made"


def test_the_road_that_is_scanned_is_asked_for_by_the_rules_of_the_stand_ins_alone():
    files = [*PACKAGE.rglob("*.py"), REPOSITORY / "Snakefile", *(REPOSITORY / "workflow" / "rules").glob("*.smk")]
    assert [path.name for path in files if "true_road" in path.read_text(encoding="utf-8")] == ["study.py", "standin.smk"]
