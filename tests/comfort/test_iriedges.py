"""Edges of the classes of ride quality by speed."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort.comfort import iriedges
from ridecomfort.errors import InputError


def test_edges_at_the_printed_speeds_are_the_printed_ones():
    """tab:IRI_thresholds at 80 and 50 km/h."""
    edges = iriedges.Edges()
    assert edges.at(80 / 3.6) == pytest.approx([1.43, 2.24, 2.84, 4.05])
    assert edges.at(50 / 3.6) == pytest.approx([2.28, 3.59, 4.54, 6.25])


def test_edges_follow_one_over_v_between_and_beyond():
    """VG is 114 / v(km/h) but for rounding; linear interpolation in v errs by up to 13 %."""
    edges = iriedges.Edges()
    speed_km_h = np.array([8.0, 15.0, 25.0, 45.0, 90.0, 110.0, 130.0])
    assert edges.at(speed_km_h / 3.6)[0] == pytest.approx(114.4 / speed_km_h, rel=5e-3)
    linear = np.interp(15.0, [10.0, 20.0], [11.44, 5.72])
    assert linear / edges.at(15.0 / 3.6)[0] == pytest.approx(1.125, rel=1e-3)


def test_speed_at_which_a_class_is_lost_is_the_inverse():
    edges = iriedges.Edges()
    rough = np.array([0.5, 1.0, 2.5, 6.0, 40.0])
    for quality, speed in enumerate(edges.speed(rough)):
        assert [edges.at(v)[quality] for v in speed] == pytest.approx(rough)


TWO = {"VG": (1.0, 2.0), "G": (2.0, 3.0), "F": (3.0, 4.0), "M": (4.0, 5.0)}


def test_classes_and_speeds_may_stand_in_any_order():
    turned = iriedges.Edges((60, 80), {name: TWO[name][::-1] for name in ("M", "F", "G", "VG")})
    speed = np.array([10.0, 20.0, 30.0])
    np.testing.assert_array_equal(turned.at(speed), iriedges.Edges((80, 60), TWO).at(speed))


@pytest.mark.parametrize(
    ("speeds", "changed", "said"),
    [
        ((80, 60), {"G": (0.9, 3.0)}, "thresholds: G: 0.9 m/km at 80 km/h, expected values above those of the class before (1)"),
        ((60, 80), {}, "thresholds: VG: 2 m/km at 80 km/h and 1 m/km at 60 km/h, expected edges that fall with speed"),
        ((80, 60), {"VG": (1.0,)}, "thresholds: VG: 1 values, expected one for each of the 2 speeds"),
        ((80, 80), {}, "speed_km_h: 80 stands twice, expected different speeds"),
        ((80, -60), {}, "speed_km_h: -60, expected different speeds above 0 km/h"),
        ((80, 60), {"best": (0.1, 0.2)}, "thresholds: edges of VG, G, F, M, best, expected of VG, G, F, M"),
    ],
)
def test_edges_out_of_order_are_refused(speeds, changed, said):
    with pytest.raises(InputError) as problem:
        iriedges.Edges(speeds, {**TWO, **changed})
    assert said in str(problem.value)
