"""Jobs in processes of this machine."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterable, Iterator
from multiprocessing.connection import wait

from crossview.studies.limits import Limits
from crossview.studies.messages import Job
from crossview.studies.outcome import Outcome
from crossview.studies.parcels import parcel
from crossview.studies.worker import Worker


def in_processes(
    jobs: Iterable[Job], limits: Limits, workers: int
) -> Iterator[tuple[Job, Outcome]]:
    """Work on jobs in processes of this machine; yield each with what came of it, as they end.

    Parameters
    ----------
    jobs : iterable of Job
        Taken as processes are free.
    limits : Limits
        Of each job.
    workers : int
        Number of processes.
    """
    waiting, crew = iter(jobs), []
    try:
        for job in waiting:
            crew.append(Worker(limits))
            crew[-1].give(job, parcel)
            if len(crew) == workers:
                break
        busy = list(crew)
        while busy:
            left = [worker.left for worker in busy]
            wait(
                [worker.connection for worker in busy],
                min((seconds for seconds in left if seconds is not None), default=None),
            )
            for worker in list(busy):
                done, outcome = worker.job, worker.take()
                if done is None or outcome is None:
                    continue
                busy.remove(worker)
                for following in itertools.islice(waiting, 1):
                    worker.give(following, parcel)
                    busy.append(worker)
                yield done, outcome
    finally:
        for worker in crew:
            worker.end()


def cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def memory() -> float:
    """Memory of this machine, in 1e9 bytes."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9
