"""How often the 90 % intervals of calibration hold the truth: ``python -m tests.recovery`` writes tables into results/recovery/.

Every trial draws a car, a road, a driver and the errors of an instrument from its seed. The model itself is driven, nothing
is hidden; the record is aligned and calibrated as a study does it, and scored afterwards.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path

import numpy as np
import yaml
from scipy.stats import binomtest

from ridecomfort import calibrate
from ridecomfort.vehicle import parameters
from ridecomfort.vocabulary import CALIBRATED
from tests.recovery import trials

REPOSITORY = Path(__file__).resolve().parents[2]


def one(seed: int, car, measurement, foot: float = 0.0) -> list[dict]:
    """One trial: a row for each parameter, in its SI unit."""
    start = time.process_time()
    trial = trials.make(seed, car, measurement, foot)
    found = calibrate.calibrate(trial.drives, trial.road, car, sequence=False, restarts=0)
    seconds = time.process_time() - start
    rows = []
    for name in CALIBRATED:
        column = found.sel(parameter=name)
        value, lower, upper = (float(column[key]) for key in ("value", "interval_lower", "interval_upper"))
        rows.append(
            {
                "seed": seed, "parameter": name, "truth": trial.truth[name], "value": value, "lower": lower,
                "upper": upper, "held": lower <= trial.truth[name] <= upper, "verdict": str(column["verdict"].item()),
                "error": (value - trial.truth[name]) / trial.truth[name],
                "half_width": 0.5 * (upper - lower) / trial.truth[name], "cpu_seconds": seconds,
            }  # fmt: skip
        )
    return rows


def summary(rows: list[dict]) -> list[str]:
    """Lines of a Markdown table: a line for each parameter, its share of intervals that hold the truth with 95 % interval (Wilson)."""
    lines = [
        "| parameter | intervals that hold the truth (95 % interval) | trials | mean error | rms error | half width, median | identified |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in CALIBRATED:
        own = [row for row in rows if row["parameter"] == name]
        held, count = sum(row["held"] for row in own), len(own)
        lower, upper = binomtest(held, count).proportion_ci(method="wilson")
        error = np.array([row["error"] for row in own])
        width = np.median([row["half_width"] for row in own])
        known = sum(row["verdict"] == "identified" for row in own)
        lines.append(
            f"| {name} | {100 * held / count:.0f} % ({100 * lower:.0f}-{100 * upper:.0f} %) | {count} | {100 * error.mean():+.2f} % "
            f"| {100 * np.sqrt(np.mean(error**2)):.2f} % | {100 * width:.2f} % | {known} |"
        )
    seconds = np.median([row["cpu_seconds"] for row in rows])
    lines.append(f"\nA trial takes {seconds:.1f} s on one core (median).")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.recovery", description=__doc__)
    parser.add_argument("--trials", type=int, default=100, help="number of trials (default 100)")
    parser.add_argument("--seed", type=int, default=1, help="of the first trial (default 1)")
    parser.add_argument("--foot", type=float, default=0.0, help="how briskly drivers move the pedals, m/s2 rms (default 0)")
    parser.add_argument("--output", type=Path, default=REPOSITORY / "results" / "recovery")
    options = parser.parse_args()
    car = parameters.read(REPOSITORY / "config" / "vehicles" / "midsize.yaml")
    measurement = yaml.safe_load((REPOSITORY / "config" / "standin.yaml").read_text(encoding="utf-8"))["measurement"]
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for seed in range(options.seed, options.seed + options.trials):
        rows += one(seed, car, measurement, options.foot)
        print(f"trial {seed}: " + ", ".join(f"{row['parameter']} {'held' if row['held'] else 'missed'}" for row in rows[-5:]), flush=True)
        with open(options.output / "trials.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        (options.output / "summary.md").write_text("\n".join(summary(rows)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
