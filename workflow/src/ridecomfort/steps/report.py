"""Write the page: claims, tables, figures and provenance in one HTML file that needs no network."""

import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version

from ridecomfort import __version__
from ridecomfort.report import claims, diagnosed, differing, page, tables
from ridecomfort.steps import results as study_results
from ridecomfort.steps.command import Command
from ridecomfort.store import replacing

PACKAGES = ("numpy", "scipy", "xarray", "netCDF4", "numba", "pandas", "matplotlib", "snakemake")


def main(results, later, config, output):
    study = study_results.whole(results, config, software(), later)
    made = tables.make(study)
    made |= claims.tables(study, made)
    made |= differing.tables(study.difference) if study.difference else {}
    made |= diagnosed.tables(study.diagnosis) | diagnosed.scores(study.diagnosis) if study.diagnosis else {}
    figures = {name: (results / "figures" / f"{name}.png").read_bytes() for name in page.captions(study)}
    with replacing(output) as part:
        part.write_text(page.render(study, made, figures), encoding="utf-8")


def software() -> dict[str, str]:
    """Versions of the software at work, and the commit where git knows it."""
    found = {"ridecomfort": __version__, "Python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found | commit()


def commit() -> dict[str, str]:
    """The commit of the checkout, marked where files differ from it; empty outside of git."""
    try:
        described = subprocess.run(
            ["git", "describe", "--always", "--dirty=, with changes", "--abbrev=12", "--exclude=*"],
            capture_output=True,
            text=True,
            check=True,
        )
    except (OSError, subprocess.CalledProcessError):
        return {}
    return {"commit": described.stdout.strip()}


if __name__ == "__main__":
    Command(main, inputs=("results",), many=("later",), optional=("later",)).run()
