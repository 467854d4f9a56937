"""Running total value, quantities and total values of ISO 2631-1 against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ridecomfort.comfort import exposure, iso2631, quantities, seat, total, weighting
from ridecomfort.errors import InputError

RATE = 100.0
TIME = np.arange(6000) / RATE


def test_metrics_of_a_sine():
    """A sine of amplitude A over whole periods: rms A/sqrt(2), VDV A (3/8)^(1/4) T^(1/4), crest sqrt(2)."""
    found = iso2631.metrics(2.0 * np.sin(2 * np.pi * 5 * TIME), RATE)
    assert float(found.rms) == pytest.approx(2 / np.sqrt(2))
    assert float(found.mtvv) == pytest.approx(2 / np.sqrt(2), rel=1e-9)
    assert float(found.vdv) == pytest.approx(2 * (3 / 8 * 60) ** 0.25)
    assert float(found.evdv) == pytest.approx(1.4 * np.sqrt(2) * 60**0.25)
    assert float(found.msdv) == pytest.approx(np.sqrt(2) * np.sqrt(60))
    assert float(found.crest_factor) == pytest.approx(np.sqrt(2))
    assert bool(found.rms_suffices) and quantities.advice(found) == []
    assert found.vdv.attrs["units"] == "m/s1.75"


def test_what_nobody_feels_is_no_shock_however_it_rounds():
    spike = np.zeros(2000)
    spike[1000] = 1e-15
    found = quantities.metrics(spike, 100.0)
    assert 0.0 < float(found.rms) < quantities.UNFELT and bool(found.rms_suffices) and quantities.advice(found) == []
    assert all(np.isnan(float(found[name])) for name in ("crest_factor", "mtvv_ratio", "vdv_ratio"))


def test_advice_where_the_rms_underrates():
    shock = np.zeros(6000)
    shock[3000:3010] = 10.0
    found = iso2631.metrics(shock, RATE)
    assert not bool(found.rms_suffices)
    assert [sentence.split()[0] for sentence in quantities.advice(found)] == ["crest", "MTVV", "VDV"]
    assert float(found.mtvv) == pytest.approx(10 * np.sqrt(0.1))


def test_metrics_leave_the_padding_out():
    signal = np.full((2, 300), np.nan)
    signal[0, :200], signal[1] = 1.0, -2.0
    found = iso2631.metrics(xr.DataArray(signal, dims=("run", "time")), RATE)
    assert found.rms.values == pytest.approx([1.0, 2.0])
    assert found.duration.values == pytest.approx([2.0, 3.0])
    assert found.running_rms.dims == ("run", "time") and np.isnan(found.running_rms[0, 200:]).all()


def test_linear_running_rms_is_the_plain_sum():
    signal = np.random.default_rng(2).standard_normal(700)
    found = quantities.running_rms(signal, RATE, 1.0)
    plain = [np.sqrt(np.sum(signal[max(0, k - 99) : k + 1] ** 2) / 100) for k in range(700)]
    assert np.allclose(found, plain)


def test_a_window_between_two_samples_counts_the_oldest_in_part():
    signal = np.arange(1.0, 6.0)
    found = quantities.running_rms(signal, 1.0, 2.5)
    assert found[-1] == pytest.approx(np.sqrt((25 + 16 + 0.5 * 9) / 2.5))


def test_exponential_running_rms_of_a_step():
    found = quantities.running_rms(np.ones(500), RATE, 1.0, "exponential")
    assert np.allclose(found, np.sqrt(1 - np.exp(-(np.arange(500) + 1) / RATE)))


def test_running_total_value_of_three_sines():
    """Steady sines: a_v^2 is the sum of the squared weighted rms."""
    frequencies, amplitudes, names = (2.0, 1.0, 8.0), (0.5, 0.7, 0.4), ("Wd", "Wd", "Wk")
    axes = [a * np.sin(2 * np.pi * f * TIME) for a, f in zip(amplitudes, frequencies)]
    found = iso2631.running_total_value(*axes, RATE)
    rms = [weighting.WEIGHTINGS[n].factor(f) * a / np.sqrt(2) for n, f, a in zip(names, frequencies, amplitudes)]
    assert found[3000:5500] == pytest.approx(np.linalg.norm(rms), rel=1e-6)


@pytest.mark.parametrize("before", ["rest", "mirror"])
def test_total_value_is_the_same_bit_for_bit_in_any_batch(before):
    rng = np.random.default_rng(4)
    lengths = rng.integers(900, 5000, 12)
    axes = rng.standard_normal((3, 12, 5000)).astype(np.float32)
    for run, length in enumerate(lengths):
        axes[:, run, length:] = np.nan
    whole = iso2631.running_total_value(*axes, RATE, before=before)
    parts = [iso2631.running_total_value(*axes[:, a : a + 5], RATE, before=before) for a in (0, 5, 10)]
    assert np.array_equal(whole, np.concatenate(parts), equal_nan=True)
    for run, length in enumerate(lengths):
        alone = iso2631.running_total_value(*axes[:, run, :length], RATE, before=before)
        assert np.array_equal(whole[run, :length], alone) and np.isnan(whole[run, length:]).all()


def test_float32_is_enough_for_the_total_value():
    axes = np.random.default_rng(6).standard_normal((3, 4, 6000))
    double = iso2631.running_total_value(*axes, RATE)
    single = iso2631.running_total_value(*axes.astype(np.float32), RATE)
    assert single.dtype == np.float32
    assert np.max(np.abs(20 * np.log10(single[:, 10:] / double[:, 10:]))) < 1e-4


def test_factors_by_point_and_axis():
    """ISO 2631-1:1997 8.2.2: backrest 0.8, 0.5, 0.4; feet 0.25, 0.25, 0.4; rotations 0.63, 0.4, 0.2 m/rad."""
    ones = {"x": 1.0, "y": 1.0, "z": 1.0}
    assert total.total_value(ones) == pytest.approx(np.sqrt(3))
    assert total.total_value(ones, "back") == pytest.approx(np.sqrt(0.64 + 0.25 + 0.16))
    assert total.total_value(ones, "feet") == pytest.approx(np.sqrt(0.0625 + 0.0625 + 0.16))
    rotations = {"roll": 1.0, "pitch": 1.0, "yaw": 1.0}
    assert total.total_value(rotations) == pytest.approx(np.sqrt(0.63**2 + 0.4**2 + 0.2**2))
    both = {("seat", "z"): 0.3, ("feet", "z"): 1.0}
    assert total.overall(both) == pytest.approx(0.5)
    with pytest.raises(InputError, match="axis 'w' is unknown"):
        total.total_value({"w": 1.0})


def test_daily_exposure_and_caution_zone():
    assert exposure.a8(1.0, 2 * 3600) == pytest.approx(0.5)
    assert exposure.a8_of_periods([(1.0, 2 * 3600), (0.5, 8 * 3600)]) == pytest.approx(np.sqrt(0.25 + 0.25))
    with pytest.raises(InputError, match="exposure"):
        exposure.a8_of_periods([(1.0, -5.0)])
    # ISO 2631-1:1997 figure B.1: 3 and 6 m/s2 at 10 min, equal energy from there on.
    assert (exposure.rms_zone(60).lower, exposure.rms_zone(600).upper) == (3.0, 6.0)
    eight_hours = exposure.rms_zone(8 * 3600)
    assert (eight_hours.lower, eight_hours.upper) == (pytest.approx(0.433, abs=5e-4), pytest.approx(0.866, abs=5e-4))
    assert [eight_hours.place(value) for value in (0.3, 0.6, 1.0)] == ["below", "caution", "likely risk"]
    with pytest.raises(InputError, match="exposure"):
        exposure.a8(1.0, -1.0)


def test_doses_of_a_repeated_site_are_those_of_the_repeated_signal():
    signal = np.random.default_rng(8).standard_normal(3000)
    once, often = iso2631.metrics(signal, RATE), iso2631.metrics(np.tile(signal, 16), RATE)
    trip = exposure.repeated(float(once.vdv), float(once.msdv), 30.0, 480.0)
    assert trip.vdv == pytest.approx(float(often.vdv)) and trip.msdv == pytest.approx(float(often.msdv))


def test_motion_sickness():
    """ISO 2631-1:1997 D.3: K_m = 1/3, so 0.5 m/s2 for 1 h gives 10 %."""
    assert exposure.vomiting_share(0.5 * np.sqrt(3600)) == pytest.approx(10.0)
    assert exposure.illness_rating(50.0) == pytest.approx(1.0)


def test_seat_value_of_a_sine_is_the_transmissibility():
    floor = np.sin(2 * np.pi * 8 * TIME) * np.hanning(len(TIME))
    chair = seat.Seat(natural_frequency=4.0, damping_ratio=0.3)
    expected = 100 * np.sqrt((1 + (2 * 0.3 * 2) ** 2) / ((1 - 4) ** 2 + (2 * 0.3 * 2) ** 2))
    assert seat.seat_value(seat.on_seat(floor, RATE, chair), floor, RATE) == pytest.approx(expected, rel=1e-3)
    assert seat.seat_value(floor, floor, RATE, dose=True) == pytest.approx(100.0)


@pytest.mark.parametrize("dose", [False, True])
def test_a_seat_value_is_that_of_the_vibration_whatever_gravity_the_recordings_hold(dose):
    rng = np.random.default_rng(2)
    floor = rng.standard_normal(3000)
    on_seat = seat.on_seat(floor, 100.0)
    plain, held = (seat.seat_value(on_seat + offset, floor + offset, 100.0, dose=dose) for offset in (0.0, 9.81))
    assert held == pytest.approx(plain, rel=1e-3) and plain < 95.0


def test_the_dose_of_a_run_without_data_is_not_told():
    found = quantities.metrics(np.array([[1.0, -1.0] * 200, [np.nan] * 400]), 100.0)
    assert np.isfinite(found["vdv"].values[0]) and np.isnan(found["vdv"].values[1])


def test_a_seat_passes_gravity_unchanged_and_vibration_on_it_as_without_it():
    runs = np.full((2, len(TIME)), 9.81)
    runs[1, -100:] = np.nan
    np.testing.assert_allclose(seat.on_seat(runs, RATE), runs, rtol=1e-12)
    floor = np.random.default_rng(4).standard_normal(len(TIME))
    np.testing.assert_allclose(seat.on_seat(floor + 9.81, RATE) - 9.81, seat.on_seat(floor, RATE), atol=1e-9)


def test_total_value_behind_a_seat_is_that_of_the_signal_on_the_seat():
    floor = np.sin(2 * np.pi * 6 * TIME) * np.hanning(len(TIME))
    chair, still = seat.Seat(3.0, 0.4), np.zeros_like(TIME)
    direct = iso2631.running_total_value(still, still, floor, RATE, seat=chair)
    in_two = iso2631.running_total_value(still, still, seat.on_seat(floor, RATE, chair), RATE)
    assert direct == pytest.approx(in_two, abs=1e-6)


def test_trip_that_repeats_a_site():
    """Two hours of a pass of 100 s: 72 times; 1.4 on y makes it the worst axis; doses grow with roots of the passes."""
    runs = xr.Dataset(
        {
            "weighted_rms": (("run", "axis"), [[0.1, 0.4, 0.5]]),
            "vdv": (("run", "axis"), [[0.5, 2.0, 2.1]]),
            "msdv_z": ("run", [1.5]),
            "duration": ("run", [100.0]),
        },
        {"run": [0], "axis": ["a_x", "a_y", "a_z"]},
    )
    found = exposure.of_runs(runs, 7200.0)
    assert str(found["worst_axis"].values) == "a_y"
    assert found["rms"].item() == pytest.approx(0.56) and found["a8"].item() == pytest.approx(0.28)
    assert found["vdv"].item() == pytest.approx(2.8 * 72**0.25)
    assert found["msdv_z"].item() == pytest.approx(1.5 * 72**0.5)
    assert found["vomiting_share"].item() == pytest.approx(1.5 * 72**0.5 / 3)
    assert found["illness_rating"].item() == pytest.approx(1.5 * 72**0.5 / 50)
    # The dose over the trip is that of the same motion for as long: rms times the root of the time.
    assert found["msdv_z"].item() == pytest.approx(1.5 / 100**0.5 * 7200**0.5)
