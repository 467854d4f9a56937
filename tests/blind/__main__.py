"""Blind trials of the search for missing effects: ``python -m tests.blind`` writes tables into results/blind/.

Every trial draws a car, a road, drives and noise from its seed, hands the search the drives and nothing
else, and scores the verdict against the truth afterwards.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import time
from collections.abc import Collection, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from ridecomfort import discrepancy
from ridecomfort.discrepancy.places import PLACES
from ridecomfort.effects import library
from ridecomfort.errors import InputError
from ridecomfort.vehicle import parameters

from . import kinds, score, trials

REPOSITORY = Path(__file__).resolve().parents[2]

SHARES = {"clean": 8, "messy": 4, "another shape": 1, "another setting": 2, "two": 2, "three": 1, "outside": 3, "outside, messy": 1,
          "nothing": 2, "path error": 1, "clock error, aligned": 1, "another interpolation": 1, "brisk foot": 1,
          "brisk foot, clean speed": 1, "clock error, left": 1, "gain error": 1, "scanner noise": 1, "wrong file": 2, "measurement": 1,
          "outside, beside the library": 2, "outside, beside a wrong file": 1}  # fmt: skip
"""Trials of each kind in a round."""


def one(job: tuple[str, int, int], alone: bool = False) -> dict | None:
    """A trial (kind, seed, number of its kind) as a row of trials.csv; None where so much is hidden that the car does not arrive. ``alone``:
    without the repeats of the first drive."""
    kind, seed, number = job
    car = parameters.read(REPOSITORY / "config" / "vehicles" / "midsize.yaml")
    draw = kinds.draw(kind, seed, number)
    known = library.find(trials.SHAPES)
    hidden = {name: known[name].effect.values(draw.settings.get(name)) for name in draw.hidden}
    true = car.replace(**{name: factor * car[name] for name, factor in draw.wrong.items()})
    try:
        trial = trials.make(100000 * seed + number + 1000 * list(kinds.KINDS).index(kind), true, hidden, draw.kappa, **draw.spoilt)
    except InputError as problem:
        print(kind, "+".join(draw.hidden), f"no trial: {problem}", sep=" | ", flush=True)
        return None
    among = [name for name in library.find() if name not in draw.missing]
    measured, noise_density = trials.alone(trial) if alone else (trial.measured, None)
    start = time.process_time()
    table, verdict, proposal = discrepancy.diagnose(measured, car, among=among, seed=number, workers=1, noise_density=noise_density)
    seconds = time.process_time() - start
    row = {"kind": kind, "seed": seed, "number": number, "hidden": "+".join(draw.hidden), "kappa": draw.kappa}
    row |= {"reached": trial.truth["reached"], **score.score(draw, trial.truth, table, verdict)}
    background = "+".join(f"{name} {kappa:.2g}" for name, kappa in trial.truth["background"].items())
    row |= {"background": background, "wrong": len(draw.wrong), "told": score.told(draw, car, verdict)}
    ports = {place.port: name for name, place in PLACES.items()}
    place = ports.get(known[draw.hidden[0]].effect.port) if kind.startswith("outside") else None
    fall = lambda first, last: score.against_oracle(trial, true, trials.SHAPES, first, last)
    reached = table["held_out_mean_square"].values
    row |= score.form(place, proposal if verdict.verdict == "outside" else None, reached[0], fall)
    oracle = fall(reached[0], reached[-1]) if draw.hidden and kind != "messy" and not draw.wrong else float("nan")
    return {**row, "against_oracle": oracle, "cpu_seconds": seconds, "reasons": "; ".join(verdict.reasons)}


def jobs(rounds: int, seed: int, chosen: Collection[str] = tuple(SHARES)) -> list[tuple[str, int, int]]:
    """Trials of every kind in turn, so that a run that is cut short has some of each."""
    counts = dict.fromkeys(SHARES, 0)
    found = []
    for _ in range(rounds):
        for kind, count in SHARES.items():
            found += [(kind, seed, counts[kind] + k) for k in range(count) if kind in chosen]
            counts[kind] += count
    return found


Done = dict[tuple[str, int, int], dict | None]
"""Rows of trials.csv by job, None where there was no trial."""


def version() -> str:
    """Hexadecimal digits that change with anything that a trial rests on."""
    sources = [*(REPOSITORY / "workflow").rglob("*.py"), *Path(__file__).parent.rglob("*.py"), *(REPOSITORY / "config" / "vehicles").glob("*.yaml")]
    digest = hashlib.sha256()
    for path in sorted(sources):
        digest.update(str(path.relative_to(REPOSITORY)).encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def done_before(path: Path, how: str) -> Done:
    """What a run that was cut short has done, if it was one of the same version and settings (``how``)."""
    if not path.exists():
        return {}
    kept = json.loads(path.read_text(encoding="utf-8"))
    return {tuple(job): row for job, row in kept["done"]} if kept["how"] == how else {}


def write(folder: Path, done: Done, asked: int, how: str, command: str) -> None:
    """Tables of what the ``command`` has done of the trials that are ``asked`` of it, and done.json to go on from."""
    kept = json.dumps({"how": how, "done": list(done.items())}, default=lambda value: value.item())
    (folder / "done.json.new").write_text(kept, encoding="utf-8")
    (folder / "done.json.new").replace(folder / "done.json")
    rows = [row for row in done.values() if row is not None]
    if not rows:
        return
    with open(folder / "trials.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    all_of_them = "" if len(done) == asked else f" of {asked}, cut short,"
    head = "# Blind trials", "", f"{len(rows)} trials{all_of_them} by `{command}`. What the words mean stands in [diagnosis.md](diagnosis.md#how-it-is-tested).", ""
    (folder / "summary.md").write_text("\n".join((*head, *score.summary(rows))) + "\n", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.blind", description=__doc__)
    parser.add_argument("--rounds", type=int, default=8, help=f"rounds of {sum(SHARES.values())} trials of all kinds (default 8)")
    parser.add_argument("--seed", type=int, default=1, help="of the trials (default 1)")
    parser.add_argument("--kinds", nargs="+", choices=list(SHARES), default=list(SHARES), metavar="KIND", help="of these kinds alone")
    parser.add_argument("--alone", action="store_true", help="with one fitted drive, not three repeats, the noise of the instruments being known")
    parser.add_argument("--workers", type=int, default=2, help="trials at a time (default 2)")
    parser.add_argument("--release", action="store_true", help="write the summary into docs/blind.md, too")
    parser.add_argument("--output", type=Path, default=REPOSITORY / "results" / "blind")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    command = f"python -m tests.blind --rounds {options.rounds} --seed {options.seed}{' --alone' if options.alone else ''}"
    if len(options.kinds) < len(SHARES):
        command += " --kinds " + " ".join(f'"{kind}"' for kind in options.kinds)
    how = f"{version()}{', alone' if options.alone else ''}"
    asked = jobs(options.rounds, options.seed, options.kinds)
    before = done_before(options.output / "done.json", how)
    done: Done = {job: before[job] for job in asked if job in before}
    if done:
        print(f"{len(done)} of {len(asked)} trials were done before", flush=True)
    with ProcessPoolExecutor(options.workers) as pool:
        begun = {pool.submit(one, job, options.alone): job for job in asked if job not in done}
        for trial in as_completed(begun):
            done[begun[trial]] = row = trial.result()
            write(options.output, {job: done[job] for job in asked if job in done}, len(asked), how, command)
            if row is not None:
                print(*(f"{row[key]}" for key in ("kind", "hidden", "kappa", "verdict", "found", "cpu_seconds")), sep=" | ", flush=True)
    if options.release:
        (REPOSITORY / "docs" / "blind.md").write_text((options.output / "summary.md").read_text(encoding="utf-8"), encoding="utf-8")


if __name__ == "__main__":
    main()
