"""What a person sees while the study runs: one line per finished job, and how long it will still take."""

from __future__ import annotations

import difflib
import json
import logging
import re
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from ..config import SITES
from .command import NOTE

SILENCED = ("job_info", "job_started", "job_finished", "job_error", "progress")
"""Events that Snakemake would print in several lines each."""

CHATTER = ("Removing temporary output", "Would remove temporary output", "Select jobs to execute", "Singularity containers: ignored")
"""Beginnings of messages that say nothing to a person who waits."""

PAGE = "results/report.html"
"""What a run that makes the page ends with."""

TO_LOOK_AT = {
    "compared": "results/tables/alignment.md, calibrated.md, findings.md; results/figures/located_*.png, error_ladder.png",
    "diagnosed": "results/tables/verdict.md, missing_effects.md; results/figures/evidence.png, signature.png",
}
"""What a run without the page ends with, by the rule that made it."""

VERDICT = "results/tables/verdict.md"
"""What the rule "diagnosed" makes anew; that of an earlier diagnosis stays where a run ends before."""

TOLD = ("diagnosis",)
"""Rules that take minutes and say in their logs how far they are."""

CHANGED_SETTINGS = re.compile(r"Params have changed since last execution: .*?before: '(\{.*\})' now: '(\{.*\})' ?")
"""How Snakemake says so, with the settings of the step before and now (JSON)."""

MISSING_RULE = re.compile(r"No rule to produce ([^\s/]+) \(")
"""How Snakemake says that it was asked for something that is neither a rule nor the path of a file."""

LOG_LINES = 15
"""Lines shown of the log of a job that failed unexpectedly."""


@dataclass(frozen=True)
class Job:
    rule: str
    where: str
    start: float
    benchmark: str | None
    logs: Sequence[Path] = ()


class Progress(logging.Handler):
    """Follows Snakemake's log records and prints one line where it would print ten.

    The time left is that of the jobs still to come, each taken to last as long as those of its
    rule have lasted so far, or last time (Snakemake's benchmark files), shared among as many as
    run at once. Where the rule with the most jobs to come was never timed, none is given.
    A dry run (``planning``) has one line per job too: what would run, and why. ``rules``: the names that may be asked for.
    """

    def __init__(
        self, benchmarks: Path, stream: TextIO | None = None, planning: bool = False, rules: Callable[[], Collection[str]] = list
    ):
        super().__init__()
        self.rules = rules
        self.stream = stream or sys.stderr
        self.planning = planning
        self.earlier = _earlier(benchmarks)
        self.todo: Counter[str] = Counter()
        self.counts: Counter[str] = Counter()
        self.seconds: dict[str, list[float]] = defaultdict(list)
        self.running: dict[int, Job] = {}
        self.announced: set[tuple[str, str]] = set()
        self.noted: list[str] = []
        self.together = 1
        self.done = 0
        self.percent = 0
        self.begun = time.monotonic()

    def emit(self, record: logging.LogRecord) -> None:
        try:
            match str(getattr(record, "event", None)):
                case "run_info":
                    self._count(record.stats)
                case "job_info":
                    self._started(record)
                case "job_finished":
                    self._finished(record.job_id)
                case "job_error":
                    self._failed(record)
                case "error" if missing := _missing(record):
                    self._write(f"error: {missing}: no site of the study and no target of this name; {self._meant(missing)}")
        except Exception:  # a study must not end because of a line on the screen
            self.handleError(record)

    def replaces(self, record: logging.LogRecord) -> bool:
        """Filter for the handler that prints Snakemake's own lines: those that this one prints instead."""
        if str(getattr(record, "event", None)) in SILENCED:
            return False
        if getattr(record, "exception", None) == "RuleException" and "CalledProcessError" in str(record.msg):
            return False
        return not str(record.msg).startswith(CHATTER) and not _missing(record)

    def time_left(self) -> float | None:
        """Seconds until all jobs are done, None where too little is known."""
        left = +self.todo
        if not left:
            return None
        mean = {rule: sum(times) / len(times) for rule, times in self.seconds.items()}
        mean = {**self.earlier, **mean}
        known = [mean[rule] for rule in left if rule in mean]
        if left.most_common(1)[0][0] not in mean:
            return None
        usual = sum(known) / len(known)
        total = sum(count * mean.get(rule, usual) for rule, count in left.items())
        elapsed = sum(time.monotonic() - job.start for job in self.running.values())
        return max(total - elapsed, 0.0) / self.together

    def left_undone(self) -> None:
        """Say of a run that ended with an error before it had written its diagnosis, that the one there is older.

        Of the whole study the rule "diagnosed" is planned behind its diagnosis only.
        """
        is_written = self.counts["diagnosed"] > 0 and self.todo["diagnosed"] == 0
        if self.counts["diagnosis"] + self.counts["diagnosed"] > 0 and not is_written and Path(VERDICT).is_file():
            self._write(f"{VERDICT} and what stands beside it are of an earlier diagnosis: this run ended before its own were written")

    def _meant(self, missing: str) -> str:
        """What may have been meant by a target that there is not."""
        if (SITES / f"{missing}.yaml").is_file():
            return f"to choose the site append --config sites=[{missing}]"
        close = difflib.get_close_matches(missing, self.rules(), n=1)
        return f"did you mean {close[0]!r}?" if close else "see README.md"

    def _count(self, stats: Mapping[str, int]) -> None:
        self.counts = Counter({rule: count for rule, count in stats.items() if rule != "total"})
        self.todo = self.counts.copy()

    def _started(self, record: logging.LogRecord) -> None:
        wildcards = dict(record.wildcards)
        where = " ".join(str(value) for value in wildcards.values())
        if self.planning:
            self._write(f"{_joined(record.rule_name, where)}: {_shortened(record.reason)}")
            return
        if self.todo[record.rule_name] <= sum(job.rule == record.rule_name for job in self.running.values()):
            # A job that nobody knew of before a checkpoint: what a diagnosis names is computed next.
            self.counts[record.rule_name] += 1
            self.todo[record.rule_name] += 1
        logs = _logs(record)
        self.running[record.jobid] = Job(record.rule_name, where, time.monotonic(), record.benchmark, logs)
        self.together = max(1, len(self.running))
        site = str(next(iter(wildcards.values()), ""))
        if record.benchmark and (record.rule_name, site) not in self.announced:
            self.announced.add((record.rule_name, site))
            told = f" (how far: {logs[0]})" if logs and record.rule_name in TOLD else ""
            self._print(f"{_joined(record.rule_name, where)} ...{told}")

    def _finished(self, number: int) -> None:
        job = self.running.pop(number, None)
        if job is None:
            return
        self.done += 1
        self.todo[job.rule] -= 1
        if job.benchmark:
            self._tell(job)
        if not +self.todo:
            page = f"; the page: {PAGE}" if self.counts["report"] else ""
            self._print(f"all done in {_duration(time.monotonic() - self.begun)}{page}")
            for words in dict.fromkeys(self.noted):
                self._write(f"said above: {words}")
            for rule, files in TO_LOOK_AT.items():
                if self.counts[rule] and not page:
                    self._write(f"look at {files}")

    def _tell(self, job: Job) -> None:
        took = time.monotonic() - job.start
        self.seconds[job.rule].append(took)
        of = f" ({self.counts[job.rule] - self.todo[job.rule]} of {self.counts[job.rule]} such jobs)"
        of = of if self.counts[job.rule] > 1 else ""
        self._print(f"{_joined(job.rule, job.where)} done in {_duration(took)}{of}{self._left()}")
        for line in _lines(job.logs):
            if line.startswith(NOTE):
                words = line.removeprefix(NOTE)
                self._write(f"        {words}")
                if job.rule not in TOLD:  # a verdict is long, and stands where a person is sent to look
                    self.noted.append(words)

    def _left(self) -> str:
        steps = sum((+self.todo).values())
        left = self.time_left()
        if left is None:
            return f"; {steps} to go" if steps else ""
        return f"; {steps} to go, about {_duration(left)}"

    def _failed(self, record: logging.LogRecord) -> None:
        job = self.running.pop(record.jobid, None)
        logs = _logs(record)
        lines = _lines(logs)
        named = [line for line in lines if line.startswith("error: ")]
        reason = named[-1] if named else f"see {logs[0] if logs else record.msg}"
        self._print(f"{_joined(record.rule_name, job.where if job else '')} failed: {reason}")
        if not named:
            self._write("\n".join(f"    {line}" for line in lines[-LOG_LINES:]))

    def _print(self, text: str) -> None:
        total = sum(self.counts.values())
        self.percent = max(self.percent, 100 * self.done // total if total else 0)  # jobs that a diagnosis adds take nothing back
        self._write(f"[{self.percent:3} %] {text}")

    def _write(self, text: str) -> None:
        print(text, file=self.stream, flush=True)


def follow(workflow) -> Progress | None:
    """Print progress for a run of this Snakemake workflow; None where that was asked for all details, for few or for none."""
    from snakemake.logging import logger

    output = workflow.output_settings
    quiet = any(level.name in ("RULES", "PROGRESS", "ALL") for level in output.quiet or ())
    if not workflow.is_main_process or output.verbose or quiet:
        return None
    for handler in logger.handlers:
        if handler.name == "DefaultStreamHandler":
            rules = lambda: [rule.name for rule in workflow.rules]
            progress = Progress(Path("results/benchmarks"), planning=output.dryrun, rules=rules)
            handler.addFilter(progress.replaces)
            logger.addHandler(progress)
            return progress
    return None


def _missing(record: logging.LogRecord) -> str:
    """The name that was asked for where there is no rule for it; empty for any other record."""
    found = MISSING_RULE.search(str(record.msg)) if getattr(record, "exception", None) == "MissingRuleException" else None
    return found.group(1) if found else ""


def _logs(record: logging.LogRecord) -> list[Path]:
    return [Path(str(name).split(" ")[0]) for name in getattr(record, "log", None) or ()]


def _lines(logs: Sequence[Path]) -> list[str]:
    return [line for log in logs if log.is_file() for line in log.read_text(errors="replace").splitlines()]


def _earlier(benchmarks: Path) -> dict[str, float]:
    """Mean seconds of each rule in the benchmark files of earlier runs, ``<rule>/**/*.tsv``."""
    means = {}
    for folder in benchmarks.glob("*/"):
        seconds = []
        for path in folder.rglob("*.tsv"):
            lines = path.read_text(errors="replace").splitlines() or [""]  # one that a full disk or a cut run left empty
            first = lines[-1].split("\t")[0]
            if first.replace(".", "", 1).isdecimal():
                seconds.append(float(first))
        if seconds:
            means[folder.name] = sum(seconds) / len(seconds)
    return means


def _joined(rule: str, where: str) -> str:
    return f"{rule} {where}".rstrip()


def _shortened(reason: str, length: int = 150) -> str:
    """A reason to run in one line, with the settings that differ in place of all settings of the step."""
    if found := CHANGED_SETTINGS.search(reason):
        try:
            changed = list(_differences(*(json.loads(text) for text in found.groups())))
        except ValueError:  # several outputs with settings of their own
            changed = []
        if changed:
            reason = reason.replace(found[0], f"Settings have changed: {', '.join(changed)}")
    return reason if len(reason) <= length else f"{reason[: length - 3].rstrip(' ,')}..."


def _differences(before, now, place: str = "") -> Iterator[str]:
    """What differs between two settings, ``key: inner key: old -> new`` each."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in {**before, **now}:
            yield from _differences(before.get(key), now.get(key), f"{place}{key}: ")
    elif before != now:
        yield f"{place}{json.dumps(before)} -> {json.dumps(now)}"


def _duration(seconds: float) -> str:
    if seconds < 10:
        return f"{seconds:.1f} s"
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min"
