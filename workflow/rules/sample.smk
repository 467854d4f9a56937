# The random inputs of a site's runs.
rule sample:
    input:
        code=modules.of_step("sample"),
    output:
        "results/{site}/samples.nc",
    params:
        config=lambda wildcards: settings("sample", wildcards.site),
    log:
        "results/logs/sample/{site}.log",
    benchmark:
        "results/benchmarks/sample/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.sample"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
