"""A car beside its measured drives: whatever it lacks or has, it drives the measured path."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from ridecomfort import simulate
from ridecomfort.calibrated import with_values
from ridecomfort.discrepancy import experiment as exp
from ridecomfort.discrepancy import floor, nuisances, opening, probe
from ridecomfort.drive.replay import ASTRAY, CLOSE, slowly
from ridecomfort.drive.sampling import rate_of
from ridecomfort.drive.slow import smooth
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS
from tests import braked
from tests.blind import trials


@pytest.fixture(scope="module")
def made(repository):
    vehicle = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    trial = trials.make(31, vehicle, {}, 1.0)
    return opening.car(opening.sites_of(trial.measured), vehicle, library_names=["crosswind"])


def aside(made, again, values) -> float:
    """m (rms) by which a replay misses the measured path at these values."""
    vehicle, effects = with_values(made.vehicle, made.effects, values)
    return float(np.sqrt(np.mean(again.astray(again.run(vehicle, effects))["lateral"][again.compared] ** 2)))


def test_what_a_vehicle_has_not_is_no_size_of_it(made):
    without = made.vehicle.replace(anti_roll_stiffness_rear=0.0)
    drives = [again.drive for again in made.replays[:1]]
    free = opening.car([opening.Site("trial", made.replays[0].road, drives)], without, library_names=["crosswind"]).free
    assert {"anti_roll_stiffness_rear"} == {size.key for size in made.free} - {size.key for size in free}


def test_an_effect_of_a_folder_that_has_no_size_to_fit_is_a_candidate_and_in_no_simulation(made, tmp_path):
    (tmp_path / "push.py").write_text(
        "from ridecomfort.effects.contract import Effect, Parameter\n"
        "effect = Effect('push', 'A strut that pushes.', 'a source', 'suspension', (Parameter('force', 'N', 90.0, 90.0, (0.0, 500.0), 'a force'),))\n"
        "def act(wheel, deflection, velocity, stiffness, damping, force_x, force_y, force):\n    return force\n"
    )
    site = opening.Site("trial", made.replays[0].road, [made.replays[0].drive])
    found = opening.car([site], made.vehicle, library_names=["crosswind", "push"], effects_folder=tmp_path)
    assert {one.name: bool(one.sizes) for one in found.candidates} == {"crosswind": True, "push": False} and set(found.quiet) == {"crosswind"}


def test_a_roll_centre_below_the_ground_may_be_wrong_by_a_share_of_its_depth(made):
    below = made.vehicle.replace(roll_centre_height_front=-0.05)
    site = opening.Site("trial", made.replays[0].road, [made.replays[0].drive])
    (found,) = (
        size for size in opening.car([site], below, library_names=["crosswind"], uncertain={"roll_centre_height_front": 0.2}).free
        if size.key == "roll_centre_height_front"
    )  # fmt: skip
    assert (found.lower, found.upper) == pytest.approx((-0.06, -0.04))


def test_what_was_calibrated_is_fitted_again_within_its_bounds_and_nothing_twice(made):
    """Of the paper's five, those that the user took out are not."""
    calibration = xr.Dataset(
        {"value": ("parameter", [30000.0, 500.0]), "lower": ("parameter", [20000.0, 300.0]), "upper": ("parameter", [40000.0, 900.0])},
        {"parameter": ["spring_stiffness_front", "roll_inertia"]},
    )
    road = {"trial": (made.replays[0].road, [made.replays[0].drive])}
    free = opening.opened(road, made.vehicle, calibration=calibration, among=["crosswind"], workers=1).free
    keys = [size.key for size in free]
    assert len(set(keys)) == len(keys) and set(keys) == {"spring_stiffness_front", *opening.UNCERTAIN}
    (inertia,) = (size for size in free if size.key == "roll_inertia")
    assert (inertia.neutral, inertia.lower, inertia.upper) == (500.0, 300.0, 900.0)
    narrower = {"roll_inertia": (400.0, 600.0)}
    free = opening.opened(road, made.vehicle, calibration=calibration, bounds=narrower, among=["crosswind"], workers=1).free
    assert next((size.lower, size.upper) for size in free if size.key == "roll_inertia") == (400.0, 600.0)


def test_a_size_that_is_told_is_held_and_others_of_the_effect_are_fitted(made):
    road = {"trial": (made.replays[0].road, [made.replays[0].drive])}
    told = {"aerodynamic_drag": {"area": 0.64}, "damper_knee": {"knee": 0.1}, "suspension_friction": {}}
    car = opening.opened(road, made.vehicle, effects=told, among=["crosswind"], workers=1)
    fitted = {size.key for size in car.free if "." in size.key}
    assert {key.partition(".")[0] for key in fitted} == {"damper_knee", "suspension_friction"} and "damper_knee.knee" not in fitted
    assert car.effects["aerodynamic_drag"]["area"] == 0.64 and car.effects["damper_knee"]["knee"] == 0.1


def test_drives_on_other_stretches_are_no_repeats_of_one_another(made):
    drive, road = made.replays[0].drive, made.replays[0].road
    half = int(0.6 * drive.sizes["time"])
    parts = [drive.isel(time=slice(0, half)), drive.isel(time=slice(drive.sizes["time"] - half, None))]
    parts = [part.assign_coords(time=part["time"] - part["time"][0]) for part in parts]
    cars = opening.car([opening.Site("trial", road, parts)], made.vehicle, library_names=["crosswind"])
    assert len({record.condition for record in cars.records}) == 2
    whole = opening.car([opening.Site("trial", road, [drive, drive])], made.vehicle, library_names=["crosswind"])
    assert len({record.condition for record in whole.records}) == 1


@pytest.mark.parametrize("fitted, held_out", [(1, 2), (2, 1)])
def test_repeats_on_another_site_are_kept_where_they_alone_tell_the_floor(made, fitted, held_out):
    drive, road = made.replays[0].drive, made.replays[0].road
    sites = [opening.Site("one", road, [drive] * fitted), opening.Site("other", road, [drive, drive])]
    car = opening.car(sites, made.vehicle, library_names=["crosswind"])
    assert [record.role for record in car.records] == ["fit"] * fitted + ["check"] * held_out
    assert [len(own) for own in floor.repeats(car, range(len(car.records))).values()] == [2]


@pytest.mark.parametrize(
    "slower, seconds, begins",
    [
        (1.0, 30.0, 6.0),  # 22 m/s: the run-in of 54 m ends after 2.5 s, when its driver has not yet found the path
        (3.0, 30.0, 1.5 + 3 * 2.5),  # long under way at the end of the run-in
        (1.0, 14.0, 2.5 + 0.25 * 11.5),  # three quarters of what a short drive has are left
    ],
)
def test_a_drive_is_judged_from_when_it_is_under_way(made, slower, seconds, begins):
    drive, whole = made.replays[0].drive, made.replays[0].road.road
    drive = drive.isel(time=(drive["time"] - drive["time"][0]).values < seconds)
    drive = drive.assign(v_x=drive["v_x"] / slower).assign_coords(time=slower * drive["time"])
    road = whole.sel(u=slice(float(drive["s"][0]), None))
    (again,) = opening.car(opening.sites_of({"trial": (road, [drive])}), made.vehicle, library_names=["crosswind"]).replays
    assert again.time[again.compared][0] - again.time[0] == pytest.approx(begins, abs=0.15 * slower)


def cut(drive, seconds):
    """The first so many seconds of a drive."""
    return drive.isel(time=(drive["time"] - drive["time"][0]).values < seconds)


def test_a_drive_that_is_too_short_to_be_asked_is_set_aside_and_said_to_be(made):
    drive, road = made.replays[0].drive, made.replays[0].road
    opened = lambda *drives: opening.car([opening.Site("trial", road, drives)], made.vehicle, library_names=["crosswind"])
    short = cut(drive, 8.0).assign_attrs(name="short", role="check")
    found = opened(short, drive)
    assert [record.name for record in found.records] == [drive.attrs["name"]] and len(found.replays) == 1
    (said,) = found.set_aside
    assert said.startswith("trial short is judged for 5.") and said.endswith("too short to be asked (less than 10 s)")
    # Of fitted drives that are all short something may yet be said.
    alone = opened(cut(drive, 12.0), short)
    assert [record.role for record in alone.records] == ["fit"] and "what is found may be chance" in alone.set_aside[-1]
    with pytest.raises(InputError, match="fitted drives are judged for 5.* s in all .expected 6 s at least"):
        opened(cut(drive, 8.0))


def test_drives_that_are_sampled_otherwise_than_one_another_are_refused(made):
    drive, road = made.replays[0].drive, made.replays[0].road
    slower = drive.isel(time=slice(None, None, 2)).assign_attrs(name="slower")
    with pytest.raises(InputError, match="^drive slower: is sampled at 50 Hz, drive drive_1 at 100 Hz"):
        opening.car([opening.Site("trial", road, [drive, slower])], made.vehicle, library_names=["crosswind"])


@pytest.mark.parametrize("given", [{"library_names": ["no_such"]}, {"uncertain": {"no_such": 0.1}}, {"bounds": {"no_such": (0, 1)}}])
def test_a_name_that_nobody_knows_is_refused(made, given):
    site = opening.Site("trial", made.replays[0].road, [made.replays[0].drive])
    with pytest.raises(InputError, match="unknown 'no_such' .expected of "):
        opening.car([site], made.vehicle, **{"library_names": ["crosswind"], **given})


def test_a_driver_makes_up_for_a_wind_that_pushes_the_model_aside(made):
    values = {**opening.start_values(made), "crosswind.wind": 10.0}
    blown = aside(made, made.replays[0], values)
    retuned, residuals = made.retuned(values, [0])
    assert blown > 0.02 and aside(made, retuned.replays[0], values) < 0.02 * blown
    assert retuned.replays[1] is made.replays[1]
    np.testing.assert_allclose(residuals[0], retuned.residual(values, 0))


def test_millimetres_of_path_are_made_good_without_driving_again(made):
    """Against the same with its driver brought to the path: two thirds of what they do to the side are gone, of what they do to heave nine
    tenths. The rest, most of it in pitch, is of a speed that differs, too, and of ends."""
    values = {**opening.start_values(made), "crosswind.wind": 0.3, "crosswind.gust": 0.0}
    assert CLOSE["lateral"] < aside(made, made.replays[0], values) < ASTRAY["lateral"]
    exact = made.retuned(values, [0])[1][0]
    left = [np.std(car.residual(values, 0) - exact, axis=1) for car in (made, replace(made, steered={}))]
    share = dict(zip(SIGNALS, left[0] / left[1]))
    assert share["a_z"] < 0.1 and share["pitch_rate"] < 0.2 and share["a_y"] < 0.33 and max(share.values()) < 0.7


def test_residuals_are_those_on_the_measured_path(made):
    values = {**opening.start_values(made), "crosswind.wind": 10.0}
    vehicle, effects = with_values(made.vehicle, made.effects, values)
    again = made.replays[0]
    blown = again.residual(again(vehicle, effects))[:, again.compared]
    kept, told = made.retuned(values, [0])[0].residual(values, 0), made.residual(values, 0)
    assert np.std(told - kept) < 0.2 * np.std(blown - kept)


def test_a_residual_goes_on_evenly_where_the_driver_begins_to_be_corrected(made):
    """In winds on either side of it, to a fiftieth of the residual, which is mostly noise."""
    still = {**opening.start_values(made), "crosswind.gust": 0.0, "crosswind.wind": 0.0}
    winds = np.array([0.2, 0.3, 0.4, 0.5, 0.6])
    off = [aside(made, made.replays[0], {**still, "crosswind.wind": wind}) for wind in winds]
    assert off[0] < ASTRAY["lateral"] < off[-1]
    base = made.residual(still, 0)
    changes = np.array([made.residual({**still, "crosswind.wind": wind}, 0) - base for wind in winds])
    straight = winds[:, None, None] * (np.tensordot(winds, changes, axes=1) / np.sum(winds**2))
    assert (np.std(changes - straight, axis=-1) < 0.02 * np.std(base, axis=-1)).all()


def test_realigning_moves_the_path_that_is_to_be_driven(made):
    values = opening.start_values(made)
    count = len(made.nuisances(values, 0))
    first = (count + nuisances.BETWEEN) // 2
    amounts, bends = np.zeros(count), np.zeros(count)
    amounts[first : count + nuisances.BETWEEN] = 1.0
    moved = made.realigned({0: amounts})
    shift = moved.replays[0].drive["e"] - made.replays[0].drive["e"]
    np.testing.assert_allclose(shift, -nuisances.PATH, rtol=1e-4)
    bends[first : count + nuisances.BETWEEN] = 0.3 * np.sin(2.0 * np.arange(count + nuisances.BETWEEN - first))
    bent = made.realigned({0: bends})
    gone = np.std((bent.replays[0].drive["e"] - made.replays[0].drive["e"]).values[made.replays[0].compared])
    assert aside(moved, moved.replays[0], values) < 0.003
    assert aside(bent, bent.replays[0], values) < 0.3 * gone


def test_a_driver_who_is_corrected_follows_what_the_model_drove_and_no_more_of_what_is_fast_in_a_recorded_path(made):
    """A wind of 0.8 m/s leads the model 6 mm aside. Corrected by what was recorded, it would follow that a little farther than without wind."""
    still, wind = opening.start_values(made), {"crosswind.gust": 0.0, "crosswind.wind": 0.8}
    held, _ = made.retuned(still, [0])

    def faster(car) -> float:
        """What is fast (m, rms) of the change of the path by the wind."""
        paths = []
        for values in (still, {**still, **wind}):
            found = car._following(values, 0)
            paths.append(car.replays[0].driven(found.run)["e"])
        assert found.replay is not car.replays[0]
        change = paths[1] - paths[0]
        return float((change - slowly(change, rate_of(car.replays[0].time)))[car.replays[0].compared].std())

    free = replace(held, replays=[replace(again, kept_to={}) for again in held.replays])
    assert faster(held) < 0.4 * faster(free)


def test_what_a_driver_is_held_to_is_forgotten_where_drives_are_aligned_anew(made):
    values = opening.start_values(made)
    held, _ = made.retuned(values, [0])
    assert set(held.replays[0].kept_to) == {"v_x", "e"} and np.any(held.replays[0].left)
    moved = held.realigned({0: np.zeros(len(made.nuisances(values, 0)))})
    assert not moved.replays[0].kept_to and not np.any(moved.replays[0].left)
    assert moved.taking(held, [0]).replays[0].kept_to and np.any(moved.taking(held, [0]).replays[0].left)


def test_where_a_driver_is_held_to_what_he_drives_residuals_are_those_of_before(made):
    values = opening.start_values(made)
    held, residuals = made.retuned(values, [0])
    np.testing.assert_allclose(held.residual(values, 0), residuals[0], atol=1e-9)


def test_a_coarse_step_is_made_good_in_residuals_and_not_in_their_changes(made):
    """Against the same car driven at an eighth of the step: seven tenths of what the step makes wrong go, at the least."""
    values = opening.start_values(made)
    coarse, _ = made.retuned(values, [0])
    fine = replace(coarse, replays=[replace(again, options={**again.options, "step": 0.000125}) for again in coarse.replays])
    moved = {**values, "tyre_radial_stiffness": 1.1 * values["tyre_radial_stiffness"]}
    exact, _ = coarse.retuned(values, [0], exactly=True)
    wrong = [np.sqrt(np.mean((one.residual(values, 0) - fine.residual(values, 0)) ** 2, axis=1)) for one in (coarse, exact)]
    assert (wrong[1] < 0.3 * wrong[0]).all(), wrong[1] / wrong[0]
    change = lambda one: one.residual(moved, 0) - one.residual(values, 0)
    np.testing.assert_allclose(change(exact), change(coarse), atol=1e-9)


def test_steps_twice_as_long_change_directions_by_little(made):
    """What is probed for, in steps twice as long and in steps as they are."""
    values = opening.start_values(made)
    frame = exp.frame(made, (residuals := exp.simulate(made, values, [0])), exp.nuisances(made, values, [0]))
    sizes = [size for size in made.free if size.key in ("tyre_radial_stiffness", "damping_front", "roll_inertia", "spring_stiffness_rear")]
    coarser, base = probe.coarsely(made, values, residuals)
    np.testing.assert_array_equal(coarser.residual(values, 0), base[0])  # of what changes nothing the column is nil, not rounding
    np.testing.assert_allclose(base[0], residuals[0], atol=1e-9)
    for size in sizes:
        own, coarse = (exp.secant(one, values, there, size, 1.0) for one, there in ((made, residuals), (coarser, base)))
        one, other = frame.flats([own, coarse])
        assert one @ other > 0.99 * np.sqrt((one @ one) * (other @ other)), size.key
        assert not np.array_equal(one, other)


def test_what_a_wheel_does_in_a_pothole_at_another_moment_of_a_step_weighs_little(repository, monkeypatch):
    """A hole of 4 cm under the left wheels at 22 m/s, 2 cm of road a step. A little drag, which changes nothing else yet, shifts where steps fall."""
    plain = trials.a_road

    def pitted(rng):
        road = plain(rng)
        is_in_hole = (road.u > 300.0) & (road.u < 300.6) & (road.v > 0.2)
        return road.assign(elevation=road["elevation"] - 0.04 * is_in_hole)

    monkeypatch.setattr(trials, "a_road", pitted)
    vehicle = parameters.read(repository / "config" / "vehicles" / "midsize.yaml")
    car = opening.car(opening.sites_of(trials.make(31, vehicle, {}).measured), vehicle, library_names=["aerodynamic_drag"])
    values = opening.start_values(car)
    exact, residuals = car.retuned(values, [0], exactly=True)
    coarse, _ = probe.coarsely(exact, values, residuals)
    nuisances_of = exp.nuisances(exact, values, residuals)

    def jumps(experiment):
        frame = exp.frame(experiment, residuals, nuisances_of)
        loss = lambda area: float(np.sum(frame.flat_of(0, coarse.residual({**values, "aerodynamic_drag.area": area}, 0)) ** 2))
        return max(abs(loss(area) - loss(0.0)) for area in (0.003, 0.01, 0.03))

    known, unknown = jumps(exact), jumps(replace(exact, exactness={}))
    assert known < 100.0 < 1000.0 < unknown


def test_a_model_that_steps_twice_as_long_do_not_hold_is_probed_in_its_own(made):
    class Fragile:
        def coarser(self, values, residuals):
            raise InputError("did not stay finite")

    residuals, fragile = {0: np.zeros((6, 3))}, Fragile()
    assert probe.coarsely(fragile, {}, residuals) == (fragile, residuals)


def test_steps_are_not_made_longer_than_2_ms(made):
    slow = replace(made, replays=[replace(again, options={**again.options, "step": 0.002}) for again in made.replays])
    values = opening.start_values(made)
    residuals = exp.simulate(made, values, [0])
    assert slow.coarser(values, residuals)[0] is slow
    assert made.coarser(values, residuals)[0].replays[0].options["step"] == 0.002


def test_the_step_of_another_simulator_is_its_own(made):
    other = replace(made, replays=[replace(again, simulate=lambda *a, **k: simulate.run(*a, **k)) for again in made.replays])
    values = opening.start_values(other)
    assert other.coarser(values, exp.simulate(other, values, [0]))[0] is other
    exact, plain = (other.retuned(values, [0], exactly=exactly)[1][0] for exactly in (True, False))
    np.testing.assert_array_equal(exact, plain)


def test_what_a_foot_that_is_heard_makes_up_for_is_no_error(made):
    """A lag of a tenth of a second between pedals and wheels: little of it is left where the driver brakes as much earlier."""
    course = braked.course()
    site = opening.Site("braked", course, [braked.drive(course, made.vehicle)[0]])
    heard = opening.car([site], made.vehicle, library_names=["drivetrain_lag"])
    assert heard.replays[0].by_foot is not None and heard.paced[0] is not None
    unheard = replace(heard, replays=[replace(heard.replays[0], by_foot=None)], paced={})
    still = opening.start_values(heard)

    def changed(car) -> float:
        """What the lag changes of a_x at 0.8 to 2 Hz, rms."""
        car, base = car.retuned(still, [0])
        change = (car.residual({**still, "drivetrain_lag.time": 0.1}, 0) - base[0])[SIGNALS.index("a_x")]
        return float(np.std((smooth(change, 100.0, 2.0, 4) - smooth(change, 100.0, 0.8, 4))[200:-200]))

    assert changed(heard) < 0.2 * changed(unheard)


@pytest.mark.parametrize("times", [1, 2])
def test_noise_is_left_out_of_a_foot_where_drives_were_repeated(made, times):
    """Else what a model lacks along the road would pass for noise of the accelerometer, and a driver who brakes would brake less."""
    course = braked.course()
    drive, _ = braked.drive(course, made.vehicle, of_acceleration=0.05)
    site = opening.Site("braked", course, [drive.assign_attrs(name=f"drive_{k}") for k in range(times)])
    heard = opening.car([site], made.vehicle, library_names=[])
    found, _ = heard.retuned(opening.start_values(heard), [0])
    assert found.replays[0].by_foot is not None
    assert np.any(found.replays[0].by_chance) == (times > 1)


def test_what_a_heard_driver_misses_is_made_good_without_driving_again(made):
    """A lag of 20 ms, by which he misses 6 mm/s, against the driver who is brought to the speed."""
    course, driven = braked.course(), []
    site = opening.Site("braked", course, [braked.drive(course, made.vehicle)[0]])
    heard = opening.car([site], made.vehicle, library_names=["drivetrain_lag"])
    values = opening.start_values(heard)
    held, _ = heard.retuned(values, [0])
    lagging = {**values, "drivetrain_lag.time": 0.02}

    def counting(*arguments, **settings):
        driven.append(settings)
        return simulate.run(*arguments, **settings)

    counted = replace(held, replays=[replace(held.replays[0], simulate=counting)])
    made_good = counted.residual(lagging, 0)
    assert len(driven) == 1

    def residual(following) -> np.ndarray:
        return following.replay.residual(following.replay.sample(following.run))[:, held.replays[0].compared]

    late, brought = held._following(lagging, 0), held._led(held.replays[0], lagging)
    assert late.missed("speed") > held.replays[0].strictly(ASTRAY)["speed"] > brought.missed("speed")
    for name in ("a_x", "a_z", "pitch_rate"):
        own = SIGNALS.index(name)
        assert np.std((made_good - residual(brought))[own]) < 0.3 * np.std((residual(late) - residual(brought))[own]), name
