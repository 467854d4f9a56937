"""What repeats share is seen as a whole and in a single band of a single signal."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ridecomfort.discrepancy import balance, judge, select, shared
from ridecomfort.discrepancy.experiment import Record
from ridecomfort.discrepancy.judged import band
from ridecomfort.discrepancy.shared import shared_error, worth

from .linear import RATE, SAMPLES, Linear


def judged(model):
    selection = select.select(model, {"stiffness": 0.0}, most=1)
    return selection, judge.judge(selection, model.candidates)


def test_what_repeats_share_in_a_narrow_band_is_told_with_its_signal_and_band():
    model = Linear(8, {})
    white = np.random.default_rng(0).standard_normal((1, SAMPLES))
    for noise in model.noise[:3]:
        noise[2] += 2.0 * band(white, RATE, (26.5, 28.0))[0]
    selection, found = judged(model)
    surest = selection.remaining.band
    assert surest.signal == "c" and surest.lower <= 27.3 <= surest.upper
    assert selection.remaining.share < balance.SHARED, "it is too narrow to be seen in the whole"
    assert found.verdict == "outside" and any("c, 2" in reason for reason in found.reasons)


@pytest.mark.parametrize(("lower", "z", "said"), [(1.0, 13.8, "outside"), (1.0, 6.5, "nothing"), (31.0, 13.8, "nothing")])
def test_on_a_road_that_is_another_an_error_that_repeats_share_counts_where_it_is_too_slow_to_be_the_road(lower, z, said):
    selection, _ = judged(Linear(8, {}))
    left = replace(selection.remaining, band=shared.Band("a_y", lower, lower + 2.0, z))
    found = judge.judge(replace(selection, remaining=left), Linear(8, {}).candidates, notes=["the road is another"])
    assert found.verdict == said


@pytest.mark.parametrize("is_shared", [True, False])
def test_of_a_shorter_repeat_that_counts_which_both_have_driven_in_whatever_order_they_stand(is_shared):
    """The first 12 s of 30: beyond them the shorter one says nothing, and what it held at its end is no error that it shares."""

    def found(lengths):
        model = Linear(8, {})
        every = np.random.default_rng(3).standard_normal((4, SAMPLES))
        model.records = [replace(record, place=record.place[:count]) for record, count in zip(model.records[:2], lengths)]
        errors = [every + (0.0 if is_shared else k) * np.random.default_rng(k).standard_normal(every.shape) for k in (1, 2)]
        residuals = {k: errors[k][:, :count] for k, count in enumerate(lengths)}
        frame = SimpleNamespace(experiment=model, indices=[0, 1])
        ((record, one, other),) = shared._pairs(frame, residuals)
        assert one.shape == other.shape == (4, 1200) and record.place.size == 1200
        return np.sum(one * other) / np.sqrt(np.sum(one**2) * np.sum(other**2))

    first, second = found((1200, SAMPLES)), found((SAMPLES, 1200))
    assert first == pytest.approx(second, abs=0.02) and bool(first > 0.99) is is_shared


def test_an_error_at_the_upper_end_of_what_is_judged_is_seen():
    """From 0.8 to 33.6 Hz are no whole number of the bands of 2 Hz that are told apart."""
    rng = np.random.default_rng(0)
    record = Record("d", "fit", "s", "c", 100.0, (0.8, 33.575), np.arange(6000) * 0.2, 20.0)
    tone = band(rng.standard_normal((1, 6000)), 100.0, (32.9, 33.5))
    one, other = (tone + 0.05 * rng.standard_normal((1, 6000)) for _ in range(2))
    surest = shared._surest(["a_z"], [(record, one, other)])
    assert surest.lower < 33.0 and surest.upper > 33.5 and surest.z > 5.0


@pytest.mark.parametrize("seed", range(20, 26))
def test_noise_of_every_drive_agrees_in_no_band(seed):
    selection, found = judged(Linear(seed, {}))
    assert selection.remaining.band.z < balance.SHARED_BAND_Z and found.verdict == "nothing"


@pytest.mark.parametrize("is_everywhere", [False, True])
def test_the_places_of_an_error_that_sits_at_a_few_of_them_are_told(is_everywhere):
    """Three repeats of 1.2 km at 20 m/s that share a pulse of 0.3 s at 210 m and one at 810 m, or an error all along the road."""
    random, time = np.random.default_rng(4), np.arange(6000) / RATE
    pulses = sum(np.exp(-(((time - place / 20.0) / 0.15) ** 2)) for place in (210.0, 810.0))
    error = 0.3 * random.standard_normal(time.size) if is_everywhere else pulses
    record = Record("drive", "fit", "ts1", "usual", RATE, (0.3, 40.0), 20.0 * time, 1.0)
    series = [error[None] + 0.1 * random.standard_normal((1, time.size)) for _ in range(3)]
    pairs = [(record, series[a], series[b]) for a in range(3) for b in range(a)]
    places = shared._places(pairs, 0, (1.0, 3.0))
    said = str(shared.Band("a_y", 1.0, 3.0, 13.0, places))
    assert said == ("a_y, 1-3 Hz (z = 13.0)" if is_everywhere else "a_y, 1-3 Hz (z = 13.0), half of it at 0.20-0.22, 0.80-0.82 km of ts1")


@pytest.mark.parametrize(("share", "noise", "matters"), [(0.02, 0.0, False), (0.2, 0.0, True), (0.2, 0.17, False), (0.2, 0.1, True)])
def test_an_error_of_drives_that_were_not_repeated_matters_from_some_percent_of_a_signal_above_the_floor_on(share, noise, matters):
    """``noise``: the part of that share that the instruments are known to make."""
    model = Linear(9, {})
    model.records = [replace(record, condition=record.name) for record in model.records]
    selection = select.select(model, {"stiffness": 0.0}, most=0)
    state, instant = selection.states[-1], np.arange(SAMPLES)
    powers = dict(zip(selection.frame.indices, state.squares / share))
    measured = {index: np.sin(instant / 7.0) * np.sqrt(2.0 * power)[:, None] for index, power in powers.items()}
    known = replace(selection, floor_squares=noise / share * state.squares)
    assert balance.worth_explaining(known, measured)[:2] == (matters, matters)


@pytest.mark.parametrize(("channel", "size", "matters"), [("a_x", 0.006, False), ("a_x", 0.02, True), ("a_z", 0.006, True)])
def test_what_a_foot_leaves_of_slow_longitudinal_acceleration_does_not_matter_however_little_else_there_is(channel, size, matters):
    """Two repeats that share ``size`` m/s2 rms at 1.2 to 2.4 Hz, a third of the power there."""
    record = Record("drive", "fit", "road", "usual", RATE, (0.8, 40.0), 0.2 * np.arange(6000), 20.0)
    frame = SimpleNamespace(experiment=SimpleNamespace(records=[record, record], channels=(channel,)), indices=[0, 1], all_cleaned=dict)
    shared, own = band(np.random.default_rng(3).standard_normal((2, 1, 6000)), RATE, (1.2, 2.4))
    fast = np.random.default_rng(4).standard_normal((1, 6000))  # of the signal alone
    residuals = dict.fromkeys((0, 1), size * shared / shared.std())
    measured = dict.fromkeys((0, 1), size * (shared / shared.std() + np.sqrt(2.0) * own / own.std() + 0.1 * fast))
    assert worth(frame, residuals, measured).matters is matters


def test_what_is_left_of_what_mattered_is_told_of_the_bands_in_which_it_did():
    """Two repeats that share a slow error, which a driver's foot may make, and one at 30 to 34 Hz, of whose power a tenth is left."""
    record = Record("drive", "fit", "road", "usual", RATE, (0.8, 40.0), 0.2 * np.arange(6000), 20.0)
    frame = SimpleNamespace(experiment=SimpleNamespace(records=[record, record], channels=("pitch_rate",)), indices=[0, 1], all_cleaned=dict)
    noise = np.random.default_rng(5).standard_normal((3, 1, 6000))
    foot, fast, signal = band(noise[0], RATE, (1.2, 2.4)), band(noise[1], RATE, (30.0, 34.0)), noise[2]
    shared = lambda share: dict.fromkeys((0, 1), 0.2 * foot + np.sqrt(share) * 0.2 * fast)
    measured = dict.fromkeys((0, 1), signal)
    first, tenth, hundredth, foot_alone = (worth(frame, shared(share), measured) for share in (1.0, 0.1, 0.01, 0.0))
    assert tenth.left_of(first) == pytest.approx(0.1, abs=0.01)
    assert first.matters and not hundredth.matters
    assert np.isnan(foot_alone.left_of(foot_alone))


def test_what_is_faster_than_a_driver_is_told_apart():
    """What repeats share at 1.2 to 2.4 Hz counts nothing of it, what they share at 12 to 20 Hz does by its power."""
    selection = select.select(Linear(8, {}), {"stiffness": 0.0}, most=0)
    frame, residuals = selection.frame, selection.states[-1].fit.residuals
    noise = np.random.default_rng(7).standard_normal((4, SAMPLES))
    shared_by_all = lambda size, edges: shared_error(frame, {index: own + size * band(noise, RATE, edges) for index, own in residuals.items()})
    slow, fast, twice = (shared_by_all(*one) for one in ((2.0, (1.2, 2.4)), (1.0, (12.0, 20.0)), (2.0, (12.0, 20.0))))
    assert slow.z > 5.0 and abs(slow.faster_z) < 3.0
    assert fast.faster_z > 5.0 and twice.faster == pytest.approx(4.0 * fast.faster, rel=0.1)


def test_a_fast_error_is_seen_whichever_site_comes_first():
    """Repeats share an error at 29 Hz on one site; on the other, where instruments recorded up to 17 Hz, nothing."""
    random = np.random.default_rng(6)
    record = lambda site, highest: Record("", "fit", site, site, RATE, (0.8, highest), 0.2 * np.arange(6000), 20.0)
    error = band(random.standard_normal((1, 6000)), RATE, (28.0, 30.0))
    sites = [(record(site, upper), *(noise + share * error for noise in 0.3 * random.standard_normal((2, 1, 6000))))
             for site, upper, share in (("fast", 42.5, 1.0), ("slow", 17.0, 0.0))]  # fmt: skip
    for pairs in (sites, sites[::-1]):
        surest = shared._surest(("a_z",), pairs)
        assert surest.z > shared.PLACED and surest.lower < 29.0 < surest.upper


class Plain:
    """Series that are white and clean already."""

    scale = 1.0

    def __call__(self, series):
        return series


def a_frame(repeats, lengths):
    """Records of conditions of these lengths, each so often, whose series are white and clean."""
    records = []
    for number, length in enumerate(lengths):
        records += repeats * [Record("", "fit", "road", f"condition {number}", RATE, (0.3, 40.0), 0.2 * np.arange(length), 20.0)]
    indices = list(range(len(records)))
    return SimpleNamespace(
        experiment=SimpleNamespace(records=records, channels=("a", "b")), indices=indices,
        whitening=dict.fromkeys(indices, Plain()), all_cleaned=dict,
    )  # fmt: skip


@pytest.mark.parametrize("lengths", [(6000,), (6000, 6000), (6000, 1000)])
def test_an_error_that_is_all_shared_is_so_however_long_each_condition(lengths):
    rng = np.random.default_rng(5)
    series = [part for length in lengths for part in 2 * [rng.standard_normal((2, length))]]
    found = shared_error(a_frame(2, lengths), dict(enumerate(series)))
    assert found.share == pytest.approx(1.0) and found.z > 10.0


@pytest.mark.parametrize("seed", range(3))
def test_how_surely_more_than_half_is_left_says_nothing_of_how_surely_anything_is(seed):
    """The z of an error that is there for certain saturates: half of it left, nearly all of its z is."""
    rng, frame = np.random.default_rng(seed), a_frame(2, (6000,))
    error = rng.standard_normal((2, 6000))
    noise = [0.3 * rng.standard_normal((2, 6000)) for _ in range(2)]
    first = {k: error + noise[k] for k in range(2)}
    left = lambda share: {k: np.sqrt(share) * error + noise[k] for k in range(2)}
    before = shared_error(frame, first)
    z = lambda share: shared_error(frame, left(share)).left_z(before, 0.5)
    assert before.z > 9.0 and abs(z(0.5)) < 2.33 and z(0.6) > 2.33 and z(0.4) < -2.33


def test_without_repeats_nothing_is_known_to_be_shared():
    model = Linear(9, {})
    model.records = model.records[2:]
    model.columns, model.noise = model.columns[2:], model.noise[2:]
    selection, _ = judged(model)
    assert np.isnan(selection.remaining.share) and selection.remaining.band is None
