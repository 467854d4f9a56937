"""What a person sees of a run, from the records that Snakemake logs."""

import io
import json
import logging
import re
import sys

import pytest

from ridecomfort.report import catalogue
from ridecomfort.steps import command, progress


class Clock:
    now = 0.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(progress, "time", clock)
    return clock


@pytest.fixture
def watched(tmp_path, clock):
    stream = io.StringIO()
    handler = progress.Progress(tmp_path / "benchmarks", stream)
    handler.said = lambda: stream.getvalue().splitlines()
    return handler


def log(handler, event, **fields):
    handler.emit(logging.makeLogRecord({"event": event, "msg": None, **fields}))


def start(handler, number, rule, logs=(), **wildcards):
    log(handler, "job_info", jobid=number, rule_name=rule, wildcards=wildcards, benchmark="b.tsv", log=[str(one) for one in logs])


def test_time_left_is_that_of_the_jobs_to_come_shared_among_those_that_run(watched, clock):
    log(watched, "run_info", stats={"simulate": 10, "all": 1, "total": 11})
    for number in (1, 2):
        start(watched, number, "simulate", site="ts1", runs=f"{number}")
    clock.now = 8.0
    for number in (1, 2):
        log(watched, "job_finished", job_id=number)
        start(watched, number + 2, "simulate", site="ts1", runs=f"{number + 2}")
    # Eight shards, by two at a time, the target as long as a shard: nine of 8 s.
    assert watched.time_left() == pytest.approx((8 * 8 + 8) / 2)
    assert watched.said()[-1] == "[ 18 %] simulate ts1 2 done in 8.0 s (2 of 10 such jobs); 9 to go, about 36 s"


def test_a_job_that_takes_minutes_says_where_to_look_how_far_it_is(watched):
    log(watched, "job_info", jobid=1, rule_name="diagnosis", wildcards={"model": "base"}, benchmark="b.tsv", log=["logs/base.log"])
    assert watched.said()[-1].endswith("diagnosis base ... (how far: logs/base.log)")


def test_what_a_step_notes_is_shown_and_the_rest_of_its_log_is_not(watched, tmp_path, capsys):
    path = tmp_path / "base.log"
    print("round 1: suspension_friction", file=sys.stderr)
    command.note("Missing: suspension_friction.")
    path.write_text(capsys.readouterr().err)
    log(watched, "run_info", stats={"diagnosis": 1, "diagnose": 1, "total": 2})
    start(watched, 1, "diagnosis", [path], model="base")
    log(watched, "job_finished", job_id=1)
    done, found = watched.said()[1:]
    assert "diagnosis base done" in done and found.strip() == "Missing: suspension_friction."


def test_what_a_step_notes_stands_at_the_end_again_but_for_a_verdict(watched, tmp_path, capsys):
    """A run of many jobs scrolls it away."""
    path = tmp_path / "here.log"
    log(watched, "run_info", stats={"comparison": 1, "diagnosis": 1, "total": 2})
    for number, (rule, words) in enumerate((("comparison", "a_y runs against the model"), ("diagnosis", "Missing: suspension_friction."))):
        command.note(words)
        path.write_text(capsys.readouterr().err)
        start(watched, number, rule, [path])
        log(watched, "job_finished", job_id=number)
    assert watched.said()[-1] == "said above: a_y runs against the model" and "all done" in watched.said()[-2]


def test_a_run_ends_with_100_percent_and_the_page(watched, clock):
    log(watched, "run_info", stats={"report": 1, "all": 1, "total": 2})
    start(watched, 1, "report")
    clock.now = 4.0
    log(watched, "job_finished", job_id=1)
    log(watched, "job_info", jobid=2, rule_name="all", wildcards={}, benchmark=None)
    log(watched, "job_finished", job_id=2)
    assert watched.said()[-2:] == ["[ 50 %] report done in 4.0 s; 1 to go", "[100 %] all done in 4.0 s; the page: results/report.html"]


def test_a_run_without_the_page_ends_with_what_there_is_to_look_at(watched, clock):
    log(watched, "run_info", stats={"compared": 1, "diagnosed": 1, "total": 2})
    for number, rule in enumerate(("compared", "diagnosed")):
        start(watched, number, rule)
        log(watched, "job_finished", job_id=number)
    assert watched.said()[-3].startswith("[100 %] all done") and "results/report.html" not in watched.said()[-3]
    assert watched.said()[-2].startswith("look at results/tables/alignment.md")
    assert watched.said()[-1].startswith("look at results/tables/verdict.md")


def test_what_there_is_to_look_at_is_made():
    made = [*catalogue.DIFFERENCE_TABLES, *catalogue.difference_figures(["*"]), *catalogue.DIAGNOSIS_TABLES, *catalogue.DIAGNOSIS_FIGURES]
    named = re.findall(r"([\w*]+)\.(?:md|png)", " ".join(progress.TO_LOOK_AT.values()))
    assert len(named) > 6 and set(named) <= set(made)


def test_jobs_that_a_checkpoint_adds_count(watched, clock):
    log(watched, "run_info", stats={"diagnosis": 1, "report": 1, "total": 2})
    for number, rule in enumerate(("diagnosis", "calibrate", "report")):
        start(watched, number, rule)
        log(watched, "job_finished", job_id=number)
    shares = [int(line[1:4]) for line in watched.said() if " done in" in line]
    assert shares == [50, 66, 100, 100] and watched.said()[-1].startswith("[100 %] all done")


def test_what_is_done_never_becomes_less(watched):
    log(watched, "run_info", stats={"diagnosis": 1, "report": 1, "total": 2})
    for number, rules in enumerate((["diagnosis"], ["calibrate", "compare"])):
        for rule in rules:
            start(watched, f"{number} {rule}", rule)
        for rule in rules:
            log(watched, "job_finished", job_id=f"{number} {rule}")
    assert [int(line[1:4]) for line in watched.said()] == [0, 50, 50, 50, 50, 75]


def test_a_start_names_the_shard(watched):
    log(watched, "run_info", stats={"simulate": 2, "total": 2})
    start(watched, 1, "simulate", site="ts1", model="base", runs="0000-0249")
    assert watched.said() == ["[  0 %] simulate ts1 base 0000-0249 ..."]


def test_a_plan_says_which_settings_changed(tmp_path):
    stream = io.StringIO()
    handler = progress.Progress(tmp_path, stream, planning=True)
    thresholds = {"VG": [0.95] * 50}
    before, now = ({"site": "one", "iri": {"thresholds": thresholds, "segment": segment}} for segment in (50, 25))
    reason = (
        "Params have changed since last execution: Union of exclusive params before and now across all output: "
        f"before: '{json.dumps(before)}' now: '{json.dumps(now)}' ; Code has changed"
    )
    log(handler, "job_info", jobid=1, rule_name="iri", wildcards={"site": "one"}, benchmark=None, reason=reason)
    assert stream.getvalue() == "iri one: Settings have changed: iri: segment: 50 -> 25; Code has changed\n"


@pytest.mark.parametrize(("asked", "hint"), [("mysite", "to choose the site append --config sites=[mysite]"), ("other", "see README.md")])
def test_a_site_that_has_a_file_and_is_not_of_the_study_is_no_unknown_name(watched, tmp_path, monkeypatch, asked, hint):
    (tmp_path / "config" / "sites").mkdir(parents=True)
    (tmp_path / "config" / "sites" / "mysite.yaml").touch()
    monkeypatch.chdir(tmp_path)
    log(watched, "error", exception="MissingRuleException", msg=f"No rule to produce {asked} (if you use input functions ...)")
    assert watched.said() == [f"error: {asked}: no site of the study and no target of this name; {hint}"]


def test_no_guess_before_the_main_rule_was_timed(watched, clock):
    log(watched, "run_info", stats={"road": 1, "simulate": 10, "total": 11})
    start(watched, 1, "road", site="ts1")
    clock.now = 1.0
    log(watched, "job_finished", job_id=1)
    assert watched.said()[-1] == "[  9 %] road ts1 done in 1.0 s; 10 to go"


def test_earlier_runs_give_a_first_guess_as_far_as_their_benchmarks_hold_numbers(tmp_path, clock):
    folder = tmp_path / "benchmarks" / "simulate" / "ts1"
    folder.mkdir(parents=True)
    for number, seconds in enumerate([4.0, 6.0]):
        (folder / f"{number}.tsv").write_text(f"s\th:m:s\n{seconds}\t0:00:05\n")
    (folder / "empty.tsv").touch()
    (folder / "cut.tsv").write_text("s\th:m:s\n")
    handler = progress.Progress(tmp_path / "benchmarks", io.StringIO())
    log(handler, "run_info", stats={"simulate": 10, "total": 10})
    assert handler.time_left() == pytest.approx(50.0)


@pytest.mark.parametrize(("rule", "is_done", "is_there", "said"), [
    ("diagnosis", False, True, True), ("measured", False, True, True), ("report", True, True, False), ("diagnosis", False, False, False),
])  # fmt: skip
def test_a_run_that_ends_before_its_diagnosis_says_that_the_verdict_there_is_older(watched, tmp_path, monkeypatch, rule, is_done, is_there, said):
    monkeypatch.chdir(tmp_path)
    verdict = tmp_path / progress.VERDICT
    verdict.parent.mkdir(parents=True)
    if is_there:
        verdict.write_text("| verdict |")
    log(watched, "run_info", stats={rule: 1, "diagnosed": 1, "total": 2})
    if is_done:
        start(watched, 1, "diagnosed")
        log(watched, "job_finished", job_id=1)
    start(watched, 2, rule)
    log(watched, "job_error", jobid=2, rule_name=rule, log=[])
    watched.left_undone()
    assert (progress.VERDICT in watched.said()[-1] and "earlier diagnosis" in watched.said()[-1]) is said


@pytest.mark.parametrize(("rule", "behind", "is_said"), [("diagnosis", "report", True), ("comparison", "compared", False)])
def test_so_does_the_whole_study_that_plans_its_tables_behind_the_diagnosis_and_no_run_without_one(
    watched, tmp_path, monkeypatch, rule, behind, is_said
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / progress.VERDICT).parent.mkdir(parents=True)
    (tmp_path / progress.VERDICT).write_text("| verdict |")
    log(watched, "run_info", stats={rule: 1, behind: 1, "total": 2})
    start(watched, 1, rule)
    log(watched, "job_error", jobid=1, rule_name=rule, log=[])
    watched.left_undone()
    assert ("earlier diagnosis" in " ".join(watched.said())) is is_said


def test_a_users_mistake_is_one_line(watched, tmp_path):
    (tmp_path / "road.log").write_text("error: data/a/road.crg: 3e38 m, expected less\n")
    start(watched, 1, "road", site="a")
    log(watched, "job_error", jobid=1, rule_name="road", log=[f"{tmp_path / 'road.log'} (check log file(s))"])
    assert watched.said()[-1] == "[  0 %] road a failed: error: data/a/road.crg: 3e38 m, expected less"


def test_an_unexpected_failure_shows_its_log(watched, tmp_path):
    (tmp_path / "road.log").write_text("Traceback\n  File x\nZeroDivisionError: division by zero\n")
    start(watched, 1, "road", site="a")
    log(watched, "job_error", jobid=1, rule_name="road", log=[str(tmp_path / "road.log")])
    assert "see " in watched.said()[-4] and watched.said()[-1].strip() == "ZeroDivisionError: division by zero"


@pytest.mark.parametrize(("event", "kept"), [("job_info", False), ("run_info", True), (None, True)])
def test_snakemake_keeps_its_other_lines(watched, event, kept):
    record = logging.makeLogRecord({"event": event, "msg": "text"})
    assert watched.replaces(record) is kept
