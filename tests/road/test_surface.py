"""Heights between the cells of the grid."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.interpolate import CubicHermiteSpline

from ridecomfort import simulate
from ridecomfort.road import edges, surface
from ridecomfort.vehicle import ground


def road_of(elevation, u=None, v=None, bank=0.0, **attrs):
    """A straight road of the given heights, 0.5 m along and 0.25 m across."""
    nu, nv = elevation.shape
    u = 0.5 * np.arange(nu) if u is None else u
    v = 0.25 * np.arange(nv) if v is None else v
    line = {name: ("u", np.zeros(nu)) for name in ("y", "heading", "curvature", "slope")}
    line |= {"x": ("u", np.asarray(u)), "bank": ("u", np.full(nu, bank))}
    return xr.Dataset({"elevation": (("u", "v"), elevation), **line}, coords={"u": u, "v": v}, attrs=attrs)


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_surface_passes_through_the_grid(interpolation):
    heights = np.random.default_rng(1).normal(size=(12, 9))
    road = road_of(heights)
    found = surface.height(road, road.u.values[:, None], road.v.values, interpolation=interpolation)
    np.testing.assert_allclose(found, heights, atol=1e-14)


@pytest.mark.parametrize("edge", [0.0, np.nan])
def test_heights_may_be_held_across_before_along(edge):
    heights = np.random.default_rng(1).normal(size=(9, 9))
    heights[2:5, 0] += edge
    road = road_of(heights, u=0.25 * np.arange(9))
    turned = road.assign(elevation=road.elevation.transpose("v", "u"))
    at_u, at_v = np.random.default_rng(2).uniform(0, 2, (2, 50))
    np.testing.assert_array_equal(surface.height(turned, at_u, at_v), surface.height(road, at_u, at_v))
    np.testing.assert_array_equal(surface.grid(turned)[0], surface.grid(road)[0])


def test_linear_is_exact_for_a_twisted_plane():
    u, v = np.arange(8) * 0.5, np.arange(6) * 0.25
    road = road_of(1 + 0.3 * u[:, None] - 0.2 * v + 0.1 * u[:, None] * v, interpolation="linear")
    at_u, at_v = np.random.default_rng(2).uniform(0, 1, (2, 100)) * [[3.5], [1.25]]
    expected = 1 + 0.3 * at_u - 0.2 * at_v + 0.1 * at_u * at_v
    np.testing.assert_allclose(surface.height(road, at_u, at_v), expected, atol=1e-14)


def test_cubic_is_the_catmull_rom_spline_along_each_direction():
    heights = np.random.default_rng(3).normal(size=(12, 9))
    road = road_of(heights, interpolation="cubic")
    u, v = road.u.values, road.v.values
    at = np.linspace(u[1], u[-2], 200)
    for j in (0, 4):
        spline = CubicHermiteSpline(u, heights[:, j], np.gradient(heights[:, j], u))
        np.testing.assert_allclose(surface.height(road, at, v[j]), spline(at), atol=1e-13)
    across = np.linspace(v[1], v[-2], 200)
    spline = CubicHermiteSpline(v, heights[5], np.gradient(heights[5], v))
    np.testing.assert_allclose(surface.height(road, u[5], across), spline(across), atol=1e-13)


def test_a_road_that_does_not_say_how_is_cubic_to_whoever_asks():
    """Heights, reference line and the wheels of the simulator alike; one that says linear is linear to all."""
    rng = np.random.default_rng(5)
    heights, at = rng.normal(size=(12, 9)), rng.uniform(0.5, 1.5, (2, 50)) * [[2.0], [1.0]]
    for said, expected in (({}, "cubic"), ({"interpolation": "linear"}, "linear")):
        road = road_of(heights, **said)
        found = surface.height(road, *at)
        np.testing.assert_array_equal(found, surface.height(road, *at, interpolation=expected))
        bent = road.assign(bank=("u", heights[:, 0]))
        line = surface.reference_line(bent, at[0]).bank
        np.testing.assert_array_equal(line, surface.reference_line(bent, at[0], interpolation=expected).bank)
        course = simulate.prepare(road)
        np.testing.assert_allclose([ground.height(course.surface, course.elevation, *each) for each in at.T], found, atol=1e-12)


def test_cubic_has_no_kinks_where_linear_has():
    road = road_of(np.random.default_rng(4).normal(size=(12, 9)))
    step = 1e-6
    at = road.u.values[2:-2]
    for interpolation, smooth in (("cubic", True), ("linear", False)):
        before, on, after = (
            surface.height(road, at + d, 0.6, interpolation=interpolation) for d in (-step, 0.0, step)
        )
        assert (np.abs(after - 2 * on + before).max() / step < 1e-3) == smooth


def test_both_interpolations_converge_on_a_smooth_surface():
    def worst(spacing, interpolation):
        u = np.arange(0, 4 + spacing / 2, spacing)
        road = road_of(np.sin(u)[:, None] * np.cos(u), u, u, interpolation=interpolation)
        at = np.random.default_rng(5).uniform(1, 3, (2, 500))
        return np.abs(surface.height(road, *at) - np.sin(at[0]) * np.cos(at[1])).max()

    assert worst(0.2, "linear") / worst(0.1, "linear") == pytest.approx(4, rel=0.2)
    assert worst(0.2, "cubic") / worst(0.1, "cubic") == pytest.approx(8, rel=0.3)


def test_positions_are_broadcast():
    road = road_of(np.zeros((12, 9)))
    assert surface.height(road, np.zeros((3, 1)), np.zeros(4)).shape == (3, 4)
    assert surface.height(road, 0.0, 0.0).shape == ()


def test_positions_that_are_no_numbers_give_no_height():
    road = road_of(np.zeros((12, 9)), interpolation="cubic")
    found = surface.height(road, [np.nan, 1.0, np.inf], [0.5, np.nan, 0.5])
    assert np.isnan(found).all()


def test_beyond_the_edge_the_nearest_height_is_carried_on_with_the_cross_slope():
    heights = 5 + 0.1 * np.arange(9) * 0.25 + np.zeros((6, 1))
    frayed = heights.copy()
    frayed[:, :2] = frayed[:, 7:] = np.nan
    frayed[3] = np.nan
    road = road_of(frayed, bank=0.1)
    np.testing.assert_allclose(surface.grid(road)[0], heights, atol=1e-12)
    np.testing.assert_allclose(surface.height(road, 1.0, road.v.values), heights[2], atol=1e-12)
    unknown = surface.height(road.assign_attrs(edges="none"), 1.0, road.v.values)
    assert np.isnan(unknown[[0, 1, 7, 8]]).all()


def test_edges_and_holes_are_told_apart():
    heights = np.zeros((3, 7))
    heights[0, [0, 3, 6]] = np.nan
    heights[1] = np.nan
    outside = edges.outside(heights)
    assert outside[0].tolist() == [True] + [False] * 5 + [True] and outside[1].all() and not outside[2].any()
    assert np.argwhere(edges.holes(heights)).tolist() == [[0, 3]]


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_reference_line_passes_through_its_cross_sections(alpine, interpolation):
    line = surface.reference_line(alpine, alpine.u.values, interpolation=interpolation)
    assert tuple(line) == surface.LINE
    turning = () if interpolation == "linear" else ("heading", "slope")
    for name in surface.LINE:
        atol = 1e-3 if name in turning else 1e-9
        np.testing.assert_allclose(line[name], alpine[name], rtol=0, atol=atol, err_msg=name)


def arc(spacing, radius=50.0):
    """A road along an arc, slope and bank rising evenly, as a file would hold it: heading and slope of segments."""
    u = np.arange(0, 60 + spacing / 2, spacing)
    road = road_of(np.zeros((len(u), 5)), u)
    turn, rise = u / radius, 1e-3 * u
    line = {"x": radius * np.sin(turn), "y": radius * (1 - np.cos(turn)), "heading": turn + 0.5 * spacing / radius}
    line["heading"][-1] = line["heading"][-2]
    line |= {"curvature": np.full(len(u), 1 / radius), "slope": rise - 0.5e-3 * spacing, "bank": 2 * rise}
    return road.assign({name: ("u", values) for name, values in line.items()})


def test_the_cubic_line_follows_an_arc():
    """Directions and curvature of the arc itself; distance from it falls as the fourth power of the spacing."""
    at = np.random.default_rng(6).uniform(5, 55, 500)
    off = []
    for spacing in (2.0, 1.0):
        line = surface.reference_line(arc(spacing), at, interpolation="cubic")
        np.testing.assert_allclose(line.heading, at / 50.0, atol=1e-12)
        np.testing.assert_allclose(line.curvature, 1 / 50.0, atol=1e-12)
        np.testing.assert_allclose(line.slope, 1e-3 * at, atol=1e-12)
        np.testing.assert_allclose(line.bank, 2e-3 * at, atol=1e-12)
        off.append(np.abs(np.hypot(line.x, line.y - 50.0) - 50.0).max())
    assert off[0] / off[1] == pytest.approx(16, rel=0.1)


def test_the_heading_is_the_direction_of_the_line_up_to_its_ends():
    """Linear: of the polygon. Cubic: of the spline, to the third power of the turn from one segment to the next."""
    road, step = arc(1.0), 1e-5
    at = np.random.default_rng(7).uniform(0.0, 60.0, 500)
    at = at[np.abs(at - np.round(at)) > 2 * step]
    for interpolation, atol in (("linear", 1e-9), ("cubic", 1e-5)):
        before, on, after = (surface.reference_line(road, at + d, interpolation=interpolation) for d in (-step, 0, step))
        way = np.arctan2(after.y - before.y, after.x - before.x)
        np.testing.assert_allclose(on.heading, way, atol=atol)


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_line_goes_straight_on_beyond_its_ends(interpolation):
    line = surface.reference_line(arc(1.0), [[-3.0, -1.0, 0.0], [60.0, 61.0, 63.0]], interpolation=interpolation)
    along, across = np.diff(line.x), np.diff(line.y)
    np.testing.assert_allclose(np.hypot(along, across), [[2.0, 1.0], [1.0, 2.0]], atol=1e-12)
    np.testing.assert_allclose(np.arctan2(across, along), line.heading[:, :2], atol=1e-12)
    assert (line.curvature.values > 0).tolist() == [[False, False, True], [True, False, False]]
    assert line.slope.values[0, :2].tolist() == [0.0, 0.0] and (line.bank[1, 1:] == line.bank[1, 0]).all()


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_reference_line_keeps_the_shape_of_positions_and_knows_no_number_from_none(alpine, interpolation):
    line = surface.reference_line(alpine, [[1.0, np.nan, np.inf]], interpolation=interpolation)
    for name in surface.LINE:
        assert line[name].shape == (1, 3)
        assert np.isfinite(line[name].values).tolist() == [[True, False, False]]
    assert surface.reference_line(alpine, 5.0).x.shape == ()
