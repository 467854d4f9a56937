"""Small made-up comparisons, ladders and diagnoses in the schema of the study's files, for tests of the report."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ridecomfort.discrepancy import compare, critical, explain, ladder, locate
from ridecomfort.report.study import Compared, Diagnosis, Difference
from ridecomfort.steps.models import rung_titles
from ridecomfort.vocabulary import SIGNALS

SECONDS, RATE = 60.0, 50.0
DRIVES = ("repeat_1", "repeat_2", "slower")


def comparison(errors=(0.5, 0.4), seed=0, repeated=True) -> xr.Dataset:
    """Three drives of a minute, the last one slower; each state errs by a share of the signal that all drives have in common."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, SECONDS, 1 / RATE)
    scale = np.array([0.6, 1.5, 0.5, 0.03, 0.02, 0.1])[:, None]
    place = np.arange(0.0, 1500.0)
    waves = np.array([np.convolve(rng.standard_normal(place.size), np.ones(4) / 2, "same") for _ in range(12)])
    names = DRIVES if repeated else DRIVES[::2]
    measured, simulated, series = [], [], {name: [] for name in (*compare.DRIVEN, *compare.BELOW)}
    for name in names:
        v_x = (14.0 if name == "slower" else 20.0) + np.sin(0.1 * time)
        s = 60.0 + np.cumsum(v_x) / RATE
        signal, missing = (scale * np.array([np.interp(s, place, wave) for wave in waves[k : k + 6]]) for k in (0, 6))
        noise = 0.05 * scale * rng.standard_normal((6, time.size))
        measured.append(signal + noise)
        simulated.append([signal + share * missing for share in errors])
        below = [0.05 + 0.02 * np.sin(0.3 * time), 0.06 + 0.02 * np.sin(0.2 * time), *(0.01 * np.array([np.interp(s, place, wave) for wave in waves[:2]]))]
        for key, values in zip(series, (v_x, s, np.zeros_like(s), *below)):
            series[key].append(values)
    measured, simulated = np.array(measured), np.array(simulated).transpose(1, 0, 2, 3)
    residual = simulated - measured
    residual[..., :100] = np.nan
    rmse = compare.rmse(residual)
    found = xr.Dataset(
        {
            "measured": (("drive", "signal", "time"), measured),
            "simulated": (("state", "drive", "signal", "time"), simulated),
            "residual": (("state", "drive", "signal", "time"), residual),
            "rmse": (("state", "drive", "signal"), rmse),
            "nrmse": (("state", "drive", "signal"), compare.nrmse(residual, measured)),
            "role": ("drive", ["check" if name == "slower" else "fit" for name in names]),
            **{key: (("drive", "time"), np.array(values)) for key, values in series.items()},
        },
        {"drive": list(names), "time": time, "signal": list(SIGNALS), "state": ["reference", "calibrated"][: len(errors)]},
    )
    found = explain.explain(found)
    located = locate.locate(found)
    return found.merge(located).assign_attrs(located.attrs)


def aligned(names=DRIVES) -> xr.Dataset:
    """What alignment says of the drives."""
    numbers = ("clock_offset", "clock_offset_error", "speed_scale", "lateral_correction", "lateral_wander", "distance_wander",
               "mounting_roll", "mounting_pitch", "mounting_yaw", "acceleration_gain", "yaw_rate_gain")  # fmt: skip
    data = {name: ("drive", np.linspace(0.001, 0.002, len(names))) for name in numbers}
    return xr.Dataset({**data, "role": ("drive", ["fit", "fit", "check"][: len(names)])}, {"drive": list(names)})


def rungs(comparisons, fitted=(True, False)) -> xr.Dataset:
    """The ladder of sites ({site: {model: comparison}}); ``fitted`` says of each whether its own drives were."""
    sites = {}
    for (name, models), own in zip(comparisons.items(), fitted):
        graded = {model: critical.critical(each, spacing=0.5) for model, each in models.items()}
        sites[name] = ladder.Measured(models, graded, own)
    models = list(next(iter(comparisons.values())))
    effects = models[-1].split("+") if len(models) > 1 else []
    return ladder.ladder(sites, models, rung_titles(effects))


def difference(names=("ts1", "ts2"), standin=True) -> Difference:
    """Two sites, the first calibrated on, with base and one effect more."""
    of_site = {
        name: {"base": comparison(seed=k), "suspension_friction": comparison((0.5, 0.1), seed=k)} for k, name in enumerate(names)
    }
    sites = tuple(
        Compared(
            name, aligned(), models["base"], standin,
            {"measured": f"{name}/base/measured.nc", "comparison": f"{name}/base/comparison.nc"},
        )
        for name, models in of_site.items()
    )  # fmt: skip
    return Difference(
        sites, rungs(of_site), "ladder/base.nc", calibrations={names[0]: calibration()}, calibration_files={names[0]: "base/calibration.nc"}
    )


def calibration() -> xr.Dataset:
    """A parameter of the vehicle that is known and one of an effect at its bound."""
    numbers = {"initial": (28000.0, 60.0), "value": (20000.0, 0.0), "interval_lower": (19000.0, 0.0), "interval_upper": (21000.0, 30.0),
               "lower": (15000.0, 0.0), "upper": (40000.0, 500.0)}  # fmt: skip
    return xr.Dataset(
        {
            **{key: ("parameter", np.array(values)) for key, values in numbers.items()},
            "unit": ("parameter", np.array(["N/m", "N"])),
            "verdict": ("parameter", np.array(["identified", "at its lower bound"])),
            "correlation": (("parameter", "other"), np.array([[1.0, 0.3], [0.3, 1.0]])),
        },
        {"parameter": (own := ["spring_stiffness_front", "suspension_friction.front"]), "other": own},
        {
            "remarks": "suspension_friction.front is at its lower bound: the data ask for less than the bounds allow",
            "driver": "what the accelerometer tells is taken for the driver's foot",
        },
    )


VERDICT = {
    "verdict": "named",
    "effects": [
        {
            "name": "suspension_friction",
            "sizes": [
                {"parameter": "front", "size": 80.0, "unit": "N", "interval": [70.0, 90.0], "plausible": [0.0, 400.0], "is_plausible": True}
            ],
            "sentence": "friction of the struts",
            "p_value": 0.002,
            "share": 0.8,
            "held_out_share": 0.75,
            "absorbed": 0.3,
            "like": [],
            "differ_on": {},
        }
    ],
    "reasons": ["80 % of the explainable error is removed on the fitted drives, by suspension_friction", "75 % on drives held out"],
    "share": 0.8,
    "held_out_share": 0.75,
}


def nothing() -> dict:
    """A verdict that names nothing."""
    return {**VERDICT, "verdict": "nothing", "effects": [], "reasons": ["the best of 3 candidates has p = 0.4"]}


def ranking() -> xr.Dataset:
    """Evidence for three effects in two rounds, the best of the first refitted and accepted."""
    effects = ["suspension_friction", "damper_asymmetry", "payload"]
    over = ("round", "effect")
    trial = {"held_out_z": 5.0, "gain": 880.0, "bic": -860.0, "share": 0.8, "held_out_share": 0.75}
    return xr.Dataset(
        {
            "p_value": (over, [[0.002, 0.02, 0.6], [np.nan, 0.3, 0.8]]),
            "gain": (over, [[900.0, 300.0, 4.0], [np.nan, 6.0, 1.0]]),
            "absorbed": (over, [[0.3, 0.4, 0.9], [np.nan, 0.4, 0.9]]),
            "passed_over": (over, [["", "", ""], ["", "its refit gains less than 5 % of the best", ""]]),
            "winner": ("round", ["suspension_friction", ""]),
            "trial_round": ("trial", [1, 1]),
            "trial_effect": ("trial", effects[:2]),
            "trial_sizes": ("trial", ["front 80 N", "front 0.2 1"]),
            "trial_objection": ("trial", ["", "makes the drives held out worse"]),
            **{f"trial_{key}": ("trial", [value, 0.2 * value]) for key, value in trial.items()},
            "other_effect": ("other", ["payload", "damper_asymmetry"]),
            "other_parameter": ("other", ["mass", "front"]),
            "other_unit": ("other", ["kg", "1"]),
            "other_size": ("other", [12.0, 0.01]),
            "other_interval": (("other", "bound"), [[-3.0, 27.0], [np.nan, np.nan]]),
            "other_plausible": (("other", "bound"), [[0.0, 500.0], [-0.8, 0.8]]),
        },
        {"effect": effects, "round": [1, 2]},
    )


def diagnosis(verdict=None, standin=True, score=None) -> Diagnosis:
    """A diagnosis of the model base on two sites."""
    files = {"verdict": "diagnosis/base/verdict.json", "ranking": "diagnosis/base/ranking.nc", "score": "diagnosis/base/score.json"}
    labels = ("Ts1", "Ts2") if standin else ()
    return Diagnosis(verdict or VERDICT, ranking(), files, "base", ("ts1", "ts2"), labels, score)


def curves() -> xr.Dataset:
    """Missing forces at two places, a step of friction at the first."""
    knots = np.array([-0.1, 0.0, 0.1])
    step = np.broadcast_to(80.0 * np.sign(knots), (2, 3))
    force = np.stack([step, np.zeros((2, 3))])
    named = np.stack([step, np.zeros((2, 3))])
    over = ("seen", "axle", "knot")
    return xr.Dataset(
        {
            "seen_at": (("seen", "knot"), np.stack([knots, knots])),
            "seen_unit": ("seen", ["m/s", "m"]),
            "seen_axis": ("seen", ["strut velocity, in compression", "strut deflection, in compression"]),
            "missing_what": ("seen", ["missing force, pushing apart"] * 2),
            "missing_unit": ("seen", ["N", "N"]),
            "seen_share": ("seen", [0.6, 0.01]),
            "missing": (over, force),
            "missing_error": (over, np.full(force.shape, 5.0)),
            "named_missing": (over, named),
        },
        {"seen": ["strut velocity", "strut deflection"], "axle": ["front", "rear"]},
    )


PROPOSAL = {
    "name": "discovered", "form": "80 N tanh(velocity / 0.005)", "place": "strut", "port": "suspension", "such_as": "friction of seals",
    "terms": {"velocity_direction": {"": 80.0}}, "share": 0.84, "held_out_share": 0.92, "own_share": 0.84, "own_held_out_share": 0.92, "p_value": 0.0015,
    "sizes": [{"parameter": "velocity_direction", "unit": "N", "size": 80.0, "interval": [78.0, 82.0]}],
}  # fmt: skip
"""A proposed form, as in a verdict."""


def rows(made):
    """Rows of a table as dictionaries by the keys of its columns."""
    return [dict(zip([column.key for column in made.columns], row)) for row in made.rows]


def words(made):
    """All cells of a table as one text."""
    return " ".join(str(cell) for row in made.rows for cell in row)
