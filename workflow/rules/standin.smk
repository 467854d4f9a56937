# Roads and drives that stand in for measured ones, made from seeds (config/standin.yaml).
# The truth about them is sealed in data/<site>/truth; nothing may read it but these rules
# and, of the drives, the one that scores a diagnosis.
for site in study.made:

    rule:
        name:
            f"standin_road_{site}"
        input:
            code=modules.of_step("standin_road"),
        output:
            crg=study.true_road(site),
            truth=f"data/{site}/truth/road.json",
        params:
            config=settings("standin_road", site),
        log:
            f"results/logs/standin_road/{site}.log",
        benchmark:
            f"results/benchmarks/standin_road/{site}.tsv"
        shell:
            "python -m ridecomfort.steps.standin_road --config {params.config:q}"
            " --output {output.crg:q} --truth {output.truth:q} 2> {log:q}"

    if study.scan(site):

        rule:
            name:
                f"standin_scan_{site}"
            input:
                code=modules.of_step("standin_scan"),
                road=study.true_road(site),
            output:
                profiles=study.scan(site)["profiles"],
                trajectory=study.scan(site)["trajectory"],
            params:
                config=settings("standin_scan", site),
            log:
                f"results/logs/standin_scan/{site}.log",
            benchmark:
                f"results/benchmarks/standin_scan/{site}.tsv"
            shell:
                "python -m ridecomfort.steps.standin_scan --road {input.road:q} --config {params.config:q}"
                " --output {output.profiles:q} --trajectory {output.trajectory:q} 2> {log:q}"

    if study.drives(site):

        rule:
            name:
                f"standin_drives_{site}"
            input:
                code=modules.of_step("standin_drives"),
                effects=study.standin_files(),
                road=study.true_road(site),
                vehicle=study.vehicle(site),
            output:
                drives=study.drives(site),
                truth=f"data/{site}/truth/drives.json",
            params:
                config=settings("standin_drives", site),
            log:
                f"results/logs/standin_drives/{site}.log",
            benchmark:
                f"results/benchmarks/standin_drives/{site}.tsv"
            shell:
                "python -m ridecomfort.steps.standin_drives --road {input.road:q}"
                " --vehicle {input.vehicle:q} --config {params.config:q}"
                " --output {output.drives:q} --truth {output.truth:q} 2> {log:q}"


# What was hidden against what was found. The only rule that reads the truth about drives; nothing but the page reads its result.
if study.scored:

    rule standin_score:
        input:
            code=modules.of_step("standin_score"),
            effects=study.library_files(),
            truth=expand("data/{site}/truth/drives.json", site=study.diagnosed),
            ranking=f"results/diagnosis/{study.model}/ranking.nc",
            verdict=f"results/diagnosis/{study.model}/verdict.json",
        output:
            expand("results/tables/{name}.{suffix}", name=catalogue.SCORE_TABLES, suffix=["csv", "md", "tex", "trace.csv"]),
            score=f"results/diagnosis/{study.model}/score.json",
            html=[
                report(
                    f"results/tables/{name}.html",
                    caption="../report/table.rst",
                    category="Missing effects",
                    labels={"table": name, "shows": caption},
                )
                for name, caption in catalogue.SCORE_TABLES.items()
            ],
        params:
            config=settings("standin_score", model=study.model),
        log:
            "results/logs/standin_score/study.log",
        benchmark:
            "results/benchmarks/standin_score/study.tsv"
        shell:
            "python -m ridecomfort.steps.standin_score --truth {input.truth:q} --verdict {input.verdict:q}"
            " --ranking {input.ranking:q} --config {params.config:q} --output {output.score:q} --tables results/tables 2> {log:q}"
