# The road as it is used: read from OpenCRG, checked and cleaned.
rule road:
    input:
        code=modules.of_step("road"),
        road=lambda wildcards: study.road(wildcards.site),
    output:
        "results/{site}/road.nc",
    params:
        config=lambda wildcards: study.config("road", wildcards.site),
    log:
        "results/logs/road/{site}.log",
    benchmark:
        "results/benchmarks/road/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.road --road {input.road:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
