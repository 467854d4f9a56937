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
        config=lambda wildcards: study.config("thresholds", wildcards.site),
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
        config=lambda wildcards: study.config("iso2631", wildcards.site),
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
        config=lambda wildcards: study.config("iri", wildcards.site),
    log:
        "results/logs/iri/{site}/{model}.log",
    benchmark:
        "results/benchmarks/iri/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.iri --road {input.road:q} --shards {input.shards:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
