"""Roads and cars that others made, brought by one site file each."""

import numpy as np
import pytest

from ridecomfort import store

pytestmark = pytest.mark.slow


def resource(shared, name):
    path = shared / "data" / name
    if not path.exists():
        pytest.skip(f"{name} is not in ../shared")
    return path


def test_a_road_of_others_needs_only_its_file(project, shared):
    course = resource(shared, "opencrg/detrended_rms_course_1in.crg")
    project.site("course", road={"file": str(course)}, speed={"limit_km_h": 30})
    answer = project.snakemake("-j2", "course", "--config", "sites=[course]", "runs=3")
    assert answer.status == 0, answer.text
    road = store.read(project.folder / "results/course/road.nc")
    comfort = store.read(project.folder / "results/course/base/comfort/iso2631.nc")
    evaluated = float(road["u"][-1] - road["u"][0]) - 75
    assert abs(comfort.sizes["window"] - evaluated / 5) < 1
    # An inch rms of unevenness is at least "uncomfortable" (ISO 2631-1, annex C: from 0.8 m/s2).
    assert float(comfort["a_v"].mean()) > 0.8


COLUMNS = {
    "time": ("time [s]", "s"),
    "s": ("distance [m]", "m"),
    "v_x": ("speed [km/h]", "km/h"),
    **{f"a_{axis}": (f"acc_{axis} [m/s2]", "m/s2") for axis in "xyz"},
    **{f"{name}_rate": (f"gyro_{axis} [rad/s]", "rad/s") for name, axis in zip(("roll", "pitch", "yaw"), "xyz")},
}


@pytest.mark.long
def test_a_car_of_others_is_calibrated_and_compared(project, shared):
    folder = resource(shared, "realcar")
    drive = {
        "columns": {name: {"column": column, "unit": unit} for name, (column, unit) in COLUMNS.items()},
        "sensor": {"behind_front_axle": 1.37, "above_wheel_centres": 0.95},
        "distance_of": "front_axle",
    }
    project.site(
        "realcar",
        road={"file": str(folder / "road.crg")},
        speed={"limit_km_h": 80},
        drives=[
            {**drive, "file": str(folder / "drive_80kmh.csv"), "lateral_position": 0.0},
            {**drive, "file": str(folder / "drive_50kmh.csv"), "lateral_position": 0.3, "role": "check"},
        ],
    )
    answer = project.snakemake("-j2", "compare", "--config", "sites=[realcar]", "calibration={restarts: 0}")
    assert answer.status == 0, answer.text
    found = store.read(project.folder / "results/realcar/base/comparison.nc")
    assert list(found["state"].values) == ["reference", "calibrated"]
    nrmse = found["nrmse"].sel(signal=["a_z", "pitch_rate"])
    assert np.isfinite(nrmse).all()
    fitted = nrmse.sel(state="calibrated").isel(drive=0) / nrmse.sel(state="reference").isel(drive=0)
    assert float(fitted.mean()) < 1
    # No drive was repeated, and it is said so; the ladder has the rungs that there are.
    assert "no drive was repeated" in found.attrs["floor"] and found.attrs["words"]
    ladder = (project.folder / "results/tables/error_ladder.csv").read_text()
    assert "realcar,fitted,calibrated" in ladder and "realcar,held out,uncalibrated" in ladder
    assert (project.folder / "results/figures/located_realcar.png").stat().st_size > 10_000
    again = project.snakemake("--dry-run", "compare", "--config", "sites=[realcar]", "calibration={restarts: 0}")
    assert "Nothing to be done" in again.text
