"""What was put into the residuals is said in words, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from ridecomfort import vocabulary
from ridecomfort.discrepancy import classes, findings, locate

from .drives import put_between_1400_and_1600_m


@pytest.fixture(scope="module")
def located():
    return locate.locate(put_between_1400_and_1600_m())


def test_signal_band_place_and_condition_are_named(located):
    (found, *others) = findings.findings(located)
    assert not others
    assert (found.signal, found.lower, found.upper) == ("a_z", 8.0, 14.0)
    assert 1300 <= found.stretch[0] < 1600 and found.stretch[1] <= 1600
    assert "speeds above" in found.when


def test_it_is_one_sentence_with_its_shares(located):
    (sentence,) = findings.words(located)
    assert sentence.startswith("a_z, 8-14 Hz, half of it between 1.") and "speeds above" in sentence
    assert sentence.endswith("100 % of its explainable error")


def test_an_error_that_is_even_along_the_road_has_no_stretch(located):
    even = located.copy(deep=True)
    share = even["power_share"].values
    share[...] = share.mean(axis=1, keepdims=True)
    assert findings.findings(even)[0].stretch is None
    assert "all along the road" in findings.words(even)[0]


def test_an_error_at_many_places_is_not_said_to_be_everywhere(located):
    """Bends, gear changes or patches of another surface: every eighth stretch."""
    patchy = located.copy(deep=True)
    share = patchy["power_share"].values
    patches = np.arange(share.shape[1]) % 8 == 0
    share[...] = share.sum(axis=1, keepdims=True) * (patches / patches.sum())[:, None]
    found = findings.findings(patchy)[0]
    assert found.stretch is None and found.least == pytest.approx(0.1)
    assert "at many places, half of it on 10 % of the road" in findings.words(patchy)[0]


def test_two_steady_speeds_are_told_apart_between_them(located):
    """Within what a driver holds of one speed lies no edge, though it wavers a little."""
    wavering = put_between_1400_and_1600_m()
    wavering["v_x"] = wavering["v_x"] + 0.1 * np.sin(np.arange(wavering.sizes["time"]))
    assert findings.findings(locate.locate(wavering))[0].when == "speeds above 72 km/h"


def test_low_classes_are_said_with_the_other_word(located):
    held = ("condition_share", "condition_error", "condition_measured")
    turned = located.sel(condition=["speed"])
    turned = turned.assign({key: turned[key].isel({"class": slice(None, None, -1)}) for key in held})
    assert "speeds below" in findings.findings(turned)[0].when


def test_what_grows_less_than_the_signal_is_relatively_most_where_that_is_small(located):
    """As friction: the error is largest on rough road, and in percent of the signal on smooth road."""
    rough = located.copy(deep=True)
    error, measured = rough["condition_error"], rough["condition_measured"]
    rough["condition_share"][...] = 1 / located.sizes["class"]
    growing = np.linspace(1.0, 2.0, located.sizes["class"])
    error[...] = growing[None, :, None, None]
    measured[...] = 1.0
    measured.loc[dict(condition="speed")] = (growing**3)[:, None, None]
    assert "speeds below" in findings.findings(rough)[0].when
    # As a damper: nothing of the error where little moves, and in percent as much everywhere else.
    error[...] = 1.0
    error.loc[dict(condition="speed")] = (growing**3 - 0.99)[:, None, None]
    assert "speeds above" in findings.findings(rough)[0].when
    error.loc[dict(condition="speed")] = (growing**3)[:, None, None]
    assert findings.findings(rough)[0].when == ""


def test_tyre_velocities_are_named_only_where_they_tell_more_than_those_of_the_suspension(located):
    rough = located.isel(condition=[0, 0]).assign_coords(condition=["suspension_velocity", "tyre_velocity"]).copy(deep=True)
    assert "suspension velocities above" in findings.findings(rough)[0].when
    rough["condition_error"].loc[dict(condition="suspension_velocity")] = rough["condition_error"].sel(condition="suspension_velocity").mean("class")
    rough["condition_measured"].loc[dict(condition="suspension_velocity")] = 1.0
    assert "tyre velocities above" in findings.findings(rough)[0].when


def test_tyre_velocities_are_held_against_those_of_the_suspension_alone(located):
    """Above an edge of the tyre's the error is 1.1 times as large as above one of the speed; there is nothing of the suspension."""
    both = located.isel(condition=[0, 0]).assign_coords(condition=["speed", "tyre_velocity"]).copy(deep=True)
    both["condition_measured"][:] = 1.0
    known = np.flatnonzero(both["condition_share"].values[0] > 0)
    for condition, ratio in (("speed", 3.0), ("tyre_velocity", 3.3)):
        both["condition_error"].loc[{"condition": condition}] = 1.0
        both["condition_error"].loc[{"condition": condition}][known[-1]] = ratio
    assert "tyre velocities above" in findings.findings(both)[0].when


def test_bands_of_one_signal_do_not_crowd_out_the_others(located):
    many = located.copy(deep=True)
    many["power_share"].loc[dict(signal="yaw_rate")] = 10.0
    many["power_share"].loc[dict(signal="a_x")] = 1.0
    said = [(finding.signal, finding.power_share) for finding in findings.findings(many)]
    assert [name for name, _ in said] == ["yaw_rate"] * 2 + ["a_x"] * 2 + ["a_z"]
    assert all(first >= second for (_, first), (_, second) in zip(said, said[1:]))


def test_a_place_that_holds_much_of_the_error_of_most_signals_is_told(located):
    """A hole: in no band the largest error, and yet one place in all signals."""
    even = located.copy(deep=True)
    share = even["power_share"]
    share[...] = 0.02 / share.sizes["stretch"] / share.sizes["band"]
    assert findings.gathered(even) == []
    hole = even.copy(deep=True)
    hole["power_share"][:4, 7] += 0.01 / share.sizes["band"]
    start, end = (float(located[f"stretch_{edge}"][7]) / 1000 for edge in ("start", "end"))
    mine = 100 * (0.01 + 0.02 / share.sizes["stretch"]) / 0.03
    (said,) = findings.gathered(hole)
    assert said == findings.words(hole)[-1]
    assert said.startswith(f"{mine:.0f} % of the error") and f"between {start:.2f} and {end:.2f} km" in said
    of_two = even.copy(deep=True)
    of_two["power_share"][:2, 7] += 0.01 / share.sizes["band"]
    assert findings.gathered(of_two) == []


def test_a_floor_that_moments_make_is_told_behind_all_else(located):
    """Half of what repeats differ by in a_x lies within a hundredth of the time."""
    assert findings.of_floor(located) == []
    moments = located.copy(deep=True)
    moments["floor_time_share"].loc[dict(signal="a_x")] = 0.01
    (said,) = findings.of_floor(moments)
    assert said == findings.words(moments)[-1] and said.startswith("half of what repeats differ by in a_x lies within 1.0 % of the time")


def test_nothing_is_said_of_what_is_not_worth_a_sentence(located):
    numbers = {name: 0.0 * values for name, values in located.items() if values.dtype.kind == "f"}
    assert findings.words(located.assign(numbers)) == []


def test_where_nothing_is_large_the_largest_alone_is_told(located):
    share = located["power_share"]
    small = located.assign(power_share=share * 0.3 * findings.NAMED / float(share.sum("stretch").max()))
    (found,) = findings.findings(small)
    assert (found.signal, found.lower) == ("a_z", 8.0) and findings.are_small([found])
    assert not findings.are_small(findings.findings(located))


def test_a_band_begins_where_its_signal_is_judged_from(located):
    slow = located.copy(deep=True)
    share = slow["power_share"]
    share[dict(signal=0, band=0)] = 10 * float(share.max())
    assert findings.words(slow)[0].startswith("a_x, 1.5-2.5 Hz")


def test_every_condition_that_is_located_has_its_words():
    """The conditions of a drive that holds whatever one may be made of."""
    rng = np.random.default_rng(0)
    held = (*vocabulary.SIGNALS, "v_x", "suspension_velocity", "tyre_velocity", "road_heave", "road_tilt")
    series = {name: 10.0 + rng.standard_normal(1000) for name in held}
    assert set(classes.conditions(series, 100.0)) == set(findings.CONDITIONS)
    assert findings.CONDITIONS["curvature"][0](0.01) == "radii below 100 m"


@pytest.mark.parametrize(
    ("condition", "edge", "above", "below"),
    [
        ("curvature", 4.7e-5, "bends", "straight stretches"),
        ("curvature", 0.002, "radii below 500 m", "radii above 500 m"),
        ("lateral_acceleration", 0.0341, "lateral accelerations above 0.034 m/s²", "lateral accelerations below 0.034 m/s²"),
        ("longitudinal_acceleration", 1.349, "braking or driving above 1.3 m/s²", "braking or driving below 1.3 m/s²"),
        ("suspension_velocity", 0.00041, "suspension velocities above 0.00041 m/s", "suspension velocities below 0.00041 m/s"),
        ("tyre_velocity", 0.2, "tyre velocities above 0.2 m/s", "tyre velocities below 0.2 m/s"),
    ],
)
def test_edges_near_nil_are_said_as_what_they_are(condition, edge, above, below):
    """On a road with a straight the lowest class ends where an edge in tenths reads 0.0."""
    assert [said(edge) for said in findings.CONDITIONS[condition]] == [above, below]
