"""Deviations of digital weightings from the analogue ones: the figures that the study is held to."""

from __future__ import annotations

import pytest

from ridecomfort.comfort import deviation


@pytest.mark.parametrize("rate", [100, 200, 500, 1000])
@pytest.mark.parametrize("name", ["Wb", "Wc", "Wd", "We", "Wf", "Wj", "Wk"])
@pytest.mark.parametrize("way", ["exact", "causal"])
def test_ours_deviate_by_a_hundredth_of_a_decibel_at_most(way, name, rate):
    assert deviation.largest(name, rate, way) <= 0.01


@pytest.mark.parametrize("rate, decibel", [(100, 25), (200, 18), (500, 1.3), (1000, 0.3)])
def test_the_papers_way(rate, decibel):
    assert deviation.largest("Wk", rate, "bilinear") == pytest.approx(decibel, rel=0.05)
