"""The process that works on cases, one after the other, as its parent sends them."""

from __future__ import annotations

import contextlib
import resource
import shutil
import signal
import sys
from multiprocessing.connection import Connection
from pathlib import Path

from crossview.studies.messages import At, Job, MemoryLimit
from crossview.studies.parcels import Parcel
from crossview.studies.performing import perform


def main() -> None:
    """Answer each job with the steps begun and what came of it, until the parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides when to end
    connection = Connection(int(sys.argv[1]))
    folder = Path(sys.argv[2])
    kept = folder / "kept"
    places: dict[str, str] = {}
    with contextlib.suppress(EOFError, BrokenPipeError, ConnectionResetError):
        while True:
            match connection.recv():
                case MemoryLimit(bytes=most):
                    most += _reserved()
                    with contextlib.suppress(ValueError):  # macOS refuses what is held already
                        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
                case Parcel() as parcel:
                    places[parcel.digest] = str(parcel.unpack(folder))
                case Job(task, home, digests):
                    here = {file: places[digest] for file, digest in digests.items()}
                    kept.mkdir()
                    connection.send(
                        perform(task, home, here, kept, lambda step: connection.send(At(step)))
                    )
                    shutil.rmtree(kept)
    shutil.rmtree(folder, ignore_errors=True)  # also where the parent was killed


def _reserved() -> int:
    """Bytes that libraries have reserved and do not hold; where that is not told, none."""
    try:
        status = Path("/proc/self/status").read_text("ascii")
    except OSError:
        return 0
    told = dict(line.split(":", 1) for line in status.splitlines() if ":" in line)
    data, held = (1024 * int(told[name].split()[0]) for name in ("VmData", "VmRSS"))
    return max(0, data - held)
