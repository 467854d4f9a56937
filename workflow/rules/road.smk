# From a laser scan to the road of a site that has no file of it.
rule survey:
    input:
        code=modules.of_step("survey"),
        scan=lambda wildcards: study.scan(wildcards.site)["profiles"],
        trajectory=lambda wildcards: study.scan(wildcards.site)["trajectory"],
    output:
        crg="results/{site}/road.crg",
        gridded="results/{site}/scan.nc",
    params:
        config=lambda wildcards: settings("survey", wildcards.site),
    log:
        "results/logs/survey/{site}.log",
    benchmark:
        "results/benchmarks/survey/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.survey --scan {input.scan:q} --trajectory {input.trajectory:q}"
        " --config {params.config:q} --output {output.crg:q} --gridded {output.gridded:q} 2> {log:q}"


# The road as it is used: read from OpenCRG, checked and cleaned.
rule road:
    input:
        code=modules.of_step("road"),
        road=lambda wildcards: study.road(wildcards.site),
    output:
        "results/{site}/road.nc",
    params:
        config=lambda wildcards: settings("road", wildcards.site),
    log:
        "results/logs/road/{site}.log",
    benchmark:
        "results/benchmarks/road/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.road --road {input.road:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# What the road is like, and what repairing and smoothing it changes.
rule inspect:
    input:
        code=modules.of_step("inspect"),
        road=lambda wildcards: study.road(wildcards.site),
        gridded=lambda wildcards: study.gridded(wildcards.site),
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
    output:
        "results/{site}/inspection.nc",
    params:
        config=lambda wildcards: settings("inspect", wildcards.site),
    log:
        "results/logs/inspect/{site}.log",
    benchmark:
        "results/benchmarks/inspect/{site}.tsv"
    shell:
        "python -m ridecomfort.steps.inspect --road {input.road:q} --gridded {input.gridded:q}"
        " --vehicle {input.vehicle:q} --config {params.config:q} --output {output:q} 2> {log:q}"
