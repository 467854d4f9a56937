# Where the simulated drives differ from the measured ones.
rule comparison:
    input:
        code=modules.of_step("compare"),
        effects=lambda wildcards: study.effect_files(wildcards.model),
        road="results/{site}/road.nc",
        measured=lambda wildcards: study.aligned(wildcards.site, wildcards.model),
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        calibration=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc",
            site=study.calibrated_on(wildcards.site) or [],
            model=wildcards.model,
        ),
        elsewhere=lambda wildcards: expand(
            "results/{site}/{model}/comparison.nc",
            site=study.calibrated_elsewhere(wildcards.site) or [],
            model=wildcards.model,
        ),
    output:
        "results/{site}/{model}/comparison.nc",
    params:
        config=lambda wildcards: settings("compare", wildcards.site, wildcards.model),
    log:
        "results/logs/comparison/{site}/{model}.log",
    benchmark:
        "results/benchmarks/comparison/{site}/{model}.tsv"
    # Several sites are compared side by side; the drives of one share as many threads, and would each do linear algebra in two as well.
    threads: 1 if len(study.measured) > 1 else 2
    shell:
        "OPENBLAS_NUM_THREADS=1 python -m ridecomfort.steps.compare --road {input.road:q} --measured {input.measured:q}"
        " --vehicle {input.vehicle:q} --calibration {input.calibration:q} --elsewhere {input.elsewhere:q}"
        " --config {params.config:q} --output {output:q} --workers {threads} 2> {log:q}"


# What that does to comfort: sections of the measured drives, and of the model on the same path.
rule critical:
    input:
        code=modules.of_step("critical"),
        comparison="results/{site}/{model}/comparison.nc",
    output:
        "results/{site}/{model}/critical.nc",
    params:
        config=lambda wildcards: settings("critical", wildcards.site),
    log:
        "results/logs/critical/{site}/{model}.log",
    benchmark:
        "results/benchmarks/critical/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.critical --comparison {input.comparison:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# The error of one model after another, down to the floor. Models of earlier calls are not computed again.
rule ladder:
    input:
        code=modules.of_step("ladder"),
        comparisons=lambda wildcards: models.known(study).files(study, "comparison.nc"),
        critical=lambda wildcards: models.known(study).files(study, "critical.nc"),
    output:
        f"results/ladder/{study.model}.nc",
    params:
        config=lambda wildcards, input: models.ladder_settings(study, input.comparisons),
        # Of a parameter made of `input` Snakemake does not see that it has changed, and the verdict that titles come from is no input.
        titles=lambda wildcards: models.ladder_titles(study, models.known(study).models),
    log:
        f"results/logs/ladder/{study.model}.log",
    benchmark:
        f"results/benchmarks/ladder/{study.model}.tsv"
    shell:
        "python -m ridecomfort.steps.ladder --comparisons {input.comparisons:q} --sections {input.critical:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# Where model and measurement differ on a site, drawn while the ladder is made.
rule located:
    input:
        code=modules.of_step("located"),
        measured=lambda wildcards: study.aligned(wildcards.site, study.model),
        comparison=f"results/{{site}}/{study.model}/comparison.nc",
    output:
        expand("results/figures/{name}.pdf", name=catalogue.site_figures("{site}")),
        png=[
            report(
                f"results/figures/{name}.png",
                caption="../report/figure.rst",
                category="Model and measurement",
                labels={"figure": name, "shows": caption},
            )
            for name, caption in catalogue.site_figures("{site}").items()
        ],
    params:
        config=lambda wildcards: settings("located", wildcards.site, study.model),
    log:
        "results/logs/located/{site}.log",
    benchmark:
        "results/benchmarks/located/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.located --results results"
        " --config {params.config:q} --output results/figures 2> {log:q}"


# Tables of all that, and the error ladder.
rule compared:
    input:
        code=modules.of_step("compared"),
        measured=[study.aligned(site, study.model) for site in study.measured],
        comparisons=expand("results/{site}/{model}/comparison.nc", site=study.measured, model=study.model),
        calibrations=expand(
            "results/{site}/{model}/calibration.nc",
            site={study.calibrated_on(site) for site in study.measured} - {None},
            model=study.model,
        ),
        ladder=rules.ladder.output,
    output:
        expand("results/tables/{name}.{suffix}", name=catalogue.DIFFERENCE_TABLES, suffix=["csv", "md", "tex", "trace.csv"]),
        expand("results/figures/{name}.pdf", name=catalogue.DIFFERENCE_FIGURES),
        html=[
            report(
                f"results/tables/{name}.html",
                caption="../report/table.rst",
                category="Model and measurement",
                labels={"table": name, "shows": caption},
            )
            for name, caption in catalogue.DIFFERENCE_TABLES.items()
        ],
        png=[
            report(
                f"results/figures/{name}.png",
                caption="../report/figure.rst",
                category="Model and measurement",
                labels={"figure": name, "shows": caption},
            )
            for name, caption in catalogue.DIFFERENCE_FIGURES.items()
        ],
    params:
        config=settings("compared", model=study.model),
    log:
        "results/logs/compared/study.log",
    benchmark:
        "results/benchmarks/compared/study.tsv"
    shell:
        "python -m ridecomfort.steps.compared --results results"
        " --config {params.config:q} --output results 2> {log:q}"
