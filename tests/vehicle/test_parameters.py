"""Vehicles are files: each parameter with unit and source, and a wrong one refused by name."""

from __future__ import annotations

import numpy as np
import pytest
import yaml

from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters


@pytest.mark.parametrize("name", ["midsize", "van", "golden_car"])
def test_every_vehicle_of_the_study_is_complete_and_sourced(repository, name):
    vehicle = parameters.read(repository / "config" / "vehicles" / f"{name}.yaml")
    assert vehicle.values.keys() == parameters.PARAMETERS.keys()
    assert all(len(source) > 5 for source in vehicle.sources.values())


@pytest.fixture
def content(repository):
    return yaml.safe_load((repository / "config" / "vehicles" / "midsize.yaml").read_text())


def refused(tmp_path, content) -> str:
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as problem:
        parameters.read(path)
    message = str(problem.value)
    assert "mine.yaml" in message and "\n" not in message
    return message


def test_a_number_that_yaml_takes_for_text_is_refused_with_how_to_write_it(tmp_path, content):
    content["parameters"]["spring_stiffness_front"]["value"] = "2.8e4"
    assert "spring_stiffness_front: value: '2.8e4', expected a number; YAML reads this as text, write 28000" in refused(tmp_path, content)


def test_a_file_in_another_encoding_is_refused(tmp_path):
    (tmp_path / "mine.yaml").write_bytes("# Räder\nparameters: {}\n".encode("latin-1"))
    with pytest.raises(InputError, match="mine.yaml: is not a text file"):
        parameters.read(tmp_path / "mine.yaml")


def test_a_wrong_unit_is_refused(tmp_path, content):
    content["parameters"]["spring_stiffness_front"]["unit"] = "N/mm"
    message = refused(tmp_path, content)
    assert "spring_stiffness_front" in message and "'N/m'" in message


@pytest.mark.parametrize("value", [-1.0, 28.0, 2.8e7, "stiff", True, float("nan")])
def test_an_implausible_value_is_refused(tmp_path, content, value):
    content["parameters"]["spring_stiffness_front"]["value"] = value
    assert "spring_stiffness_front" in refused(tmp_path, content)


def test_an_unknown_parameter_is_refused(tmp_path, content):
    content["parameters"]["colour"] = {"value": 1, "unit": "1", "source": "paint"}
    assert "colour" in refused(tmp_path, content)


def test_a_misspelt_key_is_refused_with_the_one_that_it_is_like(tmp_path, content):
    """At the top, within a parameter, and the name of one."""
    entry = content["parameters"].pop("wheelbase")
    changes = [
        ({"titel": "mine"}, {"wheelbase": entry}, "mine.yaml: unknown key 'titel'; did you mean 'title'?"),
        ({}, {"wheelbase": {**entry, "vlaue": 2}}, "mine.yaml: parameters: wheelbase: unknown key 'vlaue'; did you mean 'value'?"),
        ({}, {"wheelbase": {"value": 2.7, "unit": "m"}}, "mine.yaml: parameters: wheelbase: key 'source' is missing"),
        ({}, {"weelbase": entry}, "mine.yaml: parameters: unknown parameter 'weelbase'; did you mean 'wheelbase'?"),
    ]
    for top, parameter, said in changes:
        assert said in refused(tmp_path, {**content, **top, "parameters": {**content["parameters"], **parameter}})


def test_a_unit_of_one_needs_no_quotes(tmp_path, content):
    content["parameters"]["tyre_friction"]["unit"] = 1
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(content))
    assert parameters.read(tmp_path / "mine.yaml")["tyre_friction"] == content["parameters"]["tyre_friction"]["value"]


def test_a_missing_parameter_is_refused(tmp_path, content):
    del content["parameters"]["wheelbase"]
    assert "wheelbase" in refused(tmp_path, content)


def test_a_centre_of_gravity_behind_the_rear_axle_is_refused(tmp_path, content):
    content["parameters"]["cg_to_front_axle"]["value"] = 3.0
    assert "cg_to_front_axle" in refused(tmp_path, content)


def test_replace_checks_like_reading(car):
    assert car.replace(sprung_mass=1500.0)["sprung_mass"] == 1500.0
    with pytest.raises(InputError, match="sprung_mass"):
        car.replace(sprung_mass=-1.0)
    with pytest.raises(InputError, match="weight"):
        car.replace(weight=1500.0)
    with pytest.raises(InputError, match=r"^cg_to_front_axle: 2.8 m lies behind the rear axle \(wheelbase 2.757 m\)"):
        car.replace(cg_to_front_axle=2.8)
    with pytest.raises(InputError, match=r"^cg_to_front_axle: 1.8 m lies behind the rear axle \(wheelbase 1.7 m\)"):
        car.replace(cg_to_front_axle=1.8, wheelbase=1.7)


@pytest.mark.parametrize("mass", [1500, np.int64(1500), np.float32(1500.0), np.float64(1500.0)])
def test_replace_takes_numbers_of_every_kind_and_makes_them_alike(car, mass):
    assert type(car.replace(sprung_mass=mass)["sprung_mass"]) is float and car.replace(sprung_mass=mass)["sprung_mass"] == 1500.0
    for wrong in (True, np.bool_(True), "1500", np.float32("nan")):
        with pytest.raises(InputError, match="sprung_mass"):
            car.replace(sprung_mass=wrong)
