"""What every effect owes, in the library and in a user's folder ($RIDECOMFORT_EFFECTS)."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.effects import compose
from ridecomfort.effects.contract import COMPILED, PORTS
from ridecomfort.vehicle.motion import BodyMotion

from tests.effects.whole import ENTRIES, FOLDER, drive
from tests.vehicle.roads import road, rough

UNIT = re.compile(r"(1|(kg|m|s|N|rad|Hz)[23]?)( (kg|m|s|N|rad)[23]?)*(/((m|s|N|rad|kg)[23]?))?")
MIRRORED = ("a_y", "roll_rate", "yaw_rate", "roll", "e")
"""Variables of a drive that change sign on a mirrored road."""

each = pytest.mark.parametrize("name", ENTRIES)
dissipative = [name for name, entry in ENTRIES.items() if entry.effect.dissipative]


@pytest.fixture(scope="module")
def ground():
    """A rough road with a bend, a bump that drives the suspension into its stops, and the speed to drive on it."""

    def height(u, v):
        bump = 0.09 * np.sin(np.pi * np.clip((u - 90.0) / 5.0, 0.0, 1.0)) ** 2
        return 3.0 * rough(u, v, seed=5) + bump * (1.0 + 0.1 * v)

    surface = road(200.0, height=height)
    curvature = 0.006 * np.sin(2 * np.pi * surface.u.values / 200.0)
    surface["curvature"] = "u", curvature
    speed = xr.DataArray(15.0 - 5.0 * np.cos(2 * np.pi * surface.u.values / 200.0), {"u": surface.u.values}, "u")
    return surface, speed


@pytest.fixture(scope="module")
def without(ground, car):
    surface, speed = ground
    return drive(surface, car, speed=speed, lateral=0.3)


@each
def test_says_what_it_is(name):
    effect, port = ENTRIES[name].effect, PORTS[ENTRIES[name].effect.port]
    assert len(effect.sentence) > 20 and effect.sentence.rstrip().endswith("."), f"{name}: sentence is not a sentence"
    assert len(effect.source) > 10, f"{name}: source names nothing that can be looked up"
    assert effect.parameters, f"{name} has no parameters"
    names = [parameter.name for parameter in effect.parameters]
    assert len(set(names)) == len(names)
    expected = len(port.sees) + len(effect.also_sees) + len(effect.states) + len(names)
    taken = len(inspect.signature(ENTRIES[name].act).parameters)
    assert taken == expected, (
        f"{name}: act takes {taken} arguments, expected {expected}: {', '.join((*port.sees, *effect.also_sees, *effect.states, *names))}"
    )


@each
def test_parameters_have_units_and_ranges(name):
    for parameter in ENTRIES[name].effect.parameters:
        low, high = parameter.plausible
        assert UNIT.fullmatch(parameter.unit), f"{name}: {parameter.name}: {parameter.unit!r} is not an SI unit"
        for value in (parameter.neutral, parameter.typical):
            assert low <= value <= high and low < high, f"{name}: {parameter.name}: {value} is not in {low} to {high}"
        assert parameter.meaning, f"{name}: {parameter.name} has no meaning"


@each
def test_has_a_size(name):
    sized = any(parameter.neutral != parameter.typical for parameter in ENTRIES[name].effect.parameters)
    assert sized, f"{name}: at least one parameter must have a typical value other than the neutral one"


@pytest.fixture
def asked(monkeypatch):
    """Every effect is asked: simulations leave out those that are neutral, trusting in the tests that follow."""
    handed = compose.parameters

    def parameters(chosen):
        values = handed(chosen)
        count = sum(entry.effect.port in COMPILED for entry, _ in chosen)
        values[len(values) - count - len(COMPILED) :] = 1.0
        return values

    monkeypatch.setattr(compose, "parameters", parameters)


def test_neutral_settings_change_nothing(ground, car, without):
    """But for rounding: the kernel fuses products and sums, and adding nothing changes which."""
    surface, speed = ground
    base = simulate.run(surface, car, speed=speed, lateral=0.3)
    for name in base.variables:
        np.testing.assert_allclose(without[name], base[name], rtol=0, atol=1e-9)


@each
def test_without_its_sizes_nothing_changes(ground, car, without, asked, name):
    surface, speed = ground
    sizes = {p.name: p.neutral for p in ENTRIES[name].effect.parameters if p.neutral != p.typical}
    shaped = drive(surface, car, effects={name: sizes}, speed=speed, lateral=0.3)
    for variable in without.variables:
        np.testing.assert_allclose(shaped[variable], without[variable], rtol=0, atol=1e-9)


@each
def test_takes_effect(ground, car, without, name):
    surface, speed = ground
    changed = drive(surface, car, effects=[name], speed=speed, lateral=0.3)
    count = min(changed.sizes["time"], without.sizes["time"])
    differences = [
        np.abs(changed[key].values[:count] - without[key].values[:count]).max() / np.ptp(without[key].values)
        for key in without.data_vars
    ]
    assert max(differences) > 1e-3, (
        f"at its typical values {name} changes no signal by more than {max(differences):.1g} of its range on a rough road"
    )


@each
@pytest.mark.parametrize("step", [0.001, 0.002])
@pytest.mark.parametrize("end", [0, 1])
def test_stays_finite_at_the_ends_of_its_range(ground, car, name, end, step):
    """In the steps of a drive, and in those of a search for what is missing."""
    surface, speed = ground
    sizes = {parameter.name: parameter.plausible[end] for parameter in ENTRIES[name].effect.parameters}
    extreme = drive(surface, car, effects={name: sizes}, speed=speed, lateral=0.3, step=step)
    for variable in extreme.variables:
        assert np.isfinite(extreme[variable]).all()
    largest_a_z = float(np.abs(extreme.a_z).max())
    assert largest_a_z < 100.0, f"{name} at {sizes}: a_z reaches {largest_a_z:.3g} m/s2, expected below 100 m/s2"


@each
def test_mirrored_road_gives_mirrored_drive_where_left_and_right_are_alike(ground, car, name):
    surface, speed = ground
    other = surface.copy(deep=True)
    other["elevation"] = ("u", "v"), surface.elevation.values[:, ::-1].copy()
    other["curvature"] = -surface.curvature
    there = drive(surface, car, effects=[name], speed=speed, lateral=0.3)
    here = drive(other, car, effects=[name], speed=speed, lateral=-0.3)
    off = 0.0
    for key in there.data_vars:
        sign = -1.0 if key in MIRRORED else 1.0
        off = max(off, float(np.abs(here[key] - sign * there[key]).max() / np.ptp(there[key].values)))
    if ENTRIES[name].effect.symmetric:
        assert off < 1e-6, f"{name} is said to be symmetric, but mirrored drives differ by {off:.1g} of their range"
    else:
        assert off > 1e-4, f"{name} is said not to be symmetric, but mirrored drives are alike (leave out symmetric=False?)"


def body_motion(rng):
    values = dict.fromkeys(BodyMotion._fields, 0.0)
    for key in ("speed", "side_speed", "vertical_speed", "roll_rate", "pitch_rate", "yaw_rate"):
        values[key] = rng.normal()
    values.update(speed=rng.uniform(1.0, 40.0), sprung_mass=1400.0, front=1.4, rear=-1.4)
    return BodyMotion(**values)


def work(entry, rng):
    """Energy in J that the effect takes out of a closed cycle of what its port sees."""
    effect = entry.effect
    sizes = [rng.uniform(*parameter.plausible) for parameter in effect.parameters]
    if effect.port == "body":
        motion = body_motion(rng)
        forces = entry.act(motion, *[0.0] * len(effect.states), *sizes)
        speeds = (
            motion.speed, motion.side_speed, motion.vertical_speed, motion.roll_rate, motion.pitch_rate, motion.yaw_rate
        )  # fmt: skip
        return -float(np.dot(forces[:6], speeds))
    if effect.port == "tyre_planar":
        load, speed = rng.uniform(0.0, 8000.0), rng.uniform(-40.0, 40.0)
        nil = [0.0] * (len(effect.also_sees) + len(effect.states))
        return -entry.act(0, 0.0, 0.0, load, speed, 0.0, 0.0, *nil, *sizes)[2] * speed
    if effect.port == "interconnection":
        motion = rng.normal(0.0, (0.01, 0.1), (4, 2))
        force = [entry.act(i, *motion[i], *motion[i ^ 2], *motion[i ^ 1], *motion[i ^ 3], *[0.0] * len(effect.states), *sizes) for i in range(4)]
        return float(np.dot(np.atleast_2d(force).reshape(4, -1)[:, 0], motion[:, 1]))
    step, period = 1e-4, rng.uniform(0.1, 2.0)
    phase = 2 * np.pi * np.arange(0.0, period, step) / period
    amplitudes, shifts = 0.02 * rng.uniform(size=3), rng.uniform(0, 6.3, size=3)
    deflections = sum(a * np.sin((k + 1) * phase + b) for k, (a, b) in enumerate(zip(amplitudes, shifts, strict=True)))
    velocities = np.gradient(deflections, step)
    states, energy = np.zeros(len(effect.states)), 0.0
    for lap in range(3):
        energy = 0.0
        for x, v in zip(deflections, velocities, strict=True):
            more = (28000.0, 2000.0, 0.0, 0.0) if effect.port == "suspension" else (28e4, 0.014, 0.0, 60.0)
            handed = [2000.0 * v for _ in effect.also_sees]  # the force of the damper
            found = np.atleast_1d(entry.act(0, x, v, *more, *handed, *states, *sizes))
            count = 1 + len(effect.also_returns)
            states = states + step * np.array(found[count:])
            energy += (sum(found[:count]) - sum(handed)) * v * step
        if not effect.states:
            break
    return energy


@pytest.mark.parametrize("name", dissipative)
def test_dissipative_effects_take_energy_out_of_every_cycle(name):
    rng = np.random.default_rng(3)
    lost = [work(ENTRIES[name], rng) for _ in range(10)]
    assert min(lost) >= -1e-9, f"{name} is said to be dissipative but puts {-min(lost):.3g} J into a closed cycle at its port"
    assert max(lost) > 0.0, f"{name} is said to be dissipative but takes no energy out of any of ten closed cycles at its port"


def largest(effect):
    """Each size at the end of its plausible range that is farther from neutral; what only shapes the effect at its typical."""
    return {
        parameter.name: max(parameter.plausible, key=lambda end: abs(end - parameter.neutral))
        if parameter.neutral != parameter.typical
        else parameter.typical
        for parameter in effect.parameters
    }


@pytest.mark.parametrize("name", dissipative)
def test_dissipative_effects_take_energy_out_of_the_car(car, name):
    """A car without dampers swings on behind a bump; what it has lost of motion by then, it has lost to the effect.

    A typical size may be too small to be seen within the seconds of a test; it must not add energy. The largest
    plausible size must take out a tenth of the swing or a thousandth of the speed.
    """
    undamped = car.replace(damping_front=0.0, damping_rear=0.0, tyre_radial_damping=0.0)
    surface = road(150.0, height=lambda u, v: 0.03 * np.sin(np.pi * np.clip((u - 20.0) / 4.0, 0.0, 1.0)) ** 2 + 0 * v)
    energies = {}
    for size, effects in (("none", []), ("typical", [name]), ("largest", {name: largest(ENTRIES[name].effect)})):
        whole = drive(surface, undamped, effects=effects, speed=15.0)
        seen = whole.sel(time=slice(5.0, None))
        height = np.cumsum(seen.a_z - seen.a_z.mean()) * 0.01
        swing = car["sprung_mass"] * height.var() + car["pitch_inertia"] * seen.pitch_rate.var()
        energies[size] = np.array([float(swing), float((whole.v_x**2).mean())])
    swing, way = energies["typical"] / energies["none"]
    told = f"at its typical values {name} leaves {swing:.3g} of the swing behind a bump and {way:.5g} of the speed squared"
    assert swing < 1.1 and way < 1.0001, f"{told}: it is said to be dissipative but adds energy (has its force the right sign?)"
    swing, way = energies["largest"] / energies["none"]
    told = f"at its largest plausible values {name} leaves {swing:.3g} of the swing behind a bump and {way:.5g} of the speed squared"
    assert swing < 0.9 or way < 0.999, f"{told}: it is said to be dissipative but takes hardly any energy"


def test_a_file_in_a_users_folder_is_all_it_takes(ground, car, tmp_path):
    surface, speed = ground
    (tmp_path / "spring_excess.py").write_text(
        '"""Springs that are stiffer than the parameters say."""\n'
        "from ridecomfort.effects.contract import Effect, Parameter\n\n"
        'effect = Effect("spring_excess", "Springs are stiffer by a share.", "a user", "suspension",\n'
        '    (Parameter("share", "1", 0.0, 0.25, (0.0, 1.0), "share of the stiffness"),))\n\n\n'
        "def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, share):\n"
        "    return share * stiffness * deflection\n"
    )
    options = {"speed": speed, "lateral": 0.3}
    added = simulate.run(surface, car, effects=["spring_excess"], effects_folder=tmp_path, **options)
    names = ("spring_stiffness_front", "spring_stiffness_rear")
    stiffer = car.replace(**{name: 1.25 * car[name] for name in names})
    expected = simulate.run(surface, stiffer, **options)
    base = simulate.run(surface, car, **options)
    assert float((added.a_z - expected.a_z).std()) < 1e-6 * float((base.a_z - expected.a_z).std())


def test_a_new_process_compiles_nothing_again(without):
    code = (
        "from ridecomfort.effects import compose, library\n"
        "import numpy as np, xarray as xr\n"
        "from tests.effects.whole import ENTRIES, drive\n"
        "from tests.vehicle.roads import road\n"
        "from ridecomfort.vehicle import parameters\n"
        "drive(road(40.0), parameters.read('config/vehicles/midsize.yaml'), speed=10.0)\n"
        "stats = compose.compose(sorted(ENTRIES.values(), key=lambda entry: entry.effect.rank)).drive.stats\n"
        "print(sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))\n"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.split() == ["1", "0"]


def test_ports_are_all_in_use():
    assert {entry.effect.port for entry in ENTRIES.values()} == set(PORTS)
    assert set(COMPILED) < set(PORTS)
    assert FOLDER.is_dir()


def test_the_example_in_the_instructions_is_one_of_the_users_effects(repository):
    example = repository / "tests" / "contract" / "user_effects" / "damper_quadratic.py"
    assert example.read_text(encoding="utf-8").strip() in (repository / "CONTRIBUTING.md").read_text(encoding="utf-8")
