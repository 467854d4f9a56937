"""A car that is not ours: imported as a user would, aligned, calibrated on one drive, checked on another.

The drives were computed by an independent multi-body program. Parameters of its tyres and dampers
are unknown and lie outside tab:constraints, so the bounds here are those of published cars
(references/vehicle_parameters.csv: tyres 158 to 358 kN/m and 0 to 2000 N s/m, with a margin).
"""

from __future__ import annotations

import pytest
import yaml

from ridecomfort import calibrate, calibrated, simulate
from ridecomfort.discrepancy import compare, diagnose, rank
from ridecomfort.drive import align, configured, lead, replay
from ridecomfort.road import crg
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import SIGNALS

SITE = """
columns: {
  time: {column: "time [s]", unit: s},
  s: {column: "distance [m]", unit: m},
  v_x: {column: "speed [km/h]", unit: km/h},
  a_x: {column: "acc_x [m/s2]", unit: m/s2},
  a_y: {column: "acc_y [m/s2]", unit: m/s2},
  a_z: {column: "acc_z [m/s2]", unit: m/s2},
  roll_rate: {column: "gyro_x [rad/s]", unit: rad/s},
  pitch_rate: {column: "gyro_y [rad/s]", unit: rad/s},
  yaw_rate: {column: "gyro_z [rad/s]", unit: rad/s},
}
sensor: {behind_front_axle: 1.37, left: 0.0, above_wheel_centres: 0.95}
distance_of: front_axle
road_friction: 0.8
"""

BOUNDS = {
    "spring_stiffness_front": (10000.0, 80000.0),
    "spring_stiffness_rear": (10000.0, 80000.0),
    "tyre_radial_stiffness": (120000.0, 450000.0),
    "tyre_radial_damping": (0.0, 2500.0),
}


@pytest.fixture(scope="module")
def car(repository):
    return parameters.read(repository / "config" / "vehicles" / "midsize.yaml")


@pytest.fixture(scope="module")
def folder(shared):
    folder = shared / "data" / "realcar"
    if not folder.is_dir():
        pytest.skip("the drives of realcar are not in ../shared")
    return folder


@pytest.fixture(scope="module")
def road(folder):
    return simulate.prepare(crg.read(folder / "road.crg", interpolation="cubic"))


@pytest.fixture(scope="module")
def drives(folder, car, road):
    return aligned(folder, car, road)


def aligned(folder, car, road, site=SITE):
    """At 80 km/h along the middle, to fit; at 50 km/h, 0.3 m to its left, to check. Neither path is told."""
    roles = {"drive_80kmh": "fit", "drive_50kmh": "check"}
    return [
        align.align(
            configured.read(folder / f"{name}.csv", yaml.safe_load(site) | {"role": role}, car),
            road,
            car,
            simulate=simulate.run,
        )
        for name, role in roles.items()
    ]


@pytest.fixture(scope="module")
def calibration(drives, road, car):
    return calibrate.calibrate(drives, road, car, bounds=BOUNDS, restarts=1)


@pytest.fixture(scope="module")
def nrmse(drives, road, car, calibration):
    states = {"reference": (car, {}), "calibrated": calibrated.apply(calibration, car)}
    return compare.compare(drives, road, states, simulate=simulate.run)["nrmse"]


def test_its_path_is_found_from_the_road_alone(drives):
    for drive, lateral in zip(drives, (0.0, 0.3)):
        assert drive.attrs["lateral_position"] == pytest.approx(lateral, abs=0.03)
        assert abs(drive.attrs["clock_offset"]) < 0.005 and drive.attrs["speed_scale"] == pytest.approx(1, abs=1e-3)
        assert drive.attrs["acceleration_gain"] == pytest.approx(1, abs=0.005)


def test_that_its_distance_is_the_front_axles_is_seen_where_nobody_said_so(folder, car, road, drives):
    assert lead.of_drives(drives) is None
    found = lead.of_drives(aligned(folder, car, road, SITE.replace("distance_of: front_axle", "")))
    assert found == pytest.approx(car["cg_to_front_axle"], abs=0.1)
    assert "distance_of: front_axle" in lead.words(found, car["cg_to_front_axle"])


def test_calibration_improves_the_drive_it_was_made_on(nrmse):
    before, after = (nrmse.sel(drive="drive_80kmh", state=state) for state in ("reference", "calibrated"))
    assert (after.sel(signal="a_z") < 0.6 * before.sel(signal="a_z")).all()
    assert (after.sel(signal="pitch_rate") < 0.6 * before.sel(signal="pitch_rate")).all()


def test_and_the_drive_that_it_never_saw(nrmse):
    before, after = (nrmse.sel(drive="drive_50kmh", state=state) for state in ("reference", "calibrated"))
    assert (after.sel(signal="a_z") < 0.6 * before.sel(signal="a_z")).all()
    assert (after.sel(signal=["a_x", "a_y", "pitch_rate"]) < before.sel(signal=["a_x", "a_y", "pitch_rate"])).all()


def test_a_straight_road_does_not_show_the_friction_and_that_is_said(calibration):
    assert "not identified" in str(calibration["verdict"].sel(parameter="tyre_friction").item())


def test_with_its_roll_calibrated_the_other_drive_has_the_strength_that_was_measured(drives, road, car):
    """rms of bounce, pitch and roll on the drive that was never seen; five parameters leave a third of the roll out."""
    chosen = [*BOUNDS, "roll_inertia", "anti_roll_stiffness_front"]
    found = calibrate.calibrate(drives, road, car, parameters=chosen, bounds=BOUNDS, sequence=False, restarts=0)
    vehicle, _ = calibrated.apply(found, car)
    again = replay.replay(drives[1], road, simulate.run).tuned(vehicle)
    simulated, measured = again(vehicle).signals[:, again.compared], again.measured()[:, again.compared]
    for name in ("a_z", "pitch_rate", "roll_rate"):
        row = SIGNALS.index(name)
        assert simulated[row].std() == pytest.approx(measured[row].std(), rel=0.2), name


@pytest.mark.long
def test_as_the_readme_calibrates_a_car_of_which_little_is_known_most_of_its_error_has_names(folder, repository, car):
    """On the interpolation that the other program used. Six are missing, of which roll centres are sure only once all are found."""
    block = (repository / "README.md").read_text().partition("```yaml\ncalibration:\n")[2].partition("```")[0]
    settings = yaml.safe_load(block)
    road = simulate.prepare(crg.read(folder / "road.crg", interpolation="linear"))
    drives = aligned(folder, car, road)
    found = calibrate.calibrate(drives, road, car, **settings, sequence=False, restarts=0)
    _, verdict = rank({"realcar": (road, drives)}, car, calibration=found)
    assert verdict.verdict == "named" and min(verdict.share, verdict.held_out_share) > 0.65
    assert {effect.name for effect in verdict.effects} == {
        "damper_asymmetry", "damper_knee", "wheel_recession", "tyre_rolling_radius", "roll_centre_height", "bump_steer"
    }  # fmt: skip
    assert verdict.remainder["yaw_rate"] > 0.5  # most of the little that a straight road turns has none


@pytest.mark.long
def test_the_diagnosis_says_what_it_can_explain_what_it_cannot_and_where_the_file_of_the_vehicle_is_wrong(drives, road, car, calibration):
    """Within a tenth or two of a file of another car: three of the effects that are found where its inertias and bars are calibrated, and a force at
    the tyre; with these put right, or told beside them. What comes first is a matter of rounding: as well four or five of those effects (the
    recession of its wheels may not be among them), where it is told that the second search was made; or three of them and those parameters, as good; or
    two that are sure of six that were found, those parameters, and no force, or one at the contact of the tyre that removes less than the six do."""
    _, verdict, proposal = diagnose({"realcar": (road, drives)}, car, calibration=calibration, bounds=BOUNDS)
    other = verdict.beyond_bounds
    beyond = {one.parameter: one.value for one in (*other.parameters, *other.less_sure)} if other else {}
    if proposal is not None and proposal.place in ("", "contact"):
        assert verdict.verdict == "outside" and "That is less than half" in verdict.words() and verdict.remainder["yaw_rate"] > 0.9
        assert {effect.name for effect in verdict.effects} == {"damper_asymmetry", "wheel_recession"}
        assert "damper_knee is not named for that: it may make good what another shape of damper_asymmetry, wheel_recession would do" in verdict.words()
        of_all = verdict.whole()  # with the four that have no name
        assert of_all.share > 0.45 and of_all.held_out_share > 0.55 and verdict.share > 0.2 and verdict.held_out_share > 0.3
        assert f"{100 * of_all.share:.0f} % and {100 * of_all.held_out_share:.0f} % with damper_knee, " in verdict.words()
        assert beyond["anti_roll_stiffness_rear"] > 2 * car["anti_roll_stiffness_rear"] and min(other.share, other.held_out_share) > 0.1
        if proposal.place:
            assert proposal.share < of_all.share - 0.05 and proposal.held_out_share < of_all.held_out_share - 0.05
            assert beyond["cornering_stiffness"] < 0.5 * car["cornering_stiffness"] and not other.less_sure
        else:
            assert beyond["roll_inertia"] < 0.8 * car["roll_inertia"]
        return
    if proposal is not None:
        assert verdict.verdict == "outside" and proposal.place == "tyre" and verdict.remainder["yaw_rate"] > 0.9
        assert [effect.name for effect in verdict.effects][:3] == ["damper_asymmetry", "damper_knee", "wheel_recession"]
        assert min(verdict.share, verdict.held_out_share) > 0.4
        if "lie within them beside the form" in verdict.words():
            assert len(verdict.effects) == 3 and min(proposal.share, proposal.held_out_share) > 0.5
            assert max(left for name, left in verdict.remainder.items() if name != "yaw_rate") < 0.15
            return
        assert {effect.name for effect in verdict.effects[3:]} <= {"suspension_friction"} and "That is less than half" in verdict.words()
        assert beyond["roll_inertia"] < 0.8 * car["roll_inertia"] and beyond["anti_roll_stiffness_rear"] > 2 * car["anti_roll_stiffness_rear"]
        assert min(proposal.share, proposal.held_out_share) > 0.4 and min(other.share, other.held_out_share) > 0.1
        return
    assert verdict.share > 0.4 and verdict.held_out_share > 0.5
    assert verdict.verdict == ("named" if verdict.share > 0.5 else "outside")
    assert verdict.effects[0].name == "damper_asymmetry"
    names = {"damper_asymmetry", "damper_knee", "wheel_recession", "roll_centre_height", "bump_steer"}
    found = {effect.name for effect in verdict.effects}
    assert found in (names, names - {"wheel_recession"})
    if other is None:
        assert "Parameters of the vehicle beyond their bounds were tried, too: they are no better explanation" in verdict.words()
        if found == names:
            assert "tyre_radial_damping" in [one.parameter for one in verdict.at_bounds] and verdict.remainder["yaw_rate"] > 0.9
        else:
            assert "That is less than half" in verdict.words() and verdict.remainder["yaw_rate"] > 0.5
        return
    assert other.is_instead and set(other.effects) == {"damper_asymmetry", "damper_knee", "wheel_recession"}
    assert beyond["roll_inertia"] < 0.8 * car["roll_inertia"] and beyond["anti_roll_stiffness_rear"] > 2 * car["anti_roll_stiffness_rear"]
    assert min(other.share, other.held_out_share) > 0.5


@pytest.mark.long
def test_within_the_bounds_of_the_papers_car_the_verdict_says_that_its_tyres_damp_less(drives, road, car):
    """Published tyres damp by 0 to 2000 N s/m, which tab:constraints (4000 to 7000) leaves out."""
    bounds = BOUNDS | {"tyre_radial_stiffness": (250000.0, 400000.0), "tyre_radial_damping": (4000.0, 7000.0)}
    _, verdict, _ = diagnose({"realcar": (road, drives)}, car, bounds=bounds, among=["damper_asymmetry", "top_mount"])
    told = {one.parameter: one for one in verdict.beyond_bounds.parameters}
    assert verdict.verdict == "outside" and told["tyre_radial_damping"].value < 1000.0
    assert min(verdict.beyond_bounds.share, verdict.beyond_bounds.held_out_share) > 0.3
