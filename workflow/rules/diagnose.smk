# Which physical effect the model lacks, from the drives measured on all sites that share the first calibration.
# What it names decides which models the study goes on with.
checkpoint diagnosis:
    input:
        code=modules.of_step("diagnose"),
        effects=lambda wildcards: study.library_files(),
        roads=expand("results/{site}/road.nc", site=study.diagnosed),
        measured=expand("results/{site}/measured.nc", site=study.diagnosed),
        vehicle=study.vehicle(study.diagnosed[0]) if study.diagnosed else [],
        calibration=expand(
            "results/{site}/{model}/calibration.nc",
            site=study.calibrations[:1],
            allow_missing=True,
        ),
    output:
        ranking="results/diagnosis/{model}/ranking.nc",
        verdict="results/diagnosis/{model}/verdict.json",
    params:
        config=lambda wildcards: settings("diagnose", model=wildcards.model),
    log:
        "results/logs/diagnosis/{model}.log",
    benchmark:
        "results/benchmarks/diagnosis/{model}.tsv"
    threads: 2
    # The step divides its work among as many processes; Snakemake would have each of them do linear algebra in two
    # threads as well.
    shell:
        "OPENBLAS_NUM_THREADS=1 python -m ridecomfort.steps.diagnose --roads {input.roads:q} --measured {input.measured:q}"
        " --vehicle {input.vehicle:q} --calibration {input.calibration:q} --config {params.config:q}"
        " --ranking {output.ranking:q} --verdict {output.verdict:q} --workers {threads} 2> {log:q}"


# The evidence as tables and figures.
rule diagnosed:
    input:
        code=modules.of_step("diagnosed"),
        ranking=f"results/diagnosis/{study.model}/ranking.nc",
        verdict=f"results/diagnosis/{study.model}/verdict.json",
        later=lambda wildcards: models.later(study),
    output:
        expand("results/tables/{name}.{suffix}", name=catalogue.DIAGNOSIS_TABLES, suffix=["csv", "md", "tex", "trace.csv"]),
        expand("results/figures/{name}.pdf", name=catalogue.DIAGNOSIS_FIGURES),
        html=[
            report(
                f"results/tables/{name}.html",
                caption="../report/table.rst",
                category="Missing effects",
                labels={"table": name, "shows": caption},
            )
            for name, caption in catalogue.DIAGNOSIS_TABLES.items()
        ],
        png=[
            report(
                f"results/figures/{name}.png",
                caption="../report/figure.rst",
                category="Missing effects",
                labels={"figure": name, "shows": caption},
            )
            for name, caption in catalogue.DIAGNOSIS_FIGURES.items()
        ],
    params:
        config=settings("diagnosed", model=study.model),
    log:
        "results/logs/diagnosed/study.log",
    benchmark:
        "results/benchmarks/diagnosed/study.tsv"
    threads: 2
    shell:
        "python -m ridecomfort.steps.diagnosed --results results --later {input.later:q}"
        " --config {params.config:q} --output results --workers {threads} 2> {log:q}"
