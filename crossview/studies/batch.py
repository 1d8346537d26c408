"""A study from its plan to its table."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator
from functools import partial
from pathlib import Path

from crossview.io.staged_files import staged
from crossview.studies.cluster import on_cluster
from crossview.studies.ledger import Ledger, ledger
from crossview.studies.limits import Limits
from crossview.studies.messages import Job
from crossview.studies.outcome import DONE, Outcome
from crossview.studies.page import page
from crossview.studies.parcels import digest
from crossview.studies.plan import Refusal, Task, plan
from crossview.studies.processes import cores, in_processes, memory
from crossview.studies.study import Study
from crossview.studies.table import Row, as_csv, refused, row
from solvers.errors import CrossviewError
from solvers.progress import Progress

Engine = Callable[[Iterable[Job]], Iterator[tuple[Job, Outcome]]]
"""What works on jobs and yields what came of each."""

TABLE, PAGE = "table.csv", "index.html"
"""The files that tell of the whole study."""


def batch(
    study: Study,
    folder: Path,
    *,
    workers: int | None = None,
    limits: Limits = Limits(),
    scheduler: str | None = None,
) -> Generator[Progress, None, list[Row]]:
    """Run what is missing of a study in a folder, then write its table and its page.

    Parameters
    ----------
    study : Study
        What is wanted.
    folder : Path
        For the results; what has ended there is not worked on again.
    workers : int, optional
        Number of processes; one for each core if it is not given.
    limits : Limits, optional
        Of each case; without a memory limit each process has its share of the machine's.
    scheduler : str, optional
        Address of the scheduler of a dask.distributed cluster, to work there.

    Returns
    -------
    list of dict
        The rows of the table, in the order of the plan.

    Raises
    ------
    CrossviewError
        The study cannot be begun, or the folder cannot be written.
    """
    if os.name != "posix":  # its processes are given a pipe by number, and bound by the system
        raise CrossviewError("no batch runs on this system", os.name, "use Linux or macOS")
    if scheduler is None:
        crew = cores() if workers is None else workers
        if limits.gigabytes is None:
            limits = Limits(limits.seconds, memory() / crew)
        engine = partial(in_processes, limits=limits, workers=crew)
    elif workers is None:
        engine = partial(on_cluster, limits=limits, scheduler=scheduler)
    else:
        raise CrossviewError("a cluster has workers of its own", "workers", "leave the number out")
    yield Progress("planning", 0.0)
    tasks = plan(study)
    begun = [task for task in tasks if isinstance(task, Task)]
    with ledger(folder) as kept:
        try:
            yield from _work(begun, kept, limits, engine)
        finally:  # also of what there is when it is stopped
            rows = _rows(study, tasks, kept)
            with staged(folder) as staging:
                (staging / TABLE).write_text(as_csv(rows), "utf-8")
                (staging / PAGE).write_text(page(rows, tuple(study.vary), study.rank), "utf-8")
    return rows


def _work(
    tasks: list[Task], kept: Ledger, limits: Limits, engine: Engine
) -> Generator[Progress, None, None]:
    """Work on the tasks that have not ended yet, each case once."""
    missing = {
        task.key: task
        for task in tasks
        if not (task.key in kept.entries and kept.entries[task.key].stands(limits))
    }
    begun, counts = time.monotonic(), Counter[str]()
    for job, outcome in engine(_jobs(missing.values(), kept)):
        kept.add(job.task.key, outcome, limits)
        counts[outcome.status] += 1
        yield _progress(counts, len(missing), time.monotonic() - begun)


def _jobs(tasks: Iterable[Task], kept: Ledger) -> Iterator[Job]:
    for task in tasks:
        digests = {file: digest(file) for file in task.case.files}
        yield Job(task, kept.home(task.key).absolute(), digests)


def _progress(counts: Counter[str], number: int, seconds: float) -> Progress:
    """How many are done, how fast, and how long the others will take."""
    ended = counts.total()
    left = seconds / ended * (number - ended)
    others = [f"{count} {status}" for status, count in counts.items() if status != DONE]
    told = [f"{ended} of {number}", f"{ended / seconds:.3g} a second", f"{_clock(left)} left"]
    return Progress(", ".join([*told, *others]), ended / number)


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def _rows(study: Study, tasks: list[Task | Refusal], kept: Ledger) -> list[Row]:
    """The rows of the cases that have ended or cannot be begun."""
    rows = []
    for task in tasks:
        if isinstance(task, Refusal):
            rows.append(refused(task))
        elif task.key in kept.entries:
            there = kept.home(task.key).exists()
            rows.append(row(task, kept.entries[task.key], study.figures, there))
    return rows
