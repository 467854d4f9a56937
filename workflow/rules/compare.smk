# Where the simulated drives differ from the measured ones.
rule comparison:
    input:
        code=modules.of_step("compare"),
        effects=lambda wildcards: study.effect_files(wildcards.model),
        road="results/{site}/road.nc",
        measured="results/{site}/measured.nc",
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        calibration=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc",
            site=study.calibrated_on(wildcards.site) or [],
            model=wildcards.model,
        ),
    output:
        "results/{site}/{model}/comparison.nc",
    params:
        config=lambda wildcards: study.config("compare", wildcards.site, wildcards.model),
    log:
        "results/logs/comparison/{site}/{model}.log",
    benchmark:
        "results/benchmarks/comparison/{site}/{model}.tsv"
    shell:
        "python -m ridecomfort.steps.compare --road {input.road:q} --measured {input.measured:q}"
        " --vehicle {input.vehicle:q} --calibration {input.calibration:q}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"
