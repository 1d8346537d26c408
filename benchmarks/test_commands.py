"""What a command costs in a process of its own: processor seconds, and memory."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

Measured = dict[tuple[str, int], float]

CASE = "disk-4"
MEASURE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3))
"""
"""In a small process between: what a parent takes counts in its child's ru_maxrss on Linux."""


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("help", ["--help"]),
        ("solve", ["solve", CASE, "-o", "out"]),
        ("render", ["render", CASE, "-o", "picture.png"]),
    ],
)
def test_command(measured: Measured, tmp_path: Path, name: str, arguments: list[str]) -> None:
    program = str(Path(sys.executable).with_name("crossview"))
    command = [sys.executable, "-c", MEASURE, program, *arguments]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    told = []
    for _ in range(3):
        run = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
        )
        told.append(tuple(map(float, run.stdout.split())))
    measured[name, 0] = min(seconds for seconds, _ in told)
    measured[f"{name}-memory", 0] = min(megabytes for _, megabytes in told)
