"""OpenCRG files: what is read and what is written. ASAM's own library is the judge."""

from __future__ import annotations

import re

import numpy as np
import pycrg
import pytest

from ridecomfort.errors import InputError
from ridecomfort.road import crg, surface, wheeltracks

from tests.road.crg_files import small

READABLE = (
    "Barber", "belgian_block", "detrended_rms_course_1in", "handmade_arc", "handmade_banked", "handmade_circle",
    "handmade_curved", "handmade_curved_banked_sloped", "handmade_curved_minimalist", "handmade_platform",
    "handmade_sloped", "handmade_sloped_opts", "handmade_straight", "handmade_straight_NaN",
    "handmade_straight_double", "handmade_straight_minimalist", "handmade_vtest",
)  # fmt: skip


def same_reference_line(road, u, asam):
    """Assert that the reference line at u is ASAM's, also beyond its ends."""
    line, grid, spacing = surface.reference_line(road, u), asam.grid(), float(road.u[1] - road.u[0])
    x, y = asam.uv_to_xy_many(u, 0.0)
    np.testing.assert_allclose(line.x, x, rtol=0, atol=1e-6)
    np.testing.assert_allclose(line.y, y, rtol=0, atol=1e-6)
    heading, curvature = asam.uv_to_pk_many(u, 0.0)
    # Within 0.5 m of the ends ASAM's library has the heading of the end and no curvature.
    reach = spacing * max(1, int(0.5 / spacing * (1 + 1e-9)))
    if "closed_from" in road.attrs:
        u = road.closed_from + np.mod(u - road.closed_from, road.closed_to - road.closed_from)
    inner = (u > grid.u[0] + reach) & (u < grid.u[-1] - reach)
    turn = np.angle(np.exp(1j * (line.heading.values - heading)))
    outer = (u < grid.u[0]) | (u > grid.u[-1] + reach)
    np.testing.assert_allclose(turn[inner | outer], 0.0, atol=1e-9)
    np.testing.assert_allclose(line.curvature[inner], curvature[inner], rtol=0, atol=1e-9)
    assert inner.any() and (line.curvature.values[outer] == 0.0).all()
    inside = (u > grid.u[0]) & (u < grid.u[-1])
    segment = np.searchsorted(grid.u, u[inside]) - 1
    np.testing.assert_allclose(line.slope[inside], (np.diff(grid.ref_z) / spacing)[segment], rtol=0, atol=1e-9)
    np.testing.assert_allclose(line.bank[inside], np.interp(u[inside], grid.u, grid.bank), rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", READABLE)
def test_every_sample_agrees_with_asams_library(shared, name):
    path = shared / "data" / "opencrg" / f"{name}.crg"
    road = crg.read(path)
    rng = np.random.default_rng(0)
    u = rng.uniform(road.u[0] - 3, road.u[-1] + 3, 5000)
    v = rng.uniform(road.v[0] - 1, road.v[-1] + 1, 5000)
    with pycrg.RoadSurface.open(path) as asam:
        np.testing.assert_allclose(surface.height(road, u, v), asam.uv_to_z_many(u, v), rtol=0, atol=1e-6)
        same_reference_line(road, u, asam)


@pytest.mark.parametrize("name", ["fileref", "fileref_mods", "fileref_opts"])
def test_file_references_are_followed_from_the_file_that_names_them(shared, tmp_path, name):
    samples = shared / "data" / "opencrg"
    (tmp_path / "crg-txt").mkdir()
    (tmp_path / "site").mkdir()
    target = "handmade_curved_banked_sloped.crg"
    (tmp_path / "crg-txt" / target).write_bytes((samples / target).read_bytes())
    path = tmp_path / "site" / f"{name}.crg"
    path.write_bytes((samples / f"{name}.crg").read_bytes())
    road = crg.read(path)
    u, v = np.meshgrid(np.linspace(0, 22, 50), np.linspace(-1.5, 1.5, 30), indexing="ij")
    with pycrg.RoadSurface.open(path) as asam:
        np.testing.assert_allclose(surface.height(road, u, v), asam.uv_to_z_many(u, v), rtol=0, atol=1e-6)
        same_reference_line(road, np.random.default_rng(0).uniform(-5, 30, 2000), asam)
    assert f"read from {target} by way of {name}.crg" in road.treatment


def random_file(path, rng, even=False):
    """A file with random grid, reference line, options and modifiers, in a random format.

    A third has long sections at uneven positions.
    """
    nu, nv = rng.integers(8, 60), rng.integers(3, 12)
    z = rng.normal(0, 0.05, (nu, nv))
    if rng.random() < 0.6:
        for row in z:
            row[: rng.integers(0, nv // 2)] = np.nan
            row[nv - rng.integers(0, nv // 2) :] = np.nan

    def some(**candidates):
        return {key: value for key, value in candidates.items() if rng.random() < 0.5}

    options = some(
        border_mode_u=int(rng.integers(0, 5)), border_mode_v=int(rng.integers(0, 5)), border_offset_u=0.3,
        border_offset_v=0.2, border_smooth_ubeg=rng.choice([0.7, 5.0]), border_smooth_uend=rng.choice([0.4, 5.0]),
    )  # fmt: skip
    modifiers = some(
        grid_nan_mode=int(rng.integers(0, 3)), scale_z_grid=2.0, scale_slope=0.5, scale_banking=0.5,
        scale_length=1.5, scale_width=0.5, scale_curvature=0.5,
    )  # fmt: skip
    even = even or rng.random() < 0.6
    v = np.linspace(-2, 2, nv) if even else 0.1 * np.sort(rng.choice(np.arange(-20, 21), nv, replace=False))
    if even and rng.random() < 0.5:  # at uneven positions the reference point may have no height that could be moved
        modifiers |= dict(refpoint_u=0.6, refpoint_v=0.0, refpoint_x=5.0, refpoint_y=1.0, refpoint_z=0.4, refpoint_phi=2.0)
    else:
        modifiers |= some(
            refline_rotcenter_x=20.0, refline_rotcenter_y=-3.0, refline_offset_phi=-2.5, refline_offset_x=40.0,
            refline_offset_y=30.0, refline_offset_z=-5.0,
        )  # fmt: skip
    pycrg.write(
        path, z, 0.25, v, np.cumsum(rng.normal(0, 0.002, nu)), u0=rng.choice([0.0, 100.0]),
        x0=10.0, y0=5.0, z0=2.0, slope=rng.normal(0, 0.05, nu), banking=rng.normal(0, 0.03, nu),
        fmt=rng.choice(crg.FORMATS), opts=rng.choice([None, options]), mods=rng.choice([None, {}, modifiers]),
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(40))
def test_random_files_agree_with_asams_library_inside_and_beyond_the_grid(tmp_path, seed):
    rng = np.random.default_rng(seed)
    path = tmp_path / "road.crg"
    random_file(path, rng)
    road = crg.read(path)
    u = rng.uniform(-1, 2, 2000) * float(road.u[-1] - road.u[0]) + float(road.u[0])
    v = rng.uniform(-1, 2, 2000) * float(road.v[-1] - road.v[0]) + float(road.v[0])
    with pycrg.RoadSurface.open(path) as asam:
        np.testing.assert_allclose(surface.height(road, u, v), asam.uv_to_z_many(u, v), rtol=0, atol=1e-6)
        same_reference_line(road, u, asam)


@pytest.mark.parametrize("mode_v", [1, 2])
@pytest.mark.parametrize("mode_u", range(5))
def test_slope_and_bank_are_those_of_asams_heights_also_beyond_the_ends(tmp_path, mode_u, mode_v):
    """On a road that is smooth but for its reference line they are the differences of its heights."""
    rng = np.random.default_rng(mode_u)
    path = tmp_path / "road.crg"
    small(
        path, z=np.zeros((30, 5)), phi=np.cumsum(rng.normal(0, 0.002, 30)), slope=rng.normal(0, 0.05, 30),
        banking=rng.normal(0, 0.03, 30), z0=2.0, opts={"border_mode_u": mode_u, "border_mode_v": mode_v},
    )  # fmt: skip
    u, step = rng.uniform(-10, 13, 2000), 1e-4
    to_node = np.abs((u + 0.05) % 0.1 - 0.05)
    u = u[to_node > 2 * step]
    line = surface.reference_line(crg.read(path), u)
    with pycrg.RoadSurface.open(path) as asam:
        ahead, behind, left, right = (
            asam.uv_to_z_many(u + du, dv) for du, dv in ((step, 0), (-step, 0), (0, 1), (0, -1))
        )
    np.testing.assert_allclose(line.slope, (ahead - behind) / (2 * step), rtol=0, atol=1e-7)
    np.testing.assert_allclose(line.bank, (left - right) / 2, rtol=0, atol=1e-7)
    beyond = (u < 0) | (u > 2.9)
    assert np.isnan(line.slope[beyond]).all() == np.isnan(line.bank[beyond]).all() == (mode_u == 0)


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_a_closed_track_goes_round(shared, interpolation):
    road = crg.read(shared / "data" / "opencrg" / "Barber.crg", interpolation=interpolation)
    length = road.closed_to - road.closed_from
    u = np.random.default_rng(0).uniform(road.u[0] + 1, road.u[-1] - 1, 500)
    line = surface.reference_line(road, u)
    for rounds in (-2, -1, 1, 3):
        again = surface.reference_line(road, u + rounds * length)
        for name in surface.LINE:
            np.testing.assert_allclose(again[name], line[name], rtol=0, atol=1e-6 if name in "xy" else 1e-3)


@pytest.mark.parametrize("mode", range(5))
@pytest.mark.parametrize("named", [False, True])
def test_bank_beyond_the_borders_is_that_of_asams_library(tmp_path, mode, named):
    """It depends on whether the file names the positions of its long sections, also where these are even."""
    rng = np.random.default_rng(mode)
    path, v = tmp_path / "road.crg", np.linspace(-1, 2, 5)
    small(path, v=v, fmt="LDFI", banking=rng.normal(0, 0.03, 30), opts={"border_mode_v": mode, "border_offset_v": 0.2})
    if named:
        text = path.read_text()
        for k, at in enumerate(v, start=1):
            text = text.replace(f"long section {k},", f"long section at v = {at},")
        path.write_text(re.sub("long_section_v_increment.*\n", "", text))
    u, v = rng.uniform(0, 2.9, 2000), rng.uniform(-7, 8, 2000)
    with pycrg.RoadSurface.open(path) as asam:
        np.testing.assert_allclose(surface.height(crg.read(path), u, v), asam.uv_to_z_many(u, v), rtol=0, atol=1e-6)


@pytest.mark.parametrize("format", crg.FORMATS)
def test_a_climb_of_140_m_survives_writing(tmp_path, alpine, format):
    alpine = alpine.isel(u=slice(0, 20001 if format == "KRBI" else 3001))
    path = tmp_path / "road.crg"
    crg.write(path, alpine, format=format)
    again = crg.read(path)
    np.testing.assert_allclose(again.elevation, alpine.elevation, rtol=0, atol=6e-5)
    for name, tolerance in {"x": 1e-3, "y": 1e-3, "heading": 1e-6, "slope": 1e-7, "bank": 1e-7}.items():
        np.testing.assert_allclose(again[name][1:-1], alpine[name][1:-1], rtol=0, atol=tolerance)
    with pycrg.RoadSurface.open(path) as asam:
        u, v = np.meshgrid(alpine.u[::37], alpine.v, indexing="ij")
        heights = alpine.elevation.values[::37]
        known = np.isfinite(heights)
        np.testing.assert_allclose(asam.uv_to_z_many(u, v)[known], heights[known], rtol=0, atol=6e-5)


@pytest.mark.parametrize("seed", range(20))
def test_a_road_that_was_read_and_written_is_the_same_road_beyond_its_borders_too(tmp_path, seed):
    rng = np.random.default_rng(seed)
    random_file(tmp_path / "road.crg", rng, even=True)
    road = crg.read(tmp_path / "road.crg")
    crg.write(tmp_path / "again.crg", road, format="KDBI")
    again = crg.read(tmp_path / "again.crg")
    u = rng.uniform(-1, 2, 2000) * float(road.u[-1] - road.u[0]) + float(road.u[0])
    v = rng.uniform(-1, 2, 2000) * float(road.v[-1] - road.v[0]) + float(road.v[0])
    inside = (u > float(road.u[0]) + 1e-6) & (u < float(road.u[-1]) - 1e-6)
    np.testing.assert_allclose(surface.height(again, u, v)[inside], surface.height(road, u, v)[inside], atol=6e-5)
    beyond = surface.height(again, u, v)[~inside], surface.height(road, u, v)[~inside]
    np.testing.assert_allclose(*beyond, atol=1e-4)


def test_a_straight_road_is_written_straight(tmp_path, alpine):
    alpine["x"], alpine["y"] = alpine.u, 0.0 * alpine.u
    crg.write(tmp_path / "road.crg", alpine)
    again = crg.read(tmp_path / "road.crg")
    assert (again.heading == 0.0).all() and (again.y == 0.0).all()


def test_a_road_that_holds_its_heights_across_before_along_is_written_like_any_other(tmp_path, alpine):
    crg.write(tmp_path / "road.crg", alpine)
    crg.write(tmp_path / "turned.crg", alpine.transpose("v", "u"))
    assert (tmp_path / "turned.crg").read_bytes() == (tmp_path / "road.crg").read_bytes()


def test_writing_leaves_nothing_behind_when_it_fails(tmp_path, alpine):
    alpine.elevation[10, 20] = np.nan
    with pytest.raises(InputError, match="between valid"):
        crg.write(tmp_path / "road.crg", alpine)
    assert list(tmp_path.iterdir()) == []


def test_placement_is_a_choice_and_is_recorded(tmp_path):
    path = small(tmp_path / "road.crg", mods=None, x0=100.0, y0=50.0, z0=300.0, phi=1.0)
    moved = crg.read(path)
    assert (float(moved.x[0]), float(moved.y[0]), float(moved.heading[0])) == (0.0, 0.0, 0.0)
    assert "no modifier block in the file" in moved.treatment and "origin" in moved.treatment
    stored = crg.read(path, modifiers="explicit")
    assert (float(stored.x[0]), float(stored.y[0]), float(stored.heading[0])) == (100.0, 50.0, 1.0)
    assert float(stored.elevation.mean()) == pytest.approx(300.0, abs=0.01)
    assert "as stored" in stored.treatment


def test_modifiers_of_the_file_can_be_ignored(tmp_path):
    path = small(tmp_path / "road.crg", mods={"scale_z_grid": 3.0})
    ratio = crg.read(path).elevation / crg.read(path, modifiers="ignore").elevation
    np.testing.assert_allclose(ratio, 3.0, rtol=1e-6)


def test_edges_without_heights_stay_empty_and_kernels_get_the_nearest_height(shared):
    road = crg.read(shared / "data" / "opencrg" / "belgian_block.crg")
    assert int(road.elevation.isnull().sum()) == 22228
    elevation, u0, du, v0, dv = surface.grid(road)
    assert np.isfinite(elevation).all() and elevation.flags.c_contiguous
    assert (u0, du, v0, dv) == pytest.approx((730.0, 0.01, -1.7, 0.01))
    assert "outside the edges" in road.treatment


def test_any_number_of_equidistant_long_sections_is_an_equidistant_grid(tmp_path):
    v = np.linspace(-3, 3, 1201)
    road = crg.read(small(tmp_path / "road.crg", z=np.zeros((30, v.size)), v=v))
    np.testing.assert_allclose(road.v, v)
    assert "resampled" not in road.treatment


def test_smoothing_zones_are_those_of_asams_library_in_what_a_vehicle_drives_on_and_the_iri_sees(tmp_path):
    z = 5.0 + np.random.default_rng(3).normal(0, 0.01, (301, 5))
    path = small(tmp_path / "road.crg", z=z, du=1.0, opts={"border_smooth_ubeg": 100.0, "border_smooth_uend": 50.0})
    road = crg.read(path)
    elevation, *_ = surface.grid(road)
    with pycrg.RoadSurface.open(path) as asam:
        expected = asam.uv_to_z_many(road.u.values[:, None], road.v.values)
    assert float(expected[10, 2]) == pytest.approx(0.5, abs=0.01) and float(expected[150, 2]) == pytest.approx(5.0, abs=0.05)
    np.testing.assert_allclose(elevation, expected, atol=1e-9)
    np.testing.assert_allclose(wheeltracks.tracks(road, [-1.0, 0.5]), [expected[:, 1], 0.5 * (expected[:, 2] + expected[:, 3])], atol=1e-9)


def test_long_sections_at_uneven_positions_become_an_equidistant_grid(tmp_path):
    at = np.array([-2.0, -0.5, 0.0, 1.0, 2.0])
    path = small(tmp_path / "road.crg", v=at)
    road = crg.read(path)
    np.testing.assert_allclose(road.v, np.linspace(-2, 2, 9))
    assert "5 long sections resampled to 9" in road.treatment
    small(path, v=np.array([-2.0, -0.71828183, 0.0, 1.0, 2.0]))
    with pytest.raises(InputError, match="no equidistant grid"):
        crg.read(path)
    assert "not exactly" in crg.read(path, lateral_grid="resample").treatment
