"""OpenCRG files: what is read, what is written, what is refused. ASAM's own library is the judge."""

from __future__ import annotations

import re

import numpy as np
import pycrg
import pytest

from ridecomfort.errors import InputError
from ridecomfort.road import crg, surface

READABLE = (
    "Barber", "belgian_block", "detrended_rms_course_1in", "handmade_arc", "handmade_banked", "handmade_circle",
    "handmade_curved", "handmade_curved_banked_sloped", "handmade_curved_minimalist", "handmade_platform",
    "handmade_sloped", "handmade_sloped_opts", "handmade_straight", "handmade_straight_NaN",
    "handmade_straight_double", "handmade_straight_minimalist", "handmade_vtest",
)  # fmt: skip


def small(path, **changes):
    """A file of 30 x 5 cells, 0.1 m along and 1 m across, written by pycrg."""
    z = np.random.default_rng(3).normal(0, 0.01, (30, 5))
    arguments = {"z": z, "du": 0.1, "v": np.linspace(-2, 2, 5), "mods": {}} | changes
    pycrg.write(path, **arguments)
    return path


def edited(source, target, *replacements):
    """A copy of a text file in which each pattern was replaced, and was there to be replaced."""
    text = source.read_text(encoding="latin-1")
    for pattern, new in replacements:
        text, count = re.subn(pattern, new, text)
        assert count, pattern
    target.write_text(text, encoding="latin-1")
    return target


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


REFUSALS = {
    "cut off inside a line": ("handmade_straight", lambda text: text[:-40], "data line 23 of 23"),
    "a line short": ("handmade_straight", lambda text: text[: text.rstrip().rfind("\n") + 1], "reference_line_end_u"),
    "without a last line end": ("handmade_straight", lambda text: text.rstrip(), "end of the last line missing"),
    "one line more": ("handmade_straight", lambda text: text + text.splitlines()[-1] + "\n", "reference_line_end_u"),
    "longer in the header": (
        "handmade_straight", lambda text: text.replace("END_U     = 22.0", "END_U     = 30.0"), "makes 31",
    ),
    "wider in the header": (
        "handmade_straight", lambda text: text.replace("V_LEFT      = 1.50", "V_LEFT      = 2.50"), "2.5 m, but",
    ),
    "finer in the header": (
        "handmade_straight", lambda text: text.replace("V_INCREMENT = 0.50", "V_INCREMENT = 0.25"), "long_section_v",
    ),
    "a channel too few": (
        "handmade_sloped", lambda text: text.replace("D:long section at v = -1.250", "* none"), "8 values, expected 7",
    ),
    "positions out of order": (
        "handmade_sloped", lambda text: text.replace("v = -1.250,m", "v =  0.100,m"), "follows v = 0.1 m",
    ),
    "a hole in the road": (
        "handmade_vtest", lambda text: " *missing*".join(text.rsplit(" 3.3333333", 1)), "holes: keep",
    ),
    "a position that is none": (
        "handmade_sloped", lambda text: text.replace("v = -1.250,m", "v = -1.2.5,m"), "expected a position",
    ),
    "a length that is none": (
        "handmade_straight", lambda text: text.replace("END_U     = 22.0", "END_U     = ab"), "expected a number",
    ),
    "an end before the start": (
        "handmade_straight", lambda text: text.replace("END_U     = 22.0", "END_U     = -3.0"), "expected more than 0 m",
    ),
    "a spacing without end": (
        "handmade_straight_minimalist", lambda text: text.replace("INCREMENT = 1.0", "INCREMENT = 1e999"), "finite number",
    ),
    "a length in words": ("handmade_curved", lambda text: text.replace("START_PHI = 0.0", "START_PHI = ab"), "'ab', expected"),
    "no spacing along": (
        "handmade_straight_minimalist", lambda text: text.replace("REFERENCE_LINE_INCREMENT = 1.0", ""), "length of the road",
    ),
    "no spacing across": (
        "handmade_straight_minimalist", lambda text: text.replace("LONG_SECTION_V_INCREMENT = 0.50", ""), "width of the road",
    ),
    "a spacing of zero": (
        "handmade_straight_minimalist", lambda text: text.replace("INCREMENT = 1.0", "INCREMENT = 0"), "positions that rise",
    ),
    "a spacing to the right": (
        "handmade_straight_minimalist", lambda text: text.replace("MENT = 0.50", "MENT = -0.5"), "long_section_v_increment: -0.5 m, expected",
    ),
    "a position that is no number": (
        "handmade_sloped", lambda text: text.replace("v = -1.250,m", "v = nan,m"), "expected a position",
    ),
    "a height that is no number": (
        "handmade_straight", lambda text: " 0.00O0000".join(text.rsplit(" 0.0000000", 1)),
        "data line 23: '0.00O0000' in columns 61 to 70",
    ),
    "an end elsewhere than the headings lead": (
        "handmade_curved",
        lambda text: text.replace("$ROAD_CRG ", "$ROAD_CRG\nREFERENCE_LINE_END_X = 20\nREFERENCE_LINE_END_Y = 9\n* "),
        "contradict its headings",
    ),
    "an end elsewhere than a straight line leads": (
        "handmade_straight",
        lambda text: text.replace("LINE_END_X     = 22.0", "LINE_END_X     = 25.0"),
        "reference_line_end_x: (25, 0) m, but the line ends at (22, 0) m",
    ),
    "a modifier in words": (
        "handmade_curved", lambda text: text.replace("$ROAD_CRG ", "$ROAD_CRG_MODS\nscale_z_grid = big\n$\n$ROAD_CRG "),
        "scale_z_grid: 'big', expected a number",
    ),
    "a decimal comma": (
        "handmade_straight", lambda text: text.replace("LINE_END_U     = 22.0", "LINE_END_U     = 22,9"),
        "reference_line_end_u: '22,9', expected a number with a decimal point",
    ),
    "a border mode that is none": (
        "handmade_sloped_opts", lambda text: text.replace("  BORDER_MODE_U = 2 ", "  BORDER_MODE_U = 5 "),
        "border_mode_u: 5, expected one of 0, 1, 2, 3, 4",
    ),
    "a modifier out of reason": (
        "handmade_curved", lambda text: text.replace("$ROAD_CRG ", "$ROAD_CRG_MODS\nscale_z_grid = 1e9\n$\n$ROAD_CRG "),
        "modifiers: take heights out of reason",
    ),
    "no OpenCRG at all": ("handmade_straight", lambda text: "nothing of the kind\n", "not an OpenCRG file"),
    "an unknown format": ("handmade_straight", lambda text: text.replace("#:LRFI", "#:XRFI"), "road.crg"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSALS)
def test_contradictions_that_the_library_lets_pass_are_refused_in_one_line(shared, tmp_path, case):
    name, change, message = REFUSALS[case]
    text = (shared / "data" / "opencrg" / f"{name}.crg").read_text(encoding="latin-1")
    path = tmp_path / "road.crg"
    path.write_text(change(text), encoding="latin-1")
    assert change(text) != text
    with pytest.raises(InputError, match=re.escape(message)) as refusal:
        crg.read(path)
    assert "\n" not in str(refusal.value) and str(path) in str(refusal.value)


def test_binary_files_that_were_cut_off_or_grew_are_refused(tmp_path):
    path = small(tmp_path / "road.crg")
    whole = path.read_bytes()
    for damaged in (whole[:-160], whole[: len(whole) * 3 // 4], whole + bytes(400)):
        path.write_bytes(damaged)
        with pytest.raises(InputError, match="road.crg"):
            crg.read(path)


@pytest.mark.parametrize("height", [None, 0.5])
@pytest.mark.parametrize("format", ["KRBI", "KDBI"])
def test_numbers_with_their_bytes_the_wrong_way_round_are_called_so(tmp_path, format, height):
    """Heights of 0.5 m would be read as 1e-43 m: level, and in no way out of reason."""
    path = small(tmp_path / "road.crg", fmt=format, **({} if height is None else {"z": np.full((30, 5), height)}))
    whole = path.read_bytes()
    start, size = whole.index(b"\n", whole.index(b"\n$$$$") + 1) + 1, int(format == "KDBI") * 4 + 4
    values = np.frombuffer(whole[start : start + 150 * size], f">f{size}")
    path.write_bytes(whole[:start] + values.byteswap().tobytes() + whole[start + 150 * size :])
    with pytest.raises(InputError, match="data: numbers stored with their last byte first"):
        crg.read(path)


@pytest.mark.parametrize("column, channel", list(enumerate(("heading", "slope", "bank"))))
def test_channels_of_the_reference_line_without_a_number_are_named_with_their_place(tmp_path, column, channel):
    values = {name: np.random.default_rng(1).normal(0, 0.01, 30) for name in ("phi", "slope", "banking")}
    path = small(tmp_path / "road.crg", fmt="KDBI", **values)
    whole = bytearray(path.read_bytes())
    at = whole.index(b"\n", whole.index(b"\n$$$$") + 1) + 1 + 8 * (12 * 8 + column)
    whole[at : at + 8] = np.array(np.nan, ">f8").tobytes()
    path.write_bytes(whole)
    with pytest.raises(InputError, match=rf"reference line, u = 1.2 m: {channel} nan.*, the first of 1 that are none"):
        crg.read(path)


def test_heights_out_of_reason_are_refused_where_they_begin(shared):
    path = shared / "data" / "opencrg" / "belgian_block_damaged.crg"
    with pytest.raises(InputError, match=r"u = 73\d\.\d+ m, v = .* heights out of reason"):
        crg.read(path)


def test_a_broken_reference_line_is_named_by_channel_and_place(shared):
    path = shared / "data" / "opencrg" / "belgian_block_damaged.crg"
    with pytest.raises(InputError, match=r"reference line, u = 731.86 m: heading 7.5\S+ rad, the first of .* no option repairs"):
        crg.read(path, heights="blank")


@pytest.mark.parametrize("height", [50.0, np.inf])
def test_a_single_wild_height_can_be_blanked_by_name(tmp_path, height):
    z = np.zeros((30, 5))
    z[12, 2] = 50.0
    path = small(tmp_path / "road.crg", z=z)
    stored = np.array(50.0, ">f4").tobytes()
    assert path.read_bytes().count(stored) == 1
    path.write_bytes(path.read_bytes().replace(stored, np.array(height, ">f4").tobytes()))
    with pytest.raises(InputError, match=f"1 heights out of reason, the first {height:g} m"):
        crg.read(path)
    with pytest.raises(InputError, match="no height inside the road"):
        crg.read(path, heights="blank")
    road = crg.read(path, heights="blank", holes="keep")
    assert int(road.elevation.isnull().sum()) == 1
    with pytest.raises(ValueError, match="holes"):
        surface.grid(road)


@pytest.mark.parametrize("mode", [0, 1, 2])
def test_a_wild_height_at_the_edge_is_blanked_with_what_the_library_drew_from_it(tmp_path, mode):
    z = np.zeros((30, 5))
    z[12, 3:] = 50.0, np.nan
    road = crg.read(small(tmp_path / "road.crg", z=z, mods={"grid_nan_mode": mode}), heights="blank")
    np.testing.assert_array_equal(road.elevation[12], [0, 0, 0, np.nan, np.nan])
    assert "1 heights out of reason, the first 50 m at u = 1.2 m, v = 1 m: blanked" in road.treatment
    assert np.nanmax(np.abs(surface.height(road, 1.2, np.linspace(-2, 2, 50)))) == 0.0


def test_unsorted_long_sections_are_refused_or_sorted(tmp_path):
    z, v = np.random.default_rng(5).normal(0, 0.01, (30, 5)), np.array([-2, -1, 0, 0.5, 2.0])
    sorted_ = crg.read(small(tmp_path / "sorted.crg", z=z, v=v, fmt="LDFI"))
    path = small(tmp_path / "road.crg", z=z[:, [0, 2, 1, 3, 4]], v=v, fmt="LDFI")
    text = path.read_text().replace("v = -1.0,", "v = x,").replace("v = 0.0,", "v = -1.0,").replace("v = x,", "v = 0.0,")
    path.write_text(text)
    with pytest.raises(InputError, match="v = -1 m follows v = 0 m.*long_sections: sort"):
        crg.read(path)
    road = crg.read(path, long_sections="sort")
    np.testing.assert_array_equal(road.elevation, sorted_.elevation)
    assert "long sections sorted" in road.treatment


def test_channels_that_are_left_out_are_named(shared, tmp_path):
    path = edited(shared / "data/opencrg/handmade_banked.crg", tmp_path / "road.crg", ("line banking", "line camber"))
    assert "left out: 'reference line camber'" in crg.read(path).treatment


def test_missing_files_and_missing_includes_are_named(shared, tmp_path):
    with pytest.raises(InputError, match="nowhere.crg: no such file"):
        crg.read(tmp_path / "nowhere.crg")
    with pytest.raises(InputError, match="handmade_sloped_opt.crg, which does not exist"):
        crg.read(shared / "data" / "opencrg" / "testOptionBorderMode.crg")
    loop = tmp_path / "loop.crg"
    loop.write_text("$ROAD_CRG_FILE\nloop.crg\n$\n")
    with pytest.raises(InputError, match="refers back"):
        crg.read(loop)


def test_a_road_that_folds_onto_itself_is_refused(tmp_path):
    heading = np.arange(30) * 0.1
    path = small(tmp_path / "road.crg", phi=heading, check=False)
    with pytest.raises(InputError, match=r"folds onto itself.*folds: keep"):
        crg.read(path)
    assert "folds onto itself" in crg.read(path, folds="keep").treatment
    small(path, phi=heading * 0.4)
    assert float(crg.read(path).curvature[15]) == pytest.approx(0.4, rel=0.01)


@pytest.mark.parametrize("options", [{"hole": "keep"}, {"holes": "fill"}])
def test_unknown_options_are_named(tmp_path, options):
    with pytest.raises(InputError, match=r"road\.hole.*expected one of"):
        crg.read(small(tmp_path / "road.crg"), **options)
