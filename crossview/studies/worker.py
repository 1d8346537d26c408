"""A process that works on cases within limits, seen from its parent."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from multiprocessing import Pipe

from crossview.studies.limits import Limits
from crossview.studies.messages import At, Job, MemoryLimit
from crossview.studies.outcome import DIED, OUT_OF_MEMORY, TIMED_OUT, Outcome
from crossview.studies.parcels import Parcel

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"), "1"
)
"""Of the environment: as many processes as cores leave none for further threads."""

PROGRAM = "from crossview.studies.child import main; main()"
"""What the process runs. It imports no module of the script that started the study."""

Pack = Callable[[str], Parcel]
"""From a file to its parcel."""


class Worker:
    """A process that works on one job at a time; where it ends, another takes its place.

    Parameters
    ----------
    limits : Limits
        Of each job.
    """

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.job: Job | None = None
        self._start()

    def _start(self) -> None:
        self.connection, theirs = Pipe()
        self._folder = tempfile.mkdtemp(prefix="crossview-")
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", PROGRAM, str(theirs.fileno()), self._folder],
            pass_fds=[theirs.fileno()],
            env={**os.environ, **ONE_THREAD},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        theirs.close()
        self._known: set[str] = set()
        self._begun: float | None = None
        self._step = ""
        if self.limits.gigabytes is not None:
            self.connection.send(MemoryLimit(int(1e9 * self.limits.gigabytes)))

    def give(self, job: Job, pack: Pack) -> None:
        """Begin a job.

        Parameters
        ----------
        job : Job
            What to do next; the last one has been taken.
        pack : callable
            Gives the parcels of files that this process has not had.
        """
        try:
            self._send(job, pack)
        except (BrokenPipeError, ConnectionResetError):  # it ended while it was idle
            self.end()
            self._start()
            self._send(job, pack)
        self.job = job

    def _send(self, job: Job, pack: Pack) -> None:
        for file, digest in job.digests.items():
            if digest not in self._known:
                self.connection.send(pack(file))
                self._known.add(digest)
        self.connection.send(job)

    @property
    def left(self) -> float | None:
        """Seconds until the job has to be done; None before it is begun."""
        if self._begun is None:
            return None
        return max(0.0, self._begun + self.limits.seconds - time.monotonic())

    def take(self) -> Outcome | None:
        """Return what came of the job; None if it is still worked on.

        A process that has ended, or whose time is over or memory full, is replaced.
        """
        outcome: Outcome | None = None
        try:
            while self.connection.poll():
                match self.connection.recv():
                    case At(step):
                        self._step = step
                        if self._begun is None:
                            self._begun = time.monotonic()
                    case Outcome() as outcome:
                        pass
        except (EOFError, ConnectionResetError):
            outcome = Outcome(DIED, _how(self._process.wait()), self._step, self._spent)
        if outcome is None and self.left == 0:
            reason = f"not done after {self.limits.seconds:g} s"
            outcome = Outcome(TIMED_OUT, reason, self._step, self._spent)
        if outcome is not None:
            if outcome.status in (DIED, OUT_OF_MEMORY, TIMED_OUT):
                self.end()
                self._start()
            self.job, self._begun = None, None
        return outcome

    @property
    def _spent(self) -> float:
        return 0.0 if self._begun is None else time.monotonic() - self._begun

    def end(self) -> None:
        """End the process whatever it does."""
        self.connection.close()
        self._process.kill()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


def _how(code: int) -> str:
    """Why a process ended, by its exit status."""
    if code >= 0:
        return f"the process ended with status {code}, as where memory runs out"
    name = signal.Signals(-code).name
    memory = ", as where memory runs out" if name in ("SIGKILL", "SIGABRT") else ""
    return f"the process ended by {name}{memory}"
