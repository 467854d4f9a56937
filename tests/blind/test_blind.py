"""Blind trials with a small library: what is hidden is named with its size, where nothing is, nothing, and wrong records are suspect."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys

import numpy as np
import pytest

from ridecomfort import discrepancy, store
from ridecomfort.discrepancy import opening, unlike
from ridecomfort.drive import record
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import kinds, score, trials
from tests.blind.__main__ import one

pytestmark = pytest.mark.slow

AMONG = ("suspension_friction", "damper_asymmetry", "spring_progression", "tyre_progression", "top_mount")


@pytest.fixture(scope="module")
def car_file(repository):
    return repository / "config" / "vehicles" / "midsize.yaml"


@pytest.fixture(scope="module")
def diagnosed(car_file, tmp_path_factory):
    """A trial with a hidden effect, from files to files as the workflow does it: the truth, ranking and verdict."""
    folder = tmp_path_factory.mktemp("blind")
    hidden = {"damper_asymmetry": library.find()["damper_asymmetry"].effect.values()}
    trial = trials.make(101, parameters.read(car_file), hidden, 1.0)
    road, drives = trial.measured["trial"]
    store.write(road, folder / "road.nc", title="road")
    store.write(record.stack(drives), folder / "measured.nc", title="drives")
    config = {
        "sites": ["trial"], "fitted_on": ["trial"], "effects": {}, "effects_folder": None, "bounds": {}, "uncertain": opening.UNCERTAIN, "noise_density": {}, "seed": 0,
        "among": AMONG, "simulation": {"step": 0.001, "rate": 100},
    }  # fmt: skip
    subprocess.run(
        [sys.executable, "-m", "ridecomfort.steps.diagnose", "--roads", folder / "road.nc", "--measured", folder / "measured.nc",
         "--vehicle", car_file, "--calibration", "--config", json.dumps(config),
         "--ranking", folder / "ranking.nc", "--verdict", folder / "verdict.json", "--workers", "1"],
        check=True,
    )  # fmt: skip
    return trial.truth, store.read(folder / "ranking.nc"), json.loads((folder / "verdict.json").read_text())


def test_a_hidden_effect_is_named_with_its_size(diagnosed):
    truth, ranking, verdict = diagnosed
    assert verdict["verdict"] == "named"
    assert [effect["name"] for effect in verdict["effects"]] == ["damper_asymmetry"]
    for size in verdict["effects"][0]["sizes"]:
        assert size["size"] == pytest.approx(truth["effects"]["damper_asymmetry"][size["parameter"]], rel=0.1)
    held_out = ranking["held_out_mean_square"]
    assert float(held_out.isel(model=1).mean()) < float(held_out.isel(model=0).mean())


def test_the_files_hold_reasons_units_and_the_missing_force(diagnosed):
    _, ranking, verdict = diagnosed
    assert verdict["reasons"] and verdict["effects"][0]["sizes"][0]["unit"] == "1"
    assert ranking["winner"].values[0] == "damper_asymmetry"
    assert ranking["missing"].notnull().any()


def test_nothing_is_named_where_nothing_is_missing(car_file):
    car = parameters.read(car_file)
    trial = trials.make(102, car, {}, 1.0)
    _, verdict = discrepancy.rank(trial.measured, car, among=AMONG, most=2, workers=1)
    assert verdict.verdict == "nothing" and verdict.effects == ()


@pytest.mark.parametrize(("spoilt", "reason"), [({"clock": 0.008}, "clock"), ({"gain": 0.03}, "gain")])
def test_a_record_that_is_wrong_is_called_suspect(car_file, spoilt, reason):
    car = parameters.read(car_file)
    trial = trials.make(103, car, {}, 1.0, **spoilt)
    _, verdict = discrepancy.rank(trial.measured, car, among=AMONG, most=1, workers=1)
    assert verdict.verdict == "suspect" and any(reason in words for words in verdict.reasons)


@pytest.mark.parametrize(
    ("late", "said"),
    [([0, 1, 2], "roll_rate comes 12 ms too late beside the other signals of the fitted drives"), ([1], "drive_2: roll_rate, beside what the model does there and in drive_1, drive_3, comes 12 ms too late")],
)
def test_one_signal_that_comes_late_is_told_by_its_name(car_file, late, said):
    """In all fitted drives, but not in the one held out; or in one of the repeats."""
    car = parameters.read(car_file)
    ((site, (road, drives)),) = trials.make(103, car, {}).measured.items()
    for number in late:
        rolled = unlike.delayed(drives[number]["roll_rate"].values, 0.012 * trials.RATE)
        drives[number] = drives[number].assign(roll_rate=("time", rolled))
    _, verdict = discrepancy.rank({site: (road, drives)}, car, among=AMONG, most=1, workers=1)
    assert verdict.verdict == "suspect" and any(words.startswith(said) for words in verdict.reasons), verdict.reasons


@pytest.mark.long
def test_a_trial_becomes_a_row_and_rows_a_table(car_file):
    draws = ((number, kinds.draw("clean", 3, number)) for number in itertools.count())  # the library in turn
    number = next(number for number, draw in draws if draw.hidden == ("damper_knee",) and draw.kappa >= 0.3)
    row = one(("clean", 3, number))
    assert row["hidden"] == "damper_knee" and row["in_cluster"] and row["against_oracle"] > 0.8
    table = "\n".join(score.summary([row]))
    assert "| first name right, clean, kappa >= 0.3 | 95 % | 100 %" in table and "oracle" in table


def test_of_a_trial_without_repeats_the_search_is_given_one_drive_beside_that_held_out_and_the_noise_of_both(car_file):
    trial = trials.make(5, parameters.read(car_file), {})
    measured, noise_density = trials.alone(trial)
    (_, drives), densities = measured["trial"], noise_density["trial"]
    assert [drive.attrs["role"] for drive in drives] == ["fit", "check"] and set(densities) == {"drive_1", "drive_4"}
    # White noise of this density fills the records up to half of their rate.
    assert densities["drive_1"]["gyroscope"] * np.sqrt(50.0) == pytest.approx(trials.GYROSCOPE)


def test_the_truth_says_how_large_the_background_is(car_file):
    truth = trials.make(6, parameters.read(car_file), {}, background=["top_mount", "tyre_runout"]).truth
    assert truth["background"] == {name: pytest.approx(trials.BACKGROUND, rel=0.2) for name in ("top_mount", "tyre_runout")}
    assert truth["reached"] == 0.0


def reached(car_file, name) -> float:
    """The kappa that counts of an effect at its largest plausible size."""
    return score.level(trials.make(12, parameters.read(car_file), {name: library.find()[name].effect.values()}, 3.0).truth["reached"])


@pytest.mark.parametrize("name", kinds.FAINT)
def test_what_is_faint_comes_up_to_no_kappa_that_counts(car_file, name):
    kappa = reached(car_file, name)
    assert kappa < 0.3 and (kappa > 0.0 or name not in ("tyre_enveloping", "tyre_progression"))


@pytest.mark.parametrize("name", ["steering_compliance", "steering_lag"])
def test_what_comes_up_to_a_kappa_that_counts_is_not_left_out_as_faint(car_file, name):
    assert name not in kinds.FAINT and reached(car_file, name) >= 0.3


def test_a_road_that_is_interpolated_otherwise_is_no_missing_effect(car_file):
    car = parameters.read(car_file)
    trial = trials.make(104, car, {}, 1.0, interpolation="linear")
    _, verdict = discrepancy.rank(trial.measured, car, among=[*AMONG, "tyre_enveloping"], most=1, workers=1)
    assert verdict.verdict == "nothing" and any("linear interpolation" in words for words in verdict.reasons)


def test_noise_of_a_road_that_its_file_does_not_show_is_suspected(car_file):
    car = parameters.read(car_file)
    trial = trials.make(105, car, {}, 1.0, scanner=0.0002)
    _, verdict = discrepancy.rank(trial.measured, car, among=[*AMONG, "tyre_enveloping"], most=1, workers=1)
    assert verdict.verdict == "suspect" and any("smoother than the points of its file" in words for words in verdict.reasons)


@pytest.mark.long
def test_a_shaft_out_of_balance_comes_back_as_a_force_that_whirls_with_its_period_and_at_its_place(car_file):
    """Outside of the library; 2 pi times 0.32 m over 3.2 turns of the shaft in one of the wheels."""
    car = parameters.read(car_file)
    hidden = {"propshaft_imbalance": library.find(trials.SHAPES)["propshaft_imbalance"].effect.values()}
    trial = trials.make(102, car, hidden, 1.0)
    table, verdict, proposal = discrepancy.diagnose(trial.measured, car, workers=1)
    assert verdict.verdict == "outside" and "times a turn of the wheels" in table.attrs["turns"]
    assert proposal.place == "body" and list(proposal.terms)[0] == "whirling_by_speed"
    shaped = proposal.settings["whirling_by_speed"]
    assert shaped["period"] == pytest.approx(2.0 * np.pi * 0.32 / 3.2, rel=3e-4) and shaped["place"] == pytest.approx(-0.4, abs=0.15)
    states = proposal.selection.states
    assert score.against_oracle(trial, car, trials.SHAPES, states[0].held_out_squares, states[-1].held_out_squares) > score.FORM
