"""A step as a command: options to arguments, a user's mistake to one line and status 1."""

from pathlib import Path

import pytest

from ridecomfort.errors import InputError
from ridecomfort.steps.command import Command, counted


def called_with(**options):
    got = {}
    Command(lambda **arguments: got.update(arguments), **options["how"]).run(options["line"])
    return got


def test_options_become_arguments():
    got = called_with(
        how={"inputs": ("road", "shards"), "many": ("shards",), "optional": ("calibration",), "texts": ("runs",)},
        line='--road r.nc --shards a.nc b.nc --runs 0-9 --config {"rate":100} --output o.nc'.split(),
    )
    assert got == {
        "road": Path("r.nc"),
        "shards": [Path("a.nc"), Path("b.nc")],
        "calibration": None,
        "runs": "0-9",
        "config": {"rate": 100},
        "output": Path("o.nc"),
    }


def test_an_optional_file_may_be_empty():
    how = {"optional": ("calibration",)}
    assert called_with(how=how, line=["--calibration", "--output", "o"])["calibration"] is None
    assert called_with(how=how, line=["--calibration", "c", "--output", "o"])["calibration"] == Path("c")
    several = {"optional": ("later",), "many": ("later",)}
    for line, expected in (([], []), (["--later"], []), (["--later", "a", "b"], [Path("a"), Path("b")])):
        assert called_with(how=several, line=[*line, "--output", "o"])["later"] == expected


def test_a_mistake_is_one_line(capsys):
    def main(**_):
        raise InputError("3e38 m, expected heights below 9000 m", file="road.crg", place="line 7")

    with pytest.raises(SystemExit) as end:
        Command(main).run(["--output", "o.nc"])
    assert end.value.code == "error: road.crg: line 7: 3e38 m, expected heights below 9000 m"


def test_a_long_step_says_how_often_it_called(capsys):
    simulated = counted(lambda speed, *, step: speed * step, "drives simulated", every=2)
    assert [simulated(speed, step=2) for speed in (1, 2, 3)] == [2, 4, 6]
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("2 drives simulated in ")


def test_a_fault_of_the_program_is_not_hidden():
    def main(**_):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Command(main).run(["--output", "o.nc"])
