# The measured drives in the study's own names and units, aligned with the road.
rule measured:
    input:
        code=modules.of_step("measured"),
        road="results/{site}/road.nc",
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        drives=lambda wildcards: study.drives(wildcards.site),
    output:
        "results/{site}/measured.nc",
    params:
        config=lambda wildcards: settings("measured", wildcards.site),
    log:
        "results/logs/measured/{site}.log",
    benchmark:
        "results/benchmarks/measured/{site}.tsv"
    threads: 2
    # The step divides its work among as many; Snakemake would have each of them do linear algebra in two threads as well.
    shell:
        "OPENBLAS_NUM_THREADS=1 python -m ridecomfort.steps.measured --road {input.road:q} --vehicle {input.vehicle:q}"
        " --drives {input.drives:q} --config {params.config:q} --output {output:q} --workers {threads} 2> {log:q}"
