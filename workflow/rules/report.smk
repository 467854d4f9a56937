# Tables, figures and the page, from the results of all sites.
results = [
    *expand("results/{site}/{file}.nc", site=study.names, file=["road", "samples", "inspection"]),
    *expand(
        "results/{site}/{model}/comfort/{method}.nc",
        site=study.names,
        model=study.model,
        method=["thresholds", "iso2631", "iri"],
    ),
    *expand("results/comfort/{model}/agreement.nc", model=study.model),
    *expand("results/{site}/{model}/calibration.nc", site=study.calibrations, model=study.model),
    *expand("results/{site}/{model}/comparison.nc", site=study.measured, model=study.model),
]
tables = catalogue.tables(stepsettings.summaries(study))
figures = catalogue.figures(stepsettings.summaries(study))
located = [
    f"results/figures/{name}.{suffix}" for site in study.measured for name in catalogue.site_figures(site) for suffix in ("png", "pdf")
]


rule tables:
    input:
        results,
        code=modules.of_step("tables"),
    output:
        expand("results/tables/{name}.{suffix}", name=tables, suffix=["csv", "md", "tex", "trace.csv"]),
        html=[
            report(
                f"results/tables/{name}.html",
                caption="../report/table.rst",
                category="Tables",
                labels={"table": name, "shows": caption},
            )
            for name, caption in tables.items()
        ],
    params:
        config=settings("tables", model=study.model),
    log:
        "results/logs/tables/study.log",
    benchmark:
        "results/benchmarks/tables/study.tsv"
    shell:
        "python -m ridecomfort.steps.tables --results results"
        " --config {params.config:q} --output results/tables 2> {log:q}"


rule figures:
    input:
        results,
        code=modules.of_step("figures"),
    output:
        expand("results/figures/{name}.pdf", name=figures),
        png=[
            report(
                f"results/figures/{name}.png",
                caption="../report/figure.rst",
                category="Figures",
                labels={"figure": name, "shows": caption},
            )
            for name, caption in figures.items()
        ],
    params:
        config=settings("figures", model=study.model),
    log:
        "results/logs/figures/study.log",
    benchmark:
        "results/benchmarks/figures/study.tsv"
    threads: 2
    shell:
        "python -m ridecomfort.steps.figures --results results"
        " --config {params.config:q} --output results/figures --workers {threads} 2> {log:q}"


# The error ladder needs the verdicts first: what they name decides which models stand on it, and the last of these is diagnosed again until
# nothing more is named.
after_the_verdict = lambda wildcards: [
    *(map(models.verdict_file, models.diagnosed(study, lambda model: checkpoints.diagnosis.get(model=model))) if study.forward else []),
    *(rules.diagnosed.output if study.forward else []),
    *(rules.standin_score.output if study.scored else []),
    *(rules.compared.output if study.measured else []),
]


rule report:
    input:
        results,
        rules.tables.output,
        rules.figures.output,
        located,
        after_the_verdict,
        code=modules.of_step("report"),
        later=lambda wildcards: models.later(study),
    output:
        "results/report.html",
    params:
        config=settings("report", model=study.model),
    log:
        "results/logs/report/study.log",
    benchmark:
        "results/benchmarks/report/study.tsv"
    shell:
        "python -m ridecomfort.steps.report --results results --later {input.later:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
