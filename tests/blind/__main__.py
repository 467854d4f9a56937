"""Blind trials of the search for missing effects: ``python -m tests.blind`` writes tables into results/blind/.

Every trial draws a car, a road, drives and noise from its seed, hands the search the drives and nothing
else, and scores the verdict against the truth afterwards.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path

import numpy as np
from scipy.stats import binomtest

from ridecomfort import discrepancy
from ridecomfort.discrepancy import car as cars
from ridecomfort.effects import library
from ridecomfort.vehicle import parameters
from tests.blind import trials

REPOSITORY = Path(__file__).resolve().parents[2]
KAPPAS = (0.1, 0.3, 1.0, 3.0)


def hidden_effects() -> list[str]:
    """Effects of the vehicle that a trial may hide: not errors of the instrument or the road's file."""
    return [name for name, entry in library.find().items() if not cars.candidate(entry.effect).instrument]


def one(seed: int, car, names, kappa: float, *, clock: float = 0.0, without: bool = False, workers: int | None = None) -> dict:
    """One trial and its score. ``without``: the true effects are taken out of the library."""
    known = library.find()
    trial = trials.make(seed, car, {name: known[name].effect.values() for name in names}, kappa, clock=clock)
    among = [name for name in known if not (without and name in names)]
    start = time.perf_counter()
    _, verdict = discrepancy.rank(trial.measured, car, among=among, most=max(1, len(names)) + 1, seed=seed, workers=workers)
    seconds = time.perf_counter() - start
    found = [effect.name for effect in verdict.effects]
    cluster = set(found).union(*(effect.like for effect in verdict.effects)) if found else set()
    sizes = [
        size["interval"][0] <= trial.truth["effects"][effect.name][size["parameter"]] <= size["interval"][1]
        for effect in verdict.effects
        if effect.name in trial.truth["effects"]
        for size in effect.sizes
    ]
    return {
        "seed": seed, "hidden": "+".join(names), "kappa": kappa,
        "reached": trial.truth["reached"], "clock": clock, "without": without, "verdict": verdict.verdict,
        "found": "+".join(found), "first_right": bool(found) and found[0] in names, "in_cluster": bool(cluster & set(names)),
        "wrong_named": verdict.verdict == "named" and not set(found) <= set(names), "exact": set(found) == set(names),
        "covered": sum(sizes), "sizes": len(sizes), "share": verdict.share, "held_out_share": verdict.held_out_share,
        "seconds": seconds,
    }  # fmt: skip


def summary(rows: list[dict]) -> list[str]:
    """Lines of a Markdown table: each figure with its 95 % interval (Wilson) and the number of trials."""

    def line(what, hits, count):
        if not count:
            return f"| {what} | - | 0 |"
        lower, upper = binomtest(int(hits), int(count)).proportion_ci(method="wilson")
        return f"| {what} | {100 * hits / count:.0f} % ({100 * lower:.0f}-{100 * upper:.0f} %) | {count} |"

    seen = [row for row in rows if row["reached"] >= 0.5 * row["kappa"]]
    hidden = [row for row in seen if row["hidden"] and not row["without"]]
    null = [row for row in rows if not row["hidden"]]
    outside = [row for row in seen if row["without"]]
    lines = ["| figure | reached (95 % interval) | trials |", "|---|---|---|"]
    for kappa in sorted({row["kappa"] for row in hidden}):
        at = [row for row in hidden if row["kappa"] == kappa]
        lines.append(line(f"first name right, kappa {kappa:g}", sum(row["first_right"] for row in at), len(at)))
        lines.append(line(f"true effect in the cluster, kappa {kappa:g}", sum(row["in_cluster"] for row in at), len(at)))
    lines.append(line("wrong effect named with confidence", sum(row["wrong_named"] for row in rows), len(rows)))
    for clock in sorted({row["clock"] for row in null}):
        at = [row for row in null if row["clock"] == clock]
        lines.append(line(f"something named where nothing is missing, clock off by {1e3 * clock:g} ms",
                          sum(row["verdict"] in ("named", "cluster") for row in at), len(at)))  # fmt: skip
    lines.append(line('"outside" said when it is', sum(row["verdict"] == "outside" for row in outside), len(outside)))
    covered, sizes = (sum(row[key] for row in hidden) for key in ("covered", "sizes"))
    lines.append(line("90 % interval covers the size", covered, sizes))
    pairs = [row for row in hidden if "+" in row["hidden"]]
    lines.append(line("exact set of 2 effects", sum(row["exact"] for row in pairs), len(pairs)))
    small = sum(bool(row["hidden"]) for row in rows) - sum(bool(row["hidden"]) for row in seen)
    lines.append(f"| hidden effect too small at any plausible size (left out above) | {small} | {len(rows)} |")
    shares = [row["held_out_share"] for row in hidden if row["first_right"] and np.isfinite(row["held_out_share"])]
    if shares:
        median, tenth = np.median(shares), np.quantile(shares, 0.1)
        lines.append(f"| held-out explainable error removed, median (10th percentile) | {median:.2f} ({tenth:.2f}) | {len(shares)} |")
    lines.append(f"| seconds a trial, median | {np.median([row['seconds'] for row in rows]):.1f} | {len(rows)} |")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.blind", description=__doc__)
    parser.add_argument("--trials", type=int, default=60, help="number of trials (default 60)")
    parser.add_argument("--seed", type=int, default=1, help="of the first trial (default 1)")
    parser.add_argument("--workers", type=int, default=None, help="processes a trial (default: one per core)")
    parser.add_argument("--output", type=Path, default=REPOSITORY / "results" / "blind")
    options = parser.parse_args()
    car = parameters.read(REPOSITORY / "config" / "vehicles" / "midsize.yaml")
    names, rows = hidden_effects(), []
    options.output.mkdir(parents=True, exist_ok=True)
    for number in range(options.trials):
        seed = options.seed + number
        draw = np.random.default_rng([seed, 9])
        kind = number % 6
        hidden = [] if kind == 5 else [str(name) for name in draw.choice(names, 2 if kind == 4 else 1, replace=False)]
        clock = float(draw.choice([0.0, 0.003])) if kind == 5 else 0.0
        rows.append(one(seed, car, hidden, float(draw.choice(KAPPAS)), clock=clock, without=kind == 3, workers=options.workers))
        print({key: rows[-1][key] for key in ("seed", "hidden", "kappa", "reached", "without", "verdict", "found", "seconds")}, flush=True)
        with open(options.output / "trials.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        (options.output / "summary.md").write_text("\n".join(summary(rows)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
