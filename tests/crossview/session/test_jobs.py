import threading
from collections.abc import Callable, Generator, Iterator

import pytest

from crossview.session.jobs import (
    Failed,
    Finished,
    JobEvent,
    LatestJobs,
    Progressed,
    Stopped,
)
from solvers.algebra import factorized, stiffness
from solvers.primitives import disk
from solvers.progress import Progress

PATIENCE = 10.0


class Heard:
    """Collects events and waits for them."""

    def __init__(self) -> None:
        self.events: list[JobEvent] = []
        self._changed = threading.Condition()

    def __call__(self, event: JobEvent) -> None:
        with self._changed:
            self.events.append(event)
            self._changed.notify_all()

    def wait_for(self, wanted: Callable[[JobEvent], bool]) -> JobEvent:
        with self._changed:
            found = self._changed.wait_for(lambda: any(map(wanted, self.events)), timeout=PATIENCE)
            assert found, self.events
            return next(event for event in self.events if wanted(event))


@pytest.fixture
def heard() -> Heard:
    return Heard()


@pytest.fixture
def jobs(heard: Heard) -> Iterator[LatestJobs]:
    jobs = LatestJobs(heard)
    yield jobs
    jobs.close()
    assert all(thread.name != "crossview-jobs" for thread in threading.enumerate())


def answer(value: int) -> Callable[[], Generator[Progress, None, int]]:
    def job() -> Generator[Progress, None, int]:
        yield Progress("half", 0.5)
        return value

    return job


def test_progress_then_result_off_the_callers_thread(jobs: LatestJobs, heard: Heard) -> None:
    threads = []

    def job() -> Generator[Progress, None, str]:
        threads.append(threading.current_thread())
        yield Progress("half", 0.5)
        return "done"

    ticket = jobs.submit(job)
    heard.wait_for(lambda e: isinstance(e, Finished))
    assert heard.events == [
        Progressed(ticket, Progress("half", 0.5)),
        Finished(ticket, "done"),
    ]
    assert threads[0] is not threading.current_thread()
    assert not jobs.busy


def test_only_the_latest_of_many_waiting_runs(jobs: LatestJobs, heard: Heard) -> None:
    started, release = threading.Event(), threading.Event()

    def unbroken() -> Generator[Progress, None, str]:
        started.set()
        release.wait(PATIENCE)
        yield from ()
        return "first"

    first = jobs.submit(unbroken)
    assert started.wait(PATIENCE)
    tickets = [jobs.submit(answer(i)) for i in range(5)]
    release.set()
    last = heard.wait_for(lambda e: isinstance(e, Finished) and e.ticket == tickets[-1])
    assert last == Finished(tickets[-1], 4)
    finished = [e.ticket for e in heard.events if isinstance(e, Finished)]
    # the one that never yields is let finish, those that waited are never begun
    assert finished == [first, tickets[-1]]


def test_a_newer_request_stops_a_running_one_at_its_next_yield(
    jobs: LatestJobs, heard: Heard
) -> None:
    at_yield, release, closed = threading.Event(), threading.Event(), threading.Event()

    def long() -> Generator[Progress, None, None]:
        try:
            while True:
                at_yield.set()
                release.wait(PATIENCE)
                yield Progress("long", 0.1)
        finally:
            closed.set()

    first = jobs.submit(long)
    assert at_yield.wait(PATIENCE)
    second = jobs.submit(answer(7))
    release.set()
    heard.wait_for(lambda e: e == Finished(second, 7))
    assert closed.is_set()
    assert Stopped(first) in heard.events
    assert heard.events.index(Stopped(first)) < heard.events.index(Finished(second, 7))


def test_a_factorisation_is_stopped_without_a_yield(jobs: LatestJobs, heard: Heard) -> None:
    matrix = stiffness(disk(edge_length=0.05).triangulation)[1:, 1:]
    begun = threading.Event()

    def endless() -> Generator[Progress, None, None]:
        yield from ()
        while True:
            factorized(matrix)
            begun.set()

    first = jobs.submit(endless)
    assert begun.wait(PATIENCE)
    second = jobs.submit(answer(2))
    heard.wait_for(lambda e: e == Finished(second, 2))
    assert heard.events[0] == Stopped(first)


def test_cancel_stops_what_runs_and_forgets_what_waits(jobs: LatestJobs, heard: Heard) -> None:
    begun, release = threading.Event(), threading.Event()

    def long() -> Generator[Progress, None, None]:
        begun.set()
        release.wait(PATIENCE)
        yield Progress("long", 0.5)

    first = jobs.submit(long)
    assert begun.wait(PATIENCE)
    second = jobs.submit(answer(1))
    jobs.cancel()
    release.set()
    heard.wait_for(lambda e: e == Stopped(first))
    third = jobs.submit(answer(3))
    heard.wait_for(lambda e: e == Finished(third, 3))
    assert all(e.ticket != second for e in heard.events)


@pytest.mark.parametrize("error", [RuntimeError("Factor is exactly singular"), KeyError("x")])
def test_whatever_is_raised_is_told_and_the_next_job_runs(
    jobs: LatestJobs, heard: Heard, error: Exception
) -> None:
    def broken() -> Generator[Progress, None, None]:
        yield Progress("start", 0.0)
        raise error

    failed = jobs.submit(broken)
    heard.wait_for(lambda e: e == Failed(failed, error))
    following = jobs.submit(answer(2))
    heard.wait_for(lambda e: e == Finished(following, 2))


def test_a_job_that_fails_before_its_first_step_is_told(jobs: LatestJobs, heard: Heard) -> None:
    error = ValueError("no")

    def broken() -> Generator[Progress, None, None]:
        raise error

    failed = jobs.submit(broken)
    heard.wait_for(lambda e: e == Failed(failed, error))


def test_a_closed_queue_takes_nothing() -> None:
    jobs = LatestJobs(lambda event: None)
    jobs.close()
    with pytest.raises(RuntimeError, match="closed"):
        jobs.submit(answer(1))
