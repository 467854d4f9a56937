# Drives over time become drives over distance; large files over time go at once.
rule space:
    input:
        code=modules.of_step("space"),
        drives="results/{site}/{model}/drives/{runs}.nc",
        road="results/{site}/road.nc",
    output:
        "results/{site}/{model}/space/{runs}.nc",
    params:
        config=lambda wildcards: settings("space", wildcards.site),
    log:
        "results/logs/space/{site}/{model}/{runs}.log",
    benchmark:
        "results/benchmarks/space/{site}/{model}/{runs}.tsv"
    priority: 10
    shell:
        "python -m ridecomfort.steps.space --drives {input.drives:q} --road {input.road:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
