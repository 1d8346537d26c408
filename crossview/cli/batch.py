"""crossview batch: the cases of a study, each on its own, into one table."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from crossview.cli.options import Output, Quiet
from crossview.cli.terminal import say, watch
from crossview.studies import TIME_LIMIT, Limits, Study
from crossview.studies import batch as run_study
from solvers.number_checks import whole_number


def batch(
    study: str,
    /,
    *,
    output: Output,
    workers: int | None = None,
    time_limit: float = TIME_LIMIT,
    memory_limit: float | None = None,
    scheduler: str | None = None,
    quiet: Quiet = False,
) -> None:
    """Run the cases of a study in several processes; write a table and a page of all figures.

    A case that fails, takes too long or too much memory is a row with its reason. What has ended in
    the folder before is not worked on again.

    Parameters
    ----------
    study
        A study file: cases, what varies, and the steps to take.
    output
        Folder for table.csv, index.html and the files that are kept of each case.
    workers
        Number of processes; one for each core if not given.
    time_limit
        Seconds that a case may take.
    memory_limit
        Gigabytes that a case may take; a process's share of the machine if not given.
    scheduler
        Address of the scheduler of a dask.distributed cluster, to work there.
    """
    found = Study.load(study)
    if workers is not None:
        workers = whole_number("--workers", workers, 1)
    limits = Limits(time_limit, memory_limit)
    computation = run_study(
        found, Path(output), workers=workers, limits=limits, scheduler=scheduler
    )
    rows = watch(computation, quiet)
    if not quiet:
        ended = Counter(row["status"] for row in rows)
        told = ", ".join(f"{count} {status}" for status, count in ended.most_common())
        say(f"{told}; wrote {Path(output)}")
