"""OpenCRG files that are wrong: refused in one line, or repaired by a named option."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ridecomfort.errors import InputError
from ridecomfort.road import crg, surface

from tests.road.crg_files import edited, small


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
        "handmade_vtest", lambda text: " *missing*".join(text.rsplit(" 3.3333333", 1)), "holes: fill",
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
    "a heading in degrees": (
        "handmade_curved", lambda text: text.replace("phi,rad", "phi,deg"), "'reference line phi' in 'deg', expected in rad",
    ),
    "a heading in gradians": (
        "handmade_curved", lambda text: text.replace("phi,rad", "phi,grad"), "'reference line phi' in 'grad', expected in rad",
    ),
    "a bank in percent": (
        "handmade_banked", lambda text: text.replace("banking,m/m", "banking,%"), "'reference line banking' in '%', expected in m/m",
    ),
    "heights in mm": (
        "handmade_sloped", lambda text: text.replace("v = -1.250,m", "v = -1.250,mm"), "'long section at v = -1.250' in 'mm', expected in m",
    ),
    "a channel without a unit": (
        "handmade_banked", lambda text: text.replace("banking,m/m", "banking"), "'reference line banking' without a unit, expected in m/m",
    ),
    "a channel of the reference line that the library does not know": (
        "handmade_banked", lambda text: text.replace("line banking", "line camber"), "decodeDefined: unknown definition",
    ),
    "no OpenCRG at all": ("handmade_straight", lambda text: "nothing of the kind\n", "not an OpenCRG file"),
    "an unknown format": ("handmade_straight", lambda text: text.replace("#:LRFI", "#:XRFI"), "$KD_DEFINITION: 'XRFI', expected LRFI"),
    "a height with the exponent of Fortran": (
        "handmade_straight", lambda text: "   2.0D-02".join(text.rsplit(" 0.0000000", 1)),
        "data line 23: '2.0D-02' in columns 61 to 70, expected a number",
    ),
    "a height that is infinite": (
        "handmade_straight", lambda text: "       inf".join(text.rsplit(" 0.0000000", 1)), "data line 23: 'inf' in columns 61 to 70",
    ),
    "a parameter with the exponent of Fortran": (
        "handmade_straight", lambda text: text.replace("END_U     = 22.0", "END_U     = 2.2D+01"),
        "reference_line_end_u: '2.2D+01', expected a number",
    ),
    "a parameter of two numbers": (
        "handmade_straight", lambda text: text.replace("END_U     = 22.0", "END_U     = 22 0"), "reference_line_end_u: '22 0', expected",
    ),
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
        with pytest.raises(InputError, match="bytes, expected 600 for 30 cross sections|does not contain enough records"):
            crg.read(path)


@pytest.mark.parametrize(("format", "width", "per_line"), [("LRFI", 10, 8), ("LDFI", 20, 4)])
def test_blanks_behind_the_values_of_a_line_are_refused_where_its_cross_section_goes_on(tmp_path, format, width, per_line):
    """The library took a field of them for a height of 0 m, and put every height behind it a column too far to the left."""
    path = small(tmp_path / "road.crg", z=np.full((30, 11), 0.5), v=np.linspace(-2, 2, 11), fmt=format)
    header, end, data = re.split(r"(\n\${4}.*\n)", path.read_text())
    lines_each, lines = -(-11 // per_line), data.splitlines()

    def changed(change, last):
        whole = [change(line) if (k % lines_each == lines_each - 1) == last else line for k, line in enumerate(lines)]
        path.write_text(f"{header}{end}" + "\n".join(whole) + "\n")
        return path

    for blanks in (1, width - 2, width):
        said = f"data line 1 of {len(lines)}: blanks at the end of the line: {80 + blanks} characters, expected 80"
        with pytest.raises(InputError, match=said):
            crg.read(changed(lambda line: line + " " * blanks, last=False))
        np.testing.assert_array_equal(crg.read(changed(lambda line: line + " " * blanks, last=True)).elevation, 0.5)
    with pytest.raises(InputError, match=f"data line 1 of {len(lines)}: .* values, expected {per_line}"):
        crg.read(changed(lambda line: line[:-1], last=False))


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
    with pytest.raises(InputError, match="road: no height at u = 1.2 m, v = 0 m, expected a road without holes inside its edges"):
        surface.grid(road)


def of_300_m(**changes):
    """Heights of a road of 300 m that climbs 7 %, and how it is written."""
    z = np.random.default_rng(2).normal(0, 0.01, (301, 9))
    return z, {"du": 1.0, "v": np.linspace(-2, 2, 9), "slope": 0.07, "z0": 300.0} | changes


@pytest.mark.parametrize("columns", [slice(None), slice(4, None)])
@pytest.mark.parametrize("rows", [slice(10, 11), slice(10, 60), slice(0, 40), slice(300, None)])
@pytest.mark.parametrize("height", [-9999.0, 0.0])
def test_whole_cross_sections_out_of_reason_are_refused_where_they_begin(tmp_path, height, rows, columns):
    """Most of a cross section, or all of it: its own median is out of reason too."""
    z, options = of_300_m()
    wrong = np.zeros(z.shape, dtype=bool)
    wrong[rows, columns] = True
    z = np.where(wrong, height - 300.0 - 0.07 * np.arange(301.0)[:, None], z)
    path = small(tmp_path / "road.crg", z=z, **options)
    i, j = np.argwhere(wrong)[0]
    with pytest.raises(InputError, match=rf"u = {i} m, v = {-2 + 0.5 * j:g} m: {wrong.sum()} heights out of reason, the first -?[\d.e+-]+ m, expected within"):
        crg.read(path)
    road = crg.read(path, heights="blank", holes="keep")
    assert float(road.elevation.min()) > 299.0 and int(road.elevation.notnull().sum()) == (~wrong).sum()


def test_a_climb_over_a_cliff_of_less_than_10_m_is_a_road(tmp_path):
    z, options = of_300_m()
    z[150:] += 9.0
    assert np.ptp(crg.read(small(tmp_path / "road.crg", z=z, **options)).elevation.values) > 29.0


def test_ends_without_any_height_are_refused_or_cut_off(tmp_path):
    z, options = of_300_m()
    z[:50], z[280:] = 77.0, 77.0
    path = small(tmp_path / "road.crg", z=z, **options)
    path.write_bytes(path.read_bytes().replace(np.array(77.0, ">f4").tobytes(), np.array(np.nan, ">f4").tobytes()))
    with pytest.raises(InputError, match="u = 0 m, .*71 empty cross sections"):
        crg.read(path)
    road = crg.read(path, holes="keep")
    assert (road.u[0], road.u[-1], road.sizes["u"]) == (50.0, 279.0, 230)
    assert "heights from u = 50 to 279 m only, of 0 to 300 m: cut there" in road.treatment
    np.testing.assert_allclose(road.elevation, 300.0 + 0.07 * road.u.values[:, None] + z[50:280], atol=1e-4)


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
    path = edited(shared / "data/opencrg/handmade_banked.crg", tmp_path / "road.crg", ("reference line banking", "camber of the road"))
    assert "left out: 'camber of the road'" in crg.read(path).treatment


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
