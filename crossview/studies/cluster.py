"""Jobs on the machines of a dask.distributed cluster."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from multiprocessing.connection import wait
from typing import Any

from crossview.studies.limits import Limits
from crossview.studies.messages import Job
from crossview.studies.outcome import DIED, Outcome
from crossview.studies.parcels import Parcel, parcel
from crossview.studies.processes import memory
from crossview.studies.worker import Worker
from solvers.errors import CrossviewError

PENDING = 4
"""Jobs for each thread of the cluster that the scheduler knows of: none waits for the next, and the
scheduler's memory does not grow with the study. Chosen."""

FEWEST_PENDING = 64
"""The same for a whole cluster that may still grow. Chosen."""

PATIENCE = "30 s"
"""How long a scheduler may take to answer. Chosen."""


def on_cluster(
    jobs: Iterable[Job], limits: Limits, scheduler: str
) -> Iterator[tuple[Job, Outcome]]:
    """Work on jobs on a cluster; yield each with what came of it, as they end.

    A job whose worker is lost goes to another one. Files travel with the first job that needs
    them, once to each worker.

    Parameters
    ----------
    jobs : iterable of Job
        Taken as threads of the cluster are free.
    limits : Limits
        Of each job.
    scheduler : str
        Address of the cluster's scheduler, such as tcp://10.0.0.1:8786.

    Raises
    ------
    CrossviewError
        dask.distributed is not installed, or the scheduler does not answer or is lost.
    """
    if find_spec("distributed") is None:
        raise CrossviewError(
            "a cluster needs dask.distributed", "not installed", 'pip install "crossview[batch]"'
        )
    from distributed import Client

    try:
        client = Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise CrossviewError(
            "the scheduler does not answer", scheduler, "name one such as tcp://10.0.0.1:8786"
        ) from error
    with client:
        yield from _followed(client, jobs, limits, scheduler)


def _followed(
    client: Any, jobs: Iterable[Job], limits: Limits, scheduler: str
) -> Iterator[tuple[Job, Outcome]]:
    """Hand out jobs as others end."""
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    waiting, pending = iter(jobs), as_completed(loop=client.loop)
    given: dict[str, Job] = {}
    files: dict[str, Any] = {}
    while True:
        room = max(FEWEST_PENDING, PENDING * sum(client.nthreads().values())) - len(given)
        for job in itertools.islice(waiting, room):
            parcels = [_sent(client, files, *named) for named in job.digests.items()]
            future = client.submit(
                work, job, limits, *parcels, key=f"crossview-{job.task.key}", pure=False
            )
            given[future.key] = job
            pending.add(future)
        if not given:
            return
        future = next(pending)
        if future.cancelled():
            raise CrossviewError("the scheduler is lost", scheduler, "start it, and this again")
        error = future.exception()
        if error is None:
            outcome = future.result()
        elif isinstance(error, KilledWorker):
            outcome = Outcome(DIED, f"{error.allowed_failures + 1} workers were lost with it")
        else:
            raise error
        yield given.pop(future.key), outcome


def _sent(client: Any, files: dict[str, Any], file: str, digest: str) -> Any:
    """The parcel of a file on the cluster: of few at a time, for the scheduler holds them."""
    if digest not in files:
        if len(files) == FEWEST_PENDING:
            files.pop(next(iter(files)))
        # a task and no scattered value: where its worker is lost the scheduler has it still
        files[digest] = client.submit(itself, parcel(file), key=f"crossview-file-{digest}")
    return files[digest]


def itself(packed: Parcel) -> Parcel:
    """Return a parcel, on the worker that has it first.

    Parameters
    ----------
    packed : Parcel
        What the others fetch from there.
    """
    return packed


_OWN = threading.local()
"""The process beside each thread of this worker."""


def work(job: Job, limits: Limits, *parcels: Parcel) -> Outcome:
    """Work on a job in a process beside this worker, one for each of its threads.

    Parameters
    ----------
    job : Job
        What to do.
    limits : Limits
        Without a memory limit a thread has its share of the worker's.
    *parcels : Parcel
        Of the files that the job names.
    """
    from distributed import get_worker

    if limits.gigabytes is None:
        here = get_worker()
        most = here.memory_manager.memory_limit
        whole = memory() if most is None else most / 1e9
        limits = Limits(limits.seconds, whole / here.state.nthreads)
    own: Worker | None = getattr(_OWN, "worker", None)
    if own is None or own.limits != limits:
        if own is not None:
            own.end()
        own = _OWN.worker = Worker(limits)
    packed = {sent.digest: sent for sent in parcels}
    own.give(job, lambda file: packed[job.digests[file]])
    while True:
        wait([own.connection], own.left)
        outcome = own.take()
        if outcome is not None:
            return outcome
