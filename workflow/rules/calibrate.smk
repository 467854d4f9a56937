# The vehicle's parameters that fit the drives measured on a site. With an effect more, one search begins from the fit without it.
rule calibrate:
    input:
        code=modules.of_step("calibrate"),
        effects=lambda wildcards: study.effect_files(wildcards.model),
        road="results/{site}/road.nc",
        measured=lambda wildcards: study.aligned(wildcards.site, wildcards.model),
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        below=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc", site=wildcards.site, model=models.below(study, wildcards.model) or []
        ),
    output:
        "results/{site}/{model}/calibration.nc",
    params:
        config=lambda wildcards: settings("calibrate", wildcards.site, wildcards.model),
    log:
        "results/logs/calibrate/{site}/{model}.log",
    benchmark:
        "results/benchmarks/calibrate/{site}/{model}.tsv"
    priority: 20
    threads: 2
    # The step divides its work among as many; Snakemake would have each of them do linear algebra in two threads as well.
    shell:
        "OPENBLAS_NUM_THREADS=1 python -m ridecomfort.steps.calibrate --road {input.road:q} --measured {input.measured:q}"
        " --vehicle {input.vehicle:q} --below {input.below:q} --config {params.config:q} --output {output:q} --workers {threads}"
        " 2> {log:q}"
