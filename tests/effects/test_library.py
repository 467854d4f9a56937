"""Finding effects, choosing them and printing them."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ridecomfort import simulate
from ridecomfort.__main__ import main
from ridecomfort.effects import library, table
from ridecomfort.errors import InputError

from tests.vehicle.roads import road

EFFECT = (
    "from ridecomfort.effects.contract import Effect, Parameter\n"
    "effect = Effect('{name}', 'A sentence.', 'a source', '{port}',\n"
    "    (Parameter('share', '1', 0.0, 0.5, (0.0, 1.0), 'a share'),))\n"
    "def act(vehicle, share):\n    return vehicle\n"
)


def put(folder, file, name=None, port="vehicle"):
    (folder / f"{file}.py").write_text(EFFECT.format(name=name or file, port=port))


def test_finds_those_of_a_folder_besides_its_own(tmp_path):
    put(tmp_path, "mine")
    found = library.find(tmp_path)
    assert set(found) == set(library.find()) | {"mine"}
    assert found["mine"].path == tmp_path / "mine.py"


def test_a_changed_file_is_read_again(tmp_path):
    put(tmp_path, "mine")
    assert library.find(tmp_path)["mine"].effect.port == "vehicle"
    put(tmp_path, "mine", port="sensor")
    assert library.find(tmp_path)["mine"].effect.port == "sensor"


def test_a_folder_that_nobody_changes_is_read_once(tmp_path):
    put(tmp_path, "mine")
    folder = library.Unchanging(tmp_path)
    put(tmp_path, "mine", port="sensor")
    put(tmp_path, "yours")
    assert set(library.find(folder)) == set(library.find()) | {"mine"} and library.find(folder)["mine"].effect.port == "vehicle"
    assert Path(folder) == tmp_path


def test_what_editors_leave_behind_is_no_effect_and_a_link_to_nothing_is_named(tmp_path):
    put(tmp_path, "mine")
    (tmp_path / ".#mine.py").symlink_to("somebody@somewhere.1234")
    (tmp_path / "._mine.py").write_bytes(b"\x00\x05\x16\x07")
    assert set(library.find(tmp_path)) == set(library.find()) | {"mine"}
    (tmp_path / "other.py").symlink_to("nothing.py")
    with pytest.raises(InputError) as refused:
        library.find(tmp_path)
    assert str(refused.value) == f"{tmp_path / 'other.py'}: cannot be read (No such file or directory)"


@pytest.mark.parametrize(("file", "change", "problem"), [
    ("mine", {"name": "other"}, "'other'"),
    ("mine", {"port": "engine"}, "'engine'"),
    ("payload", {}, "already in the library"),
])  # fmt: skip
def test_refuses_what_is_not_an_effect_of_its_own(tmp_path, file, change, problem):
    put(tmp_path, file, **change)
    with pytest.raises(InputError, match=problem) as raised:
        library.find(tmp_path)
    assert f"{file}.py" in str(raised.value)


def test_refuses_a_function_that_does_not_take_what_its_port_sees(tmp_path):
    put(tmp_path, "mine", port="suspension")
    with pytest.raises(InputError, match=r"mine.py: act takes \(vehicle, share\), expected \(wheel, deflection, .*, share\)"):
        library.find(tmp_path)


def test_refuses_parameters_in_another_order_than_their_values_are_handed_over_in(tmp_path):
    source = (library.FOLDER / "suspension_friction.py").read_text(encoding="utf-8").replace('"suspension_friction"', '"mine"')
    (tmp_path / "mine.py").write_text(source.replace("front, rear, presliding):", "rear, front, presliding):"), encoding="utf-8")
    with pytest.raises(InputError, match=r"mine.py: act takes \(.*rear, front, presliding\), expected \(.*front, rear, presliding\)"):
        library.find(tmp_path)


@pytest.mark.parametrize("name", ["my-effect", "dämpfer", "2nd_damper"])
def test_refuses_a_name_that_is_none_of_a_model_or_in_python(tmp_path, name):
    put(tmp_path, name)
    with pytest.raises(InputError) as refused:
        library.find(tmp_path)
    said = f"{name!r} is no name of an effect (expected letters without accents, digits and _, no digit first)"
    assert str(refused.value) == f"{tmp_path / name}.py: {said}"


@pytest.mark.parametrize(("returned", "said"), [
    ("share * stifness", "NameError: name 'stifness' is not defined"),
    ("share, 0.0, 0.0", "expected to return force"),
])  # fmt: skip
def test_a_function_that_numba_does_not_compile_is_one_line(tmp_path, car, returned, said):
    text = EFFECT.format(name="mine", port="suspension").replace("vehicle, share", "wheel, deflection, velocity, stiffness, damping, force_x, force_y, share")
    (tmp_path / "mine.py").write_text(text.replace("return vehicle", f"return {returned}"))
    with pytest.raises(InputError) as raised:
        simulate.run(road(60.0), car, speed=10.0, effects=["mine"], effects_folder=tmp_path)
    assert "mine.py: act cannot be compiled: " in str(raised.value) and said in str(raised.value) and "\n" not in str(raised.value)


def test_refuses_what_its_port_does_not_have(tmp_path):
    text = EFFECT.format(name="mine", port="suspension").replace("vehicle, share", "wheel, share")
    for what, known in (("also_sees", "surge"), ("also_returns", "shake")):
        (tmp_path / "mine.py").write_text(text + f"\neffect = effect.__class__('mine', 'A.', 'a', 'suspension', (), {what}=('{known}',))\n")
        with pytest.raises(InputError, match=rf"mine.py: {what}: \('{known}',\), expected a tuple of names among \('damper',\)"):
            library.find(tmp_path)
        (tmp_path / "mine.py").unlink()


@pytest.mark.parametrize("shares", ["2.0", "(1.0, 0.0)", "(1.0, 'twice')"])
def test_refuses_sizes_to_be_looked_for_with_that_are_none(tmp_path, shares):
    text = EFFECT.format(name="mine", port="suspension").replace("vehicle, share", "wheel, share")
    (tmp_path / "mine.py").write_text(text + f"\neffect = effect.__class__('mine', 'A.', 'a', 'suspension', (), also_probed={shares})\n")
    with pytest.raises(InputError, match=r"mine.py: also_probed: .*, expected a tuple of positive numbers"):
        library.find(tmp_path)


@pytest.mark.parametrize("text", ["effect = 1\n", "import nothing_of_that_name\n", "def act(:\n"])
def test_refuses_files_that_hold_no_effect(tmp_path, text):
    (tmp_path / "mine.py").write_text(text)
    with pytest.raises(InputError, match="mine.py"):
        library.find(tmp_path)


def test_refuses_unknown_names_and_sizes():
    with pytest.raises(InputError, match="'nosuch'"):
        library.choose(["nosuch"])
    with pytest.raises(InputError, match="'weight'"):
        library.choose({"payload": {"weight": 1.0}})


def test_one_name_is_one_effect_and_nothing_is_none():
    assert [entry.effect.name for entry, _ in library.choose("payload")] == ["payload"]
    assert library.choose(None) == []


def test_names_and_sizes_may_be_listed_as_in_a_configuration():
    listed = library.choose(["top_mount", {"payload": {"mass": 80.0}}, {"crosswind": None}])
    assert listed == library.choose({"top_mount": None, "payload": {"mass": 80.0}, "crosswind": None})


def test_sizes_that_are_not_given_are_typical():
    ((_, sizes),) = library.choose({"payload": {"mass": 80.0}})
    assert sizes == {"mass": 80.0, "ahead": -0.8, "height": 0.6, "radius": 0.3}


def test_command_prints_every_effect_with_unit_port_and_source(capsys, tmp_path):
    put(tmp_path, "mine")
    main(["effects", "--folder", str(tmp_path)])
    printed = " ".join(capsys.readouterr().out.split())
    for entry in library.find(tmp_path).values():
        effect = entry.effect
        for part in (effect.name, effect.sentence, effect.source, f"Port {effect.port}", effect.parameters[0].meaning):
            assert part in printed
        assert f"[{effect.parameters[0].unit}]" in printed


def test_command_prints_a_table(capsys):
    main(["effects", "--csv"])
    printed = pd.read_csv(io.StringIO(capsys.readouterr().out))
    assert tuple(printed.columns) == table.COLUMNS
    assert len(printed) == sum(len(entry.effect.parameters) for entry in library.find().values())


def test_command_prints_those_that_are_asked_for(capsys):
    main(["effects", "payload"])
    assert "bump_stop" not in capsys.readouterr().out


COMPILED = (
    "from ridecomfort.effects.contract import Effect, Parameter\n"
    "effect = Effect('{name}', 'A sentence.', 'a source', 'suspension', {parameters})\n"
    "def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y{taken}):\n    return 0.5 * damping * velocity\n"
)
SHARE = "Parameter('share', '1', 0.0, 0.5, (0.0, 1.0), 'a share')"


@pytest.mark.parametrize("name", ["base", "lambda"])
def test_a_name_that_means_something_else_is_no_name_of_an_effect(tmp_path, name):
    put(tmp_path, name)
    with pytest.raises(InputError, match=rf"{name}.py: '{name}' is no name of an effect"):
        library.find(tmp_path)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        (f"({SHARE})", "a tuple of Parameter: one alone needs a comma"),
        (f"({SHARE.replace('(0.0, 1.0)', '1.0')},)", r"share: plausible is 1.0 \(expected two numbers"),
        (f"({SHARE.replace('(0.0, 1.0)', '(1.0, 0.0)')},)", "the lower one first"),
        (f"({SHARE},), 'state'", "states are 'state' .expected a tuple of str"),
        (f"({SHARE.replace('0.5', repr('800'))},)", r"share: typical is '800' \(expected a finite number\)"),
        (f"({SHARE.replace('0.0, 0.5', 'None, 0.5')},)", r"share: neutral is None \(expected a finite number\)"),
        (f"({SHARE.replace('0.5', '1e999')},)", r"share: typical is inf \(expected a finite number\)"),
        (f"({SHARE.replace('0.5', 'True')},)", "share: typical is True"),
        (f"({SHARE.replace('0.5', '2000.0')},)", r"share: typical is 2000 \(expected a value that is plausible, 0 to 1\)"),
        (f"({SHARE.replace('(0.0, 1.0)', repr(('0', '1')))},)", r"share: plausible is \('0', '1'\) \(expected two numbers"),
        (f"({SHARE.replace(repr('share'), '3')},)", "parameters: 3 is no name of a parameter"),
        (f"({SHARE.replace(repr('share'), repr('a share'), 1)},)", "parameters: 'a share' is no name of a parameter"),
        (f"({SHARE},), order='first'", "order: 'first', expected a whole number"),
        (f"({SHARE},), order=True", "order: True, expected a whole number"),
    ],
)
def test_what_is_wrong_of_parameters_and_states_is_one_line(tmp_path, parameters, words):
    (tmp_path / "mine.py").write_text(COMPILED.format(name="mine", parameters=parameters, taken=", share"))
    with pytest.raises(InputError, match=words) as problem:
        library.find(tmp_path)
    assert "\n" not in str(problem.value) and "mine.py" in str(problem.value)


@pytest.mark.parametrize(("what", "written"), [("name", "'mine', 'A"), ("sentence", "'A sentence.'"), ("source", "'a source'"), ("port", "'suspension'")])
def test_what_an_effect_says_of_itself_is_text(tmp_path, what, written):
    other = "['mine'], 'A" if what == "name" else "['mine']"
    text = COMPILED.format(name="mine", parameters=f"({SHARE},)", taken=", share")
    (tmp_path / "mine.py").write_text(text.replace(written, other, 1))
    with pytest.raises(InputError) as refused:
        library.find(tmp_path)
    assert str(refused.value) == f"{tmp_path / 'mine.py'}: {what}: ['mine'], expected text"


IN_PYTHON = (
    "import numpy as np\nimport xarray as xr\n" + EFFECT.partition("def act")[0] + "def act({seen}, share):\n    return {returned}\n"
)
SEEN = {"vehicle": "vehicle", "path": "lateral, u", "sensor": "drive"}


@pytest.mark.parametrize(
    ("port", "returned", "said"),
    [
        ("vehicle", "None", "act returned nothing, expected a Vehicle (as of vehicle.replace)"),
        ("vehicle", "vehicle.values", "act returned a mappingproxy, expected a Vehicle (as of vehicle.replace)"),
        ("vehicle", "vehicle['weight']", "act failed: KeyError: 'weight'"),
        ("vehicle", "vehicle.replace(sprung_mass=9000.0)", "sprung_mass: 9000.0 kg, expected 300 to 8000 kg"),
        ("path", "None", "act returned nothing, expected an array of 601 positions in m, one for each u"),
        ("path", "share", "act returned a float, expected an array of 601 positions in m, one for each u"),
        ("path", "lateral[1:]", "act returned the shape (600,), expected an array of 601 positions in m, one for each u"),
        ("path", "np.where(u < 30.0, lateral, np.nan)", "act returned what is not finite everywhere, expected an array of 601 positions"),
        ("path", "lateral + np.ones(3)", "act failed: ValueError: operands could not be broadcast together with shapes (601,) (3,)"),
        ("sensor", "None", "act returned nothing, expected a Dataset over time"),
        ("sensor", "drive['a_z']", "act returned a DataArray, expected a Dataset over time"),
        ("sensor", "xr.Dataset()", "act returned a Dataset without s, "),
        ("sensor", "drive.drop_vars('a_z')", "act returned a Dataset without a_z, expected all that it was given over time"),
        ("sensor", "drive.isel(time=slice(0))", "act returned 0 records with times of their own, expected the "),
        ("sensor", "drive.assign_coords(time=drive.time + 1.0)", "records with times of their own, expected the "),
        ("sensor", "drive.__setitem__('time', drive.time.values + 1.0) or drive", "records with times of their own, expected the "),
        ("sensor", "drive.sel(signal='a_z')", "act failed: KeyError: "),
    ],
)  # fmt: skip
def test_an_effect_in_python_that_fails_or_returns_something_else_is_one_line(tmp_path, car, port, returned, said):
    (tmp_path / "mine.py").write_text(IN_PYTHON.format(name="mine", port=port, seen=SEEN[port], returned=returned))
    with pytest.raises(InputError) as raised:
        simulate.run(road(60.0), car, speed=10.0, effects="mine", effects_folder=tmp_path)
    text = str(raised.value)
    assert text.startswith(f"{tmp_path / 'mine.py'}: ") and said in text and "\n" not in text, text


@pytest.mark.parametrize(("port", "returned"), [("vehicle", "vehicle"), ("path", "lateral"), ("sensor", "drive")])
def test_an_effect_in_python_that_returns_what_it_sees_changes_nothing(tmp_path, car, port, returned):
    (tmp_path / "mine.py").write_text(IN_PYTHON.format(name="mine", port=port, seen=SEEN[port], returned=returned))
    drive = lambda effects: simulate.run(road(60.0), car, speed=10.0, effects=effects, effects_folder=tmp_path)["s"].values
    np.testing.assert_allclose(drive("mine"), drive(None), atol=1e-9)


def test_a_path_may_be_changed_in_place(tmp_path, car):
    """What is recorded is the path that the driver believes in."""
    drives = []
    for name, returned in (("mine", "np.add(lateral, 0.2, out=lateral)"), ("other", "lateral + 0.2")):
        (tmp_path / f"{name}.py").write_text(IN_PYTHON.format(name=name, port="path", seen=SEEN["path"], returned=returned))
        drives.append(simulate.run(road(60.0), car, speed=10.0, effects=name, effects_folder=tmp_path))
    np.testing.assert_array_equal(drives[0]["e"].values, drives[1]["e"].values)


def test_a_load_that_moves_the_centre_of_gravity_behind_the_rear_axle_is_refused(car):
    rearward = car.replace(cg_to_front_axle=2.0)
    with pytest.raises(InputError, match=r"payload.py: cg_to_front_axle: 3.07\d* m lies behind the rear axle \(wheelbase 2.757 m\)"):
        simulate.run(road(60.0), rearward, speed=10.0, effects={"payload": {"mass": 800.0, "ahead": -3.0}})


def test_an_effect_without_parameters_has_its_place_in_the_list_of_effects(tmp_path):
    (tmp_path / "mine.py").write_text(COMPILED.format(name="mine", parameters="()", taken=""))
    assert "mine\n" in table.text(library.find(tmp_path))


@pytest.mark.slow
def test_an_effect_may_be_called_as_what_its_port_sees(tmp_path, car):
    (tmp_path / "damping.py").write_text(COMPILED.format(name="damping", parameters=f"({SHARE},)", taken=", share"))
    waves = road(120.0, height=lambda u, v: 0.005 * np.sin(0.5 * u) + 0 * v)  # 1.2 Hz, at which bodies swing
    drive = lambda effects: simulate.run(waves, car, speed=15.0, effects=effects, effects_folder=tmp_path)
    assert float(drive({"damping": {}})["a_z"].std()) < 0.9 * float(drive({})["a_z"].std())
