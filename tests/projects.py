"""Project folders made up for tests: a copy of the configuration, sites and drives of a user, and what a mistake in them is answered with."""

import pytest
import yaml

from ridecomfort import config, schema
from ridecomfort.errors import InputError

SENSOR = {"behind_front_axle": 1.4, "above_wheel_centres": 0.2}
DRIVE = {"file": "drive.csv", "sensor": SENSOR}
HEADER = "time,v_x,a_x,a_y,a_z,roll_rate,pitch_rate,yaw_rate\n"

EFFECT = """
from ridecomfort.effects.contract import Effect, Parameter

effect = Effect(
    "{name}", "A test.", "none", "drive", (Parameter("size", "N", 0.0, 1.0, (0.0, 10.0), "how much"),)
)


def act(force, speed, size):
    return force + size
"""


def write(project, site, content):
    (project / config.SITES / f"{site}.yaml").write_text(yaml.safe_dump(content))


def read(project):
    return schema.read_yaml(project / config.STUDY)


def columns(*left_out, **named):
    """Columns of a drive in SI units, headed by the names of their quantities or as ``named``."""
    units = {"time": "s", "v_x": "m/s", **dict.fromkeys(("a_x", "a_y", "a_z"), "m/s2")}
    return {
        name: {"column": named.get(name, name), "unit": units.get(name, "rad/s")}
        for name in HEADER.strip().split(",") if name not in left_out
    }  # fmt: skip


def assert_said(project, settings, said, file):
    with pytest.raises(InputError) as problem:
        config.load(settings, project)
    text = str(problem.value)
    assert said in text and text.startswith(f"{file}: ") and "\n" not in text, text
