# The three comfort methods: acceleration thresholds, ISO 2631, IRI.
rule thresholds:
    input:
        code=modules.of_step("thresholds"),
        shards=expand(
            "results/{site}/{model}/space/{runs}.nc", runs=study.shards, allow_missing=True
        ),
    output:
        "results/{site}/{model}/comfort/thresholds.nc",
    params:
        config=lambda wildcards: settings("thresholds", wildcards.site),
    log:
        "results/logs/thresholds/{site}/{model}.log",
    benchmark:
        "results/benchmarks/thresholds/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.thresholds --shards {input.shards:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


rule iso2631:
    input:
        code=modules.of_step("iso2631"),
        shards=expand(
            "results/{site}/{model}/space/{runs}.nc", runs=study.shards, allow_missing=True
        ),
    output:
        "results/{site}/{model}/comfort/iso2631.nc",
    params:
        config=lambda wildcards: settings("iso2631", wildcards.site),
    log:
        "results/logs/iso2631/{site}/{model}.log",
    benchmark:
        "results/benchmarks/iso2631/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.iso2631 --shards {input.shards:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


rule iri:
    input:
        code=modules.of_step("iri"),
        road="results/{site}/road.nc",
        shards=expand(
            "results/{site}/{model}/space/{runs}.nc", runs=study.shards, allow_missing=True
        ),
    output:
        "results/{site}/{model}/comfort/iri.nc",
    params:
        config=lambda wildcards: settings("iri", wildcards.site),
    log:
        "results/logs/iri/{site}/{model}.log",
    benchmark:
        "results/benchmarks/iri/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.iri --road {input.road:q} --shards {input.shards:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# How far the methods agree over all sites, what the runs' inputs do, how many runs are enough.
rule agreement:
    input:
        code=modules.of_step("agreement"),
        thresholds=expand(
            "results/{site}/{model}/comfort/thresholds.nc", site=study.names, allow_missing=True
        ),
        iso2631=expand(
            "results/{site}/{model}/comfort/iso2631.nc", site=study.names, allow_missing=True
        ),
        iri=expand("results/{site}/{model}/comfort/iri.nc", site=study.names, allow_missing=True),
        samples=expand("results/{site}/samples.nc", site=study.names),
    output:
        "results/comfort/{model}/agreement.nc",
    params:
        config=settings("agreement"),
    log:
        "results/logs/agreement/{model}.log",
    benchmark:
        "results/benchmarks/agreement/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.agreement --thresholds {input.thresholds:q}"
        " --iso2631 {input.iso2631:q} --iri {input.iri:q} --samples {input.samples:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# Critical sections on the reference line, for planners and digital maps.
rule maps:
    input:
        code=modules.of_step("maps"),
        road="results/{site}/road.nc",
        comfort=expand(
            "results/{site}/{model}/comfort/{method}.nc",
            model=study.model,
            method=["thresholds", "iso2631", "iri"],
            allow_missing=True,
        ),
    output:
        study.maps("{site}"),
    params:
        config=lambda wildcards: settings("maps", wildcards.site),
    log:
        f"results/logs/maps/{{site}}/{study.model}.log",
    benchmark:
        f"results/benchmarks/maps/{{site}}/{study.model}.tsv"
    shell:
        "python -m ridecomfort.steps.maps --road {input.road:q} --thresholds {input.comfort[0]:q}"
        " --iso2631 {input.comfort[1]:q} --iri {input.comfort[2]:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
