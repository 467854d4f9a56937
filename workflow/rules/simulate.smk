# The Monte Carlo simulation, in shards of runs that no result depends on.
rule simulate:
    wildcard_constraints:
        site="|".join(site for site in study.sites if not study.handed_in(site)) or configuration.NO_CALIBRATION,
    input:
        code=modules.of_step("simulate"),
        effects=lambda wildcards: study.effect_files(wildcards.model),
        road="results/{site}/road.nc",
        samples="results/{site}/samples.nc",
        vehicle=lambda wildcards: study.vehicle(wildcards.site),
        calibration=lambda wildcards: expand(
            "results/{site}/{model}/calibration.nc",
            site=study.calibrated_on(wildcards.site) or [],
            model=wildcards.model,
        ),
    output:
        (
            "results/{site}/{model}/drives/{runs}.nc"
            if study.settings["simulation"]["keep_drives"]
            else temp("results/{site}/{model}/drives/{runs}.nc")
        ),
    params:
        config=lambda wildcards: settings("simulate", wildcards.site, wildcards.model),
    log:
        "results/logs/simulate/{site}/{model}/{runs}.log",
    benchmark:
        "results/benchmarks/simulate/{site}/{model}/{runs}.tsv"
    shell:
        "python -m ridecomfort.steps.simulate --road {input.road:q} --samples {input.samples:q}"
        " --vehicle {input.vehicle:q} --calibration {input.calibration:q} --runs {wildcards.runs}"
        " --config {params.config:q} --output {output:q} 2> {log:q}"


# Drives that another simulator made of a site's samples, in place of the study's own.
for site in study.sites:
    if study.handed_in(site):

        rule:
            name:
                f"handed_in_{site}"
            input:
                code=modules.of_step("handed_in"),
                files=study.handed_in(site),
            output:
                temp(f"results/{site}/{{model}}/drives/{{runs}}.nc"),
            params:
                config=settings("handed_in", site),
            log:
                f"results/logs/handed_in/{site}/{{model}}/{{runs}}.log",
            benchmark:
                f"results/benchmarks/handed_in/{site}/{{model}}/{{runs}}.tsv"
            shell:
                "python -m ridecomfort.steps.handed_in --files {input.files:q} --runs {wildcards.runs}"
                " --config {params.config:q} --output {output:q} 2> {log:q}"
