# Which physical effect the model lacks, from the drives measured on all sites of the calibrated vehicle.
rule diagnosis:
    input:
        code=modules.of_step("diagnose"),
        effects=lambda wildcards: study.library_files(),
        roads=expand("results/{site}/road.nc", site=study.diagnosed),
        measured=expand("results/{site}/measured.nc", site=study.diagnosed),
        vehicle=study.vehicle(study.diagnosed[0]) if study.diagnosed else [],
        calibration=expand(
            "results/{site}/{model}/calibration.nc",
            site=study.calibrations[:1],
            allow_missing=True,
        ),
    output:
        ranking="results/diagnosis/{model}/ranking.nc",
        verdict="results/diagnosis/{model}/verdict.json",
    params:
        config=lambda wildcards: study.config("diagnose", model=wildcards.model),
    log:
        "results/logs/diagnosis/{model}.log",
    benchmark:
        "results/benchmarks/diagnosis/{model}.tsv"
    threads: 2
    shell:
        "python -m ridecomfort.steps.diagnose --roads {input.roads:q} --measured {input.measured:q}"
        " --vehicle {input.vehicle:q} --calibration {input.calibration:q} --config {params.config:q}"
        " --ranking {output.ranking:q} --verdict {output.verdict:q} 2> {log:q}"
