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


# The same drives aligned for a model: what its vehicle and effects do late passes for an error of the clock where they are not known.
rule realigned:
    input:
        code=modules.of_step("realigned"),
        effects=lambda wildcards: study.effect_files(wildcards.model),
        road="results/{site}/road.nc",
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        drives=lambda wildcards: study.drives(wildcards.site),
        before=lambda wildcards: models.aligned_before(study, wildcards.site, wildcards.model),
        below=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc",
            site=wildcards.site if study.is_fitted(wildcards.site) else [],
            model=models.below(study, wildcards.model) or [],
        ),
        calibration=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc",
            site=[] if study.is_fitted(wildcards.site) else study.calibrated_elsewhere(wildcards.site) or [],
            model=wildcards.model,
        ),
    output:
        "results/{site}/{model}/measured.nc",
    params:
        config=lambda wildcards: settings("realigned", wildcards.site, wildcards.model),
    log:
        "results/logs/realigned/{site}/{model}.log",
    benchmark:
        "results/benchmarks/realigned/{site}/{model}.tsv"
    priority: 20
    threads: 2
    # The step divides its work among as many; Snakemake would have each of them do linear algebra in two threads as well.
    shell:
        "OPENBLAS_NUM_THREADS=1 python -m ridecomfort.steps.realigned --road {input.road:q} --vehicle {input.vehicle:q}"
        " --drives {input.drives:q} --before {input.before:q} --below {input.below:q} --calibration {input.calibration:q}"
        " --config {params.config:q} --output {output:q} --workers {threads} 2> {log:q}"
