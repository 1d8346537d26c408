"""Reader for VTK's formats: VTK runs in a process of its own, which may die."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from crossview.io.polygons import Polygons
from solvers.errors import CrossviewError

PROGRAM = Path(__file__).with_name("vtk_process.py")
"""What runs there."""

MEMORY, MEMORY_FOR_EACH = 1 << 30, 40
"""Bytes the process may take, and how many more for each byte of the file.

Measured: it starts with 0.25 GB of addresses; text and binary files take 5 to 25 times their size.
"""

SECONDS, BYTES_PER_SECOND = 8, 1 << 20
"""Processor time it may take, and one second more for each so many bytes of the file.

Measured: VTK reads 5 MB of text in a second, and its start takes 0.3.
"""

PATIENCE = 5
"""Of a process that waits, on a busy machine, how many times that by the clock. Chosen."""


def read_vtk(path: Path) -> Polygons:
    """Read a dataset in VTK's legacy or XML formats; of volumes, the outer surface.

    Raises
    ------
    CrossviewError
        The file is refused by VTK, or ends it, or takes it too much memory or time.
    """
    size = path.stat().st_size
    seconds = SECONDS + size // BYTES_PER_SECOND
    limits = [str(MEMORY + MEMORY_FOR_EACH * size), str(seconds)]
    # -P: nothing is imported from where the user happens to be
    command = [sys.executable, "-P", str(PROGRAM), path.suffix.lower(), str(path), *limits]
    try:
        ran = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PATIENCE * seconds
        )
    except subprocess.TimeoutExpired:
        raise _refused(path, "VTK found no end of it") from None
    head, _, data = ran.stdout.partition(b"\n")
    if ran.returncode or not head:
        raise _refused(path, "VTK could not read it, or would need too much memory or time")
    found = json.loads(head)
    if "refused" in found:
        raise _refused(path, found["refused"])
    n_points, n_polygons, n_corners = (found[key] for key in ("points", "polygons", "corners"))
    points = np.frombuffer(data, np.float64, 3 * n_points).reshape(-1, 3)
    numbers = np.frombuffer(data, np.int64, n_polygons + n_corners, points.nbytes)
    return Polygons(
        points.copy(), numbers[:n_polygons], numbers[n_polygons:], tuple(found["notes"])
    )


def _refused(path: Path, reason: str) -> CrossviewError:
    return CrossviewError("cannot read this file", str(path), reason)
