"""From stand-in scans, whose road is known, back to the road. ASAM's library compares the two in x and y."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pycrg
import pytest
import xarray as xr

from ridecomfort.errors import InputError
from ridecomfort.road import clean, crg, smoothing, surface, survey
from ridecomfort.standin.scan import Scanner, profiles, trajectory

SCANNER = Scanner(points=200, noise=1e-4, leaves=1, gaps_per_km=0.0)
"""A scanner with fewer points than the paper's, so that tests are fast."""


def patch_of_road(length=60.0) -> xr.Dataset:
    """A bend of 100 m radius, banked 4 %, climbing 7 %, with waves of 2.5 mm and 3 m length and a pothole."""
    u, v = np.arange(round(length / 0.1) + 1) * 0.1, np.linspace(-2.5, 2.5, 51)
    heading = 0.4 + u / 100
    pit = np.hypot(u[:, None] - 30, v - 0.75) / 0.5
    relief = 0.0025 * np.sin(2 * np.pi * u / 3)[:, None] * np.cos(v)
    relief = relief - 0.03 * np.where(pit < 1, np.cos(np.minimum(pit, 1) * np.pi / 2) ** 2, 0)
    line = {"x": np.cumsum(0.1 * np.cos(heading)), "y": np.cumsum(0.1 * np.sin(heading)), "heading": heading}
    line |= {"curvature": np.full(u.size, 0.01), "slope": np.full(u.size, 0.07), "bank": np.full(u.size, -0.04)}
    return xr.Dataset(
        {"elevation": (("u", "v"), relief + 0.07 * u[:, None] - 0.04 * v)}
        | {name: ("u", values) for name, values in line.items()},
        coords={"u": u, "v": v},
    )


@pytest.fixture(scope="module")
def road() -> xr.Dataset:
    return patch_of_road()


@pytest.fixture(scope="module")
def scanned(road):
    true, measured = trajectory(road, 5, SCANNER)
    return survey.grid(profiles(road, true, 5, SCANNER), measured)


def against(road, found, folder, v):
    """Height of the found road above the true one at the same x and y, along the lines v of the found one."""
    crg.write(folder / "found.crg", found)
    crg.write(folder / "true.crg", road)
    with pycrg.RoadSurface.open(folder / "found.crg") as ours, pycrg.RoadSurface.open(folder / "true.crg") as truth:
        u = np.arange(2.0, float(found.u[-1]) - 2.0, 0.1)
        x, y = ours.uv_to_xy_many(u[:, None], v)
        return u, ours.uv_to_z_many(u[:, None], v) - truth.xy_to_z_many(x, y)


def test_the_road_comes_back_to_a_few_tenths_of_a_millimetre(road, scanned, tmp_path):
    found, _ = clean.clean(scanned[0], outliers="repair", holes="fill")
    u, error = against(road, found, tmp_path, np.array([-1.5, -0.75, 0.0, 0.75, 1.5]))
    drift = smoothing.smooth(error.mean(axis=1, keepdims=True), 0.1, 20.0)
    assert np.sqrt(((error - drift) ** 2).mean()) < 3e-4
    assert np.abs(drift).max() < 3 * SCANNER.position_drift


@pytest.mark.parametrize("grade", [-0.06, 0.08])
def test_a_plane_on_a_grade_is_even_where_profiles_are_sparse(grade):
    """At 200 profiles a second and 18 m/s there is one in most cells of 0.1 m, rarely at the middle."""
    u, v = np.arange(601) * 0.1, np.linspace(-2.5, 2.5, 51)
    line = {"x": u, "y": 0 * u, "heading": 0 * u, "curvature": 0 * u, "slope": 0 * u + grade, "bank": 0 * u}
    plane = xr.Dataset(
        {"elevation": (("u", "v"), grade * u[:, None] + 0 * v)} | {name: ("u", values) for name, values in line.items()},
        coords={"u": u, "v": v},
    )
    perfect = {"noise": 0.0, "position_noise": 0.0, "position_drift": 0.0, "attitude_noise": 0.0, "outlier_share": 0.0}
    scanner = replace(SCANNER, rate=200.0, speed=18.0, leaves=0, **perfect)
    true, measured = trajectory(plane, 3, scanner)
    found, _ = survey.grid(profiles(plane, true, 3, scanner), measured)
    step = np.diff(found.elevation.values, axis=0)[20:-20]
    assert np.nanmax(np.abs(step - grade * 0.1)) < 2e-4


def test_the_pothole_keeps_its_depth(road, scanned):
    found, _ = clean.clean(scanned[0], outliers="repair", holes="fill")
    heights = found.elevation - (0.07 * found.u - 0.04 * found.v)
    near = heights.sel(u=slice(25, 31), v=slice(0.3, 1.2))
    rim = heights.sel(u=slice(25, 31), v=slice(-1.2, -0.3))
    assert float(rim.median() - near.min()) == pytest.approx(0.03, abs=0.004)


EDGE = 0.04
"""m over which the sides of a steep pothole fall: as short as the grid of 0.02 m that it is planted on can hold."""


def potholes(seed, shape, diameter, length=32.0):
    """A flat road on a grid of 0.02 m with potholes 13 to 50 mm deep (ASTM D6433), anywhere within the 0.1 m cells.

    Returns the road and middle (u, v) and depth of every pothole.
    """
    rng = np.random.default_rng(seed)
    u, v = np.arange(round(length / 0.02) + 1) * 0.02, np.arange(-125, 126) * 0.02
    relief, holes = np.zeros((u.size, v.size)), []
    for middle in np.arange(4.0, length - 4.0, 1.0):
        at, depth = (middle + rng.uniform(-0.05, 0.05), rng.uniform(-1.2, 1.2)), rng.uniform(0.013, 0.05)
        r = np.hypot(u[:, None] - at[0], v - at[1])
        if shape == "bowl":
            inner = np.minimum(2 * r / diameter, 1)
        else:
            inner = np.clip((r - diameter / 2) / EDGE + 0.5, 0, 1)
        relief -= depth * np.cos(inner * np.pi / 2) ** 2
        holes.append((*at, depth))
    line = {"x": u, "y": 0 * u, "heading": 0 * u, "curvature": 0 * u, "slope": 0 * u, "bank": 0 * u}
    elevation = relief + rng.normal(0, 1e-4, relief.shape)
    line = {name: ("u", values) for name, values in line.items()}
    return xr.Dataset({"elevation": (("u", "v"), elevation)} | line, coords={"u": u, "v": v}), holes


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    "shape, diameter, speed, least",
    [
        ("bowl", 0.15, 20.0, 0.95),
        ("bowl", 0.2, 20.0, 0.98),
        ("bowl", 0.3, 20.0, 0.98),
        ("bowl", 0.5, 20.0, 0.98),
        ("steep", 0.3, 20.0, 0.98),
        ("bowl", 0.3, 33.0, 0.95),
    ],
)
def test_potholes_of_a_scan_keep_98_percent_of_their_depth_and_are_no_outliers(shape, diameter, speed, least, seed):
    """At the nodes of the grid. Between them a narrow bowl is deeper; no grid of that spacing can hold it.

    From 20 m/s there are four profiles in a cell, from 33 m/s only two or three.
    """
    fine, holes = potholes(seed, shape, diameter)
    scanner = Scanner(leaves=0, gaps_per_km=0.0, position_drift=0.0, speed=speed)
    true, measured = trajectory(fine, seed, scanner)
    found, _ = survey.grid(profiles(fine, true, seed, scanner), measured)
    cleaned, _ = clean.clean(found, outliers="repair", holes="fill")
    x = found.x.values[:, None] - found.v.values * np.sin(found.heading.values)[:, None]
    y = found.y.values[:, None] + found.v.values * np.cos(found.heading.values)[:, None]
    known = surface.height(fine, x, y, interpolation="cubic")
    heights = found.elevation.values - np.nanmedian(found.elevation.values - known)
    kept = []
    for u, v, _ in holes:
        near = np.hypot(x - u, y - v) < max(diameter / 2 - EDGE, 0.08)
        np.testing.assert_array_equal(cleaned.elevation.values[near], found.elevation.values[near])
        deep = near & (known < 0.9 * known[near].min())
        kept.append(heights[deep].mean() / known[deep].mean())
    assert least < np.median(kept) < 1.02 and np.min(kept) > 0.8


def test_the_reference_line_is_the_path_in_equal_steps(road, scanned):
    found = scanned[0]
    step = np.hypot(np.diff(found.x), np.diff(found.y))
    np.testing.assert_allclose(step, 0.1, atol=1e-5)
    np.testing.assert_allclose(np.diff(found.u), 0.1, atol=1e-9)
    assert float(found.curvature[50:-50].mean()) == pytest.approx(0.01, rel=0.05)
    assert float(found.slope.mean()) == pytest.approx(0.07, abs=0.002)
    assert float(found.bank.mean()) == pytest.approx(-0.04, abs=0.004)


@pytest.mark.parametrize("seed", range(4))
def test_planted_outliers_are_dropped(road, seed):
    clear = replace(SCANNER, points=400, leaves=0, dropout_share=0.0, outlier_share=0.0)
    dirty = replace(clear, outlier_share=1e-3)
    true, measured = trajectory(road, seed, clear)
    clean_blocks, dirty_blocks = (list(profiles(road, true, seed, scanner)) for scanner in (clear, dirty))
    without = survey.grid(iter(clean_blocks), measured)[1]
    planted = sum((np.abs(b.height - a.height) > 0.004).sum() for a, b in zip(clean_blocks, dirty_blocks))
    found = survey.grid(iter(dirty_blocks), measured)[1]
    share_in_grid = 1 - found.beside / found.points
    assert without.outliers < 1e-5 * without.points
    assert found.outliers - without.outliers >= 0.99 * planted * share_in_grid


def test_blocks_do_not_matter(road):
    true, measured = trajectory(road, 5, SCANNER)
    whole, _ = survey.grid(profiles(road, true, 5, SCANNER, block=100_000), measured)
    streamed, _ = survey.grid(profiles(road, true, 5, SCANNER, block=333), measured)
    np.testing.assert_allclose(streamed.elevation, whole.elevation, atol=1e-12)


def test_lost_profiles_leave_holes_that_cleaning_fills(road):
    true, measured = trajectory(road, 5, SCANNER)

    def torn():
        for block in profiles(road, true, 5, SCANNER):
            gone = (block.time > 1.0) & (block.time < 1.02)
            yield block._replace(height=np.where(gone[:, None], np.nan, block.height))

    found, report = survey.grid(torn(), measured)
    assert report.empty_cells > 100
    filled, _ = clean.clean(found, outliers="repair", holes="fill")
    assert int(filled.elevation.sel(v=slice(-1.5, 1.5)).isnull().sum()) == 0


def test_a_scanner_that_stands_still_adds_nothing(road):
    true, measured = trajectory(road, 5, SCANNER)
    first = next(profiles(road, true, 5, SCANNER, block=100))
    still = measured.copy(deep=True)
    for name in survey.POSE:
        still[name][:] = measured[name].values[0]
    still["x"] = still.x + np.where(np.arange(still.time.size) > 200, np.arange(still.time.size) - 200, 0) * 0.1
    report = survey.grid(iter([first, first._replace(time=first.time + 0.2)]), still)[1]
    assert report.profiles == 200 and report.points <= 2 * SCANNER.points


def test_equal_seeds_make_equal_scans(road):
    true, _ = trajectory(road, 5, SCANNER)
    one, two = (np.concatenate([b.height for b in profiles(road, true, 5, SCANNER, block=n)]) for n in (500, 731))
    np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize(
    "spoil, message",
    [
        (lambda t: t.isel(time=slice(None, None, -1)), "trajectory.time: expected at least 10 equal steps forward"),
        (lambda t: t.assign(z=t.z.where(t.time != t.time[7])), "trajectory.z: nan at 0.035 s"),
        (lambda t: t.isel(time=slice(0, 50)), "trajectory"),
        (lambda t: t.assign(x=t.x + 5.0 * (t.time > 1)), r"trajectory.x: leaps by 5\.\d* m at 1\.\d+ s \(1 such place"),
        (lambda t: t.assign(z=t.z - 0.5 * (t.time > 1)), r"trajectory.z: leaps by -0\.\d+ m at 1\.\d+ s"),
        (lambda t: t.assign(roll=np.degrees(t["roll"])), "trajectory.roll: .* rad at .*degrees"),
        (lambda t: t.assign(pitch=np.degrees(t["pitch"])), "trajectory.pitch: .* rad at .*degrees"),
        (lambda t: t.assign(heading=t.heading + 1.0), "trajectory.heading: .* degrees off .*azimuth"),
    ],
)
def test_unusable_trajectories_are_refused(road, spoil, message):
    true, measured = trajectory(road, 5, SCANNER)
    with pytest.raises(InputError, match=message):
        survey.grid(profiles(road, true, 5, SCANNER), spoil(measured))


@pytest.fixture(scope="module")
def recorded(road):
    """A scan in one block, and the trajectory that was measured."""
    true, measured = trajectory(road, 5, SCANNER)
    return list(profiles(road, true, 5, SCANNER, block=10_000)), measured


@pytest.mark.parametrize(
    "spoil, message",
    [
        (lambda b: b._replace(time=b.time[::-1]), "profiles.time: .* after .*, expected times that rise"),
        (lambda b: b._replace(time=np.where(b.time > 1, np.nan, b.time)), "profiles.time: nan"),
        (lambda b: b._replace(time=b.time + 100), "profiles.time: from 100 .* trajectory from 0"),
        (lambda b: b._replace(across=b.across * np.nan), "profiles.across: not a number"),
        (lambda b: b._replace(height=-b.height), r"profiles.height: \S+ m on the whole from .*, expected the road below"),
        (lambda b: b._replace(height=b.height * np.nan), "no point lies within the grid"),
        (lambda b: b._replace(time=b.time[:2], height=b.height[:2]), "profiles: 2 profiles reach over . cross sections"),
    ],
)
def test_unusable_profiles_are_refused(recorded, spoil, message):
    blocks, measured = recorded
    with pytest.raises(InputError, match=message):
        survey.grid((spoil(block) for block in blocks), measured)


def test_profiles_out_of_order_are_refused_across_blocks_too(road):
    true, measured = trajectory(road, 5, SCANNER)
    blocks = list(profiles(road, true, 5, SCANNER))
    with pytest.raises(InputError, match="profiles.time: 0 s after .* expected times that rise"):
        survey.grid(iter([blocks[1], blocks[0]]), measured)
