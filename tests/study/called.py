"""Snakemake called in a process that has imported it already; this module itself imports next to nothing, for the same reason."""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

server = multiprocessing.get_context("forkserver")
server.set_forkserver_preload(["snakemake.cli"])


def snakemake(words: Sequence[str]) -> tuple[int, str]:
    """Exit status of ``python -m snakemake`` with these words, and all that it and its jobs said on stdout, then on stderr.

    Every call has a process of its own, forked from one that does nothing else: to import Snakemake takes longer than to plan.
    """
    with TemporaryDirectory() as folder:
        said = [os.path.join(folder, name) for name in ("stdout", "stderr")]
        process = server.Process(target=_call, args=(words, said, dict(os.environ)))
        process.start()
        process.join()
        return process.exitcode, "".join(Path(path).read_text(encoding="utf-8") for path in said)


def _call(words: Sequence[str], said: Sequence[str], environment: Mapping[str, str]) -> None:
    from snakemake import cli

    for number, path in enumerate(said, start=1):
        os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT), number)
    sys.stdout, sys.stderr = (open(number, "w", encoding="utf-8", closefd=False) for number in (1, 2))
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = [cli.__file__, *words]
    cli.main(words)
