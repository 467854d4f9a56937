# The study: from road surface to comfort tables. `snakemake -j2` makes everything.
# Steps are `python -m ridecomfort.steps.<step>`; the rules, in the order in which data flows,
# say which files they read and write. Everything that computes is in workflow/src/ridecomfort.
import os
import sys
from functools import partial
from pathlib import Path

PROJECT = Path(workflow.basedir)
sys.path.insert(0, str(PROJECT / "workflow" / "src"))

from ridecomfort import config as configuration
from ridecomfort import modules, stepsettings
from ridecomfort.errors import InputError
from ridecomfort.report import catalogue
from ridecomfort.schema import read_yaml
from ridecomfort.steps import models, progress
from ridecomfort.study import has_fit

os.environ.update(
    PATH=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]),
    PYTHONPATH=str(PROJECT / "workflow" / "src"),
    NUMBA_CACHE_DIR=str(PROJECT / ".cache" / "numba" / modules.compiled()),
    RIDECOMFORT_CACHE=str(PROJECT / ".cache"),
    OPENBLAS_NUM_THREADS="1",  # jobs run side by side
)


try:
    read_yaml("config/study.yaml")  # Snakemake would name neither the file nor the line
except InputError as problem:
    sys.exit(f"error: {problem}")


configfile: "config/study.yaml"


# Only with `--software-deployment-method apptainer`; else the environment of `make env`.
container: "docker://python:3.11-bookworm"


try:
    study = configuration.load(config, given=workflow.config_settings.config)
except InputError as problem:
    sys.exit(f"error: {problem}")

asked = {"compare", "diagnose"} & set(sys.argv)
if asked and not study.measured:
    sites = ", ".join(study.names)
    sys.exit(f"error: no site of {sites} has measured drives, so that there is nothing to {min(asked)} (expected drives in its file)")
if "diagnose" in asked and not study.diagnosed:
    sites = ", ".join(study.measured)
    sys.exit(f"error: all drives of {sites} are held out, so that there is nothing to diagnose on (expected drives with role: fit)")

beside = [site for site in study.measured if site not in study.diagnosed]
with_fit = [site for site in beside if study.calibrated_on(site) or has_fit(study.sites[site])]
held_out = [site for site in beside if site not in with_fit]
is_nominal = lambda site: study.calibrated_on(site) is None and study.vehicle(site) == study.vehicle(study.diagnosed[0])
nominal = [site for site in with_fit if is_nominal(site)]
others = [site for site in with_fit if site not in nominal]
searched = ", ".join(study.diagnosed)
if "diagnose" in asked and others:
    print(f"{', '.join(others)}: not diagnosed, being of another car than {searched} (expected alone: --config sites=[{others[0]}])", file=sys.stderr)
if "diagnose" in asked and nominal:
    why = f"being compared with the nominal vehicle, not the calibrated one of {searched}"
    print(f"{', '.join(nominal)}: not diagnosed, {why} (expected alone: --config sites=[{nominal[0]}])", file=sys.stderr)
if "diagnose" in asked and held_out:
    print(f"{', '.join(held_out)}: not diagnosed, being calibrated nowhere, with all drives held out (expected drives with role: fit)", file=sys.stderr)

followed = progress.follow(workflow)


onerror:
    if followed is not None:
        followed.left_undone()


settings = partial(stepsettings.as_json, study)


wildcard_constraints:
    site="|".join(study.sites),
    model=r"[A-Za-z0-9_+]+",
    runs=r"\d+-\d+",


# Tables and figures are asked for, too: Snakemake does not look for deleted files behind a page that is up to date.
rule all:
    input:
        "results/report.html",
        [study.maps(site) for site in study.names],
        lambda wildcards: [*rules.tables.output, *rules.figures.output, *located],
        lambda wildcards: after_the_verdict(wildcards),


for site in study.names:

    rule:
        name:
            site
        input:
            expand(
                "results/{site}/{model}/comfort/{method}.nc",
                site=site,
                model=study.model,
                method=["thresholds", "iso2631", "iri"],
            ),
            study.maps(site),
            expand(
                "results/{site}/{model}/comparison.nc",
                site=[site] if study.drives(site) else [],
                model=study.model,
            ),


rule compare:
    input:
        expand("results/{site}/{model}/comparison.nc", site=study.measured, model=study.model),
        lambda wildcards: [*rules.compared.output, *located] if study.measured else [],


rule diagnose:
    input:
        expand("results/diagnosis/{model}/{file}", model=study.model, file=["ranking.nc", "verdict.json"]) if study.diagnosed else [],
        lambda wildcards: rules.diagnosed.output if study.diagnosed else [],


report: "workflow/report/study.rst"


include: "workflow/rules/standin.smk"
include: "workflow/rules/road.smk"
include: "workflow/rules/measured.smk"
include: "workflow/rules/calibrate.smk"
include: "workflow/rules/sample.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/space.smk"
include: "workflow/rules/comfort.smk"
include: "workflow/rules/compare.smk"
include: "workflow/rules/diagnose.smk"
include: "workflow/rules/report.smk"
