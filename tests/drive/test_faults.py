"""What a record shows of instruments and loggers that fail, and what it does not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from ridecomfort.drive import faults
from ridecomfort.vocabulary import SIGNALS

TIME = np.arange(0.0, 60.0, 0.01)


def signals(spoil=lambda name, values: values, step=0.0):
    """Six signals of some hertz with noise, spoilt, as an instrument of this ``step`` tells them."""
    rng = np.random.default_rng(3)
    shaken = {name: gaussian_filter1d(rng.standard_normal(TIME.size), 4) + 0.03 * rng.standard_normal(TIME.size) for name in SIGNALS}
    read = lambda values: np.round(values / step) * step if step else values
    return {name: (TIME, read(spoil(name, values.copy()))) for name, values in shaken.items()}


@pytest.mark.parametrize("step", [0.0, 0.001, 0.01, 0.1, 0.5])
def test_a_record_without_faults_shows_none_however_coarse_its_steps(step):
    assert faults.found(signals(step=step)) == []


@pytest.mark.parametrize("which, sign", [("largest", 1), ("smallest", -1)])
def test_a_signal_at_a_limit_is_told_with_the_limit(which, sign):
    limited = lambda name, values: sign * np.minimum(sign * values, 0.7) if name == "a_z" else values
    (said,) = faults.found(signals(limited))
    assert said.startswith("a_z: ") and f"at the {which} value, {sign * 0.7:g} m/s2: does the instrument reach a limit" in said


def test_the_largest_value_in_one_place_is_no_limit():
    def bump(name, values):
        values[3000:3007] = 3.0, 6.0, 6.0, 6.0, 6.0, 6.0, 3.0
        return values

    assert faults.found(signals(bump)) == []


def test_a_signal_that_stays_at_nought_half_of_the_time_is_held_not_at_a_limit():
    (*said,) = faults.found(signals(lambda name, values: np.maximum(values, 0.0)))
    assert said and all("a value is held" in words for words in said)


def test_values_that_are_held_are_told_with_the_first_place_once_for_all_signals():
    def interrupted(name, values):
        for begin in (1000, 2500, 4000):
            values[begin : begin + 12] = values[begin]
        return values

    (said,) = faults.found(signals(interrupted))
    assert said == f"{', '.join(SIGNALS)}: a value is held for up to 12 samples in 3 places, the first at 10.00 s: was the record interrupted?"


def frozen(*names):
    """Spoils signals of these names by holding them from 30 to 34 s, as an instrument that hangs while the clock goes on."""

    def spoil(name, values):
        if name in names:
            values[3000:3401] = values[3000]
        return values

    return spoil


@pytest.mark.parametrize("step", [0.0, 0.001])
@pytest.mark.parametrize("names", [SIGNALS, SIGNALS[4:5]])
def test_one_long_hold_is_told_with_its_time(names, step):
    (said,) = faults.found(signals(frozen(*names), step))
    assert said.startswith(f"{', '.join(names)}: a value is held for 401 samples, 30.00 to 34.00 s: did the instrument freeze")


def test_a_short_hold_is_told_of_all_six_signals_at_once_and_not_of_one():
    short = lambda *names: lambda name, values: np.where((TIME > 30.0) & (TIME < 30.15) & (name in names), values[3000], values)
    (said,) = faults.found(signals(short(*SIGNALS)))
    assert said.startswith(f"{', '.join(SIGNALS)}: a value is held for 15 samples, 30.00 to 30.14 s")
    assert faults.found(signals(short(*SIGNALS[:5]))) == []


def test_a_hold_that_lasts_to_the_end_is_told():
    dead = lambda name, values: np.where(TIME > 50.0, values[5000], values)
    assert any("to 59.99 s: did the instrument freeze" in words for words in faults.found(signals(dead)))


@pytest.mark.parametrize("value", [0.0, None])
def test_a_hold_that_lasts_from_the_beginning_is_told(value):
    late = lambda name, values: np.where(TIME < 9.995, values[1000] if value is None else value, values)
    end = "10.00" if value is None else "9.99"
    assert any(f"0.00 to {end} s: did the instrument freeze" in words for words in faults.found(signals(late)))


def test_a_speed_that_is_held_while_the_vehicle_drives_on_is_told():
    speed = 20.0 + 2.0 * np.sin(0.3 * TIME)
    held = np.where((TIME > 29.999) & (TIME < 33.001), speed[3000], speed)
    assert faults.found(signals() | {"v_x": (TIME, speed)}) == []
    (said,) = faults.found(signals() | {"v_x": (TIME, held)})
    assert said.startswith("v_x: a value is held for 301 samples, 30.00 to 33.00 s: did the instrument freeze")


def test_a_speed_that_rests_in_its_steps_stays_the_same_or_is_nought_is_not_held():
    smooth = 20.0 + 2.0 * np.sin(0.3 * TIME)
    stops = np.where((TIME > 10.0) & (TIME < 20.0), 0.0, smooth + 0.01 * np.random.default_rng(1).standard_normal(TIME.size))
    for speed in (np.round(smooth, 1), np.round(smooth, 2), np.full(TIME.size, 20.0), stops):
        assert faults.found(signals() | {"v_x": (TIME, speed)}) == []


def test_all_signals_are_held_at_once_whatever_their_clocks():
    held = signals(frozen(*SIGNALS))
    held |= {name: (TIME + 0.003, held[name][1]) for name in SIGNALS[3:]}
    (said,) = faults.found(held)
    assert said.startswith(f"{', '.join(SIGNALS)}: a value is held for 401 samples, 30.00 to 34.00 s")


@pytest.mark.parametrize("known", ["v_x", "s"])
def test_a_parked_vehicle_may_feel_the_same_for_long(known):
    stops = (TIME % 20.0 > 10.0) & (TIME % 20.0 < 15.0)
    speed = np.where(stops, 0.0, 10.0)
    moved = {"v_x": speed, "s": np.cumsum(speed) * 0.01}[known]
    stands = signals(lambda name, values: np.where(stops, 0.0, values), 0.001)
    assert faults.found(stands | {known: (TIME, moved)}) == []
    assert faults.found(stands | {known: (TIME, TIME * 10.0 if known == "s" else np.full(TIME.size, 10.0))})


def test_a_smooth_signal_in_steps_is_not_held_where_it_turns():
    slow = lambda name, values: (4.0 + SIGNALS.index(name)) * np.sin(2.0 * np.pi * 0.3 * TIME + SIGNALS.index(name))
    assert faults.found(signals(slow, 0.01)) == []


@pytest.mark.parametrize("times", [2, 5])
def test_a_slow_signal_in_a_fast_table_is_told(times):
    slow = lambda name, values: np.repeat(values[::times], times)[: values.size] if "rate" in name else values
    (said,) = faults.found(signals(slow))
    assert said.startswith(f"roll_rate, pitch_rate, yaw_rate: every value stands {times} times in a row")


@pytest.mark.parametrize(("times", "said"), [(4 / 3, "1.3"), (5 / 3, "1.7"), (2.5, "2.5"), (10 / 3, "3.3")])
def test_a_slow_signal_in_a_table_of_no_multiple_of_its_rate_is_told(times, said):
    slow = lambda name, values: values[np.floor(np.arange(values.size) / times + 1e-9).astype(int)] if "rate" in name else values
    (words,) = faults.found(signals(slow))
    assert words.startswith(f"roll_rate, pitch_rate, yaw_rate: every value stands {said} times on average: told faster than recorded")


@pytest.mark.parametrize("step", [0.03, 0.1, 0.3])
def test_values_that_are_equal_by_chance_on_a_calm_road_are_not_told_again(step):
    calm = np.where(TIME % 10.0 < 6.0, 0.05, 3.0)
    assert not any("told faster" in words for words in faults.found(signals(lambda name, values: calm * values, step)))


def test_samples_that_stand_alone_are_told_and_bumps_of_the_road_are_not():
    def wrong(name, values):
        values[[700, 1500, 5200]] += [4.0, -4.0, 4.0]
        return values

    (said,) = faults.found(signals(wrong))
    assert "3 samples stand alone, far from those before and behind, the first at 7.00 s" in said
    bump = 4.0 * np.exp(-0.5 * (np.arange(-10, 11) / 1.2) ** 2)  # of 30 ms, as a wheel makes at 25 m/s

    def bumps(name, values):
        for place in (700, 1500, 5200):
            values[place - 10 : place + 11] += bump
        return values

    assert faults.found(signals(bumps)) == []


@pytest.mark.parametrize("shakes", [0.0, 1.0])
def test_a_sample_that_a_blow_makes_stand_alone_is_told_unless_the_body_is_shaken_there(shakes):
    """A car in braking over a joint: one sample of a_x, while a_z goes on for some."""

    def blow(name, values):
        for place in (700, 1500, 5200):
            values[place] += 4.0 * (name == "a_x")
            values[place - 2 : place + 5] += shakes * np.array([0.2, -0.6, -1.1, 0.5, 0.6, 0.2, -0.1]) * (name == "a_z")
        return values

    said = faults.found(signals(blow))
    assert said == ([] if shakes else ["a_x: 3 samples stand alone, far from those before and behind, the first at 7.00 s: were they transmitted wrongly?"])


def test_a_signal_that_mostly_rests_does_not_excuse_a_sample_that_stands_alone():
    near = np.isin(np.arange(TIME.size), [place + k for place in (700, 1500, 5200) for k in (-2, -1, 0, 1)])
    wrong = lambda name, values: 0.01 * near if name == "a_z" else values + 4.0 * (name == "a_x") * np.isin(np.arange(TIME.size), (700, 1500, 5200))
    assert any("a_x: 3 samples stand alone" in words for words in faults.found(signals(wrong)))


def test_a_signal_that_never_changes_shows_nothing():
    assert faults.found(signals(lambda name, values: np.zeros_like(values))) == []


@pytest.mark.parametrize("names", [SIGNALS, ("a_z",)], ids=["all", "a_z"])
@pytest.mark.parametrize("samples", [1, 3, 10])
@pytest.mark.parametrize("step", [0.0, 0.01])
def test_samples_that_were_filled_with_noughts_are_told_where_gravity_shows_it(names, samples, step):
    lost = lambda name, values: np.where((np.arange(TIME.size) // samples == 1000 // samples) & (name in names), 0.0, values + 9.81 * (name == "a_z"))
    (said,) = faults.found(signals(lost, step))
    many = f"{samples} samples are" if samples > 1 else "1 sample is"
    assert said.startswith(f"{', '.join(names)}: {many} exactly 0, the first at {1000 // samples * samples / 100:.2f} s") and said.endswith("noughts?")


def test_noughts_in_all_signals_are_told_without_gravity_and_not_of_a_vehicle_that_stands():
    lost = lambda name, values: np.where(abs(TIME - 30.0) < 0.022, 0.0, values)
    (said,) = faults.found(signals(lost, 0.001))
    assert said == f"{', '.join(SIGNALS)}: 5 samples are exactly 0, the first at 29.98 s: lost, and filled with noughts?"
    assert faults.found(signals(lost, 0.001) | {"v_x": (TIME, np.where(abs(TIME - 30.0) < 1.0, 0.0, 20.0))}) == []


def test_a_body_that_falls_freely_for_a_moment_is_not_lost():
    """Steps of 0.01 m/s2: an a_z that passes 0 is exactly that now and then."""
    falls = lambda name, values: values + (9.81 - 12.0 * np.exp(-0.5 * ((TIME % 5.0 - 2.5) / 0.05) ** 2)) * (name == "a_z")
    assert faults.found(signals(falls, 0.01)) == []


@pytest.mark.parametrize("lasts", [1, 2, 3])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_few_samples_far_beyond_all_others_are_told(lasts, count):
    def wild(name, values):
        for number in range(count if name == "a_z" else 0):
            values[1000 + 700 * number : 1000 + 700 * number + lasts] += 80.0 * (-1) ** number
        return values

    (said,) = faults.found(signals(wild))
    assert said.startswith("a_z: ") and "at 10.00 s" in said and "transmitted wrongly" in said


@pytest.mark.parametrize("height", [1.0, 10.0, 80.0])
@pytest.mark.parametrize("width", [1.2, 3.0])
def test_a_bump_after_which_the_body_goes_on_moving_is_no_sample_that_is_wild(height, width):
    after = np.clip(TIME - 30.0, 0.0, None)
    swings = lambda name, values: values + height * np.exp(-0.5 * ((TIME - 30.0) * 100.0 / width) ** 2) + 0.3 * height * np.exp(-2.0 * after) * np.sin(8.0 * after)
    assert faults.found(signals(swings)) == []


def test_a_value_that_was_transmitted_wrongly_is_told_of_a_signal_in_coarse_steps_too():
    told = signals(step=0.5)
    told["a_y"][1][3000] = 60.0
    (said,) = faults.found(told)
    assert said.startswith("a_y: a sample lies up to ") and said.endswith("the first at 30.00 s: transmitted wrongly?")


@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_values_that_were_transmitted_wrongly_are_told_of_a_signal_that_hardly_leaves_its_step(count):
    """A yaw rate in 1 deg/s on a straight road: what is wrong of it leaves more levels than what is right."""
    told, step = signals(), np.radians(1.0)
    quiet = 0.7 * told["yaw_rate"][1] / np.quantile(np.abs(told["yaw_rate"][1]), 0.9)
    values = step * np.round(quiet)
    values[1000 : 1000 + 700 * count : 700] = [4.0, -5.0, 7.0, 2.0, -3.0][:count]
    told["yaw_rate"] = TIME, values
    (said,) = faults.found(told)
    assert said.startswith("yaw_rate: a sample lies" if count == 1 else f"yaw_rate: {count} samples lie") and "at 10.00 s" in said


def test_samples_that_are_wild_are_told_beside_samples_that_are_lost():
    def spoil(name, values):
        values = values + (9.81 if name == "a_z" else 0.0)
        values[2000:2004] = 0.0
        values[4000] += 150.0 * (name == "a_z")
        return values

    wild, lost = faults.found(signals(spoil))
    assert wild.startswith("a_z: a sample lies") and "at 40.00 s" in wild
    assert "4 samples are exactly 0" in lost


def test_of_a_signal_in_steps_that_are_hardly_ever_left_no_bump_is_wild():
    """Of 99 in 100 values each is nought, of which nobody knows how far within a step they lie."""
    told = signals()
    told["roll_rate"] = TIME, np.zeros(TIME.size)
    told["roll_rate"][1][::80], told["roll_rate"][1][3001:3003] = 1.0, 12.0
    assert faults.found(told) == []


def test_lost_samples_are_told_beside_a_signal_that_is_held_elsewhere():
    def spoil(name, values):
        values = values + (9.81 if name == "a_z" else 0.0)
        values[2000:2004] = 0.0
        values[4000:4100] = values[4000] if name == "yaw_rate" else values[4000:4100]
        return values

    held, lost = faults.found(signals(spoil))
    assert held.startswith("yaw_rate: a value is held for 100 samples")
    assert lost == f"{', '.join(SIGNALS)}: 4 samples are exactly 0, the first at 20.00 s: lost, and filled with noughts?"
