"""Damaged files of every format are answered or refused in one line, and end nothing."""

import os
import subprocess
import sys
from pathlib import Path

from crossview.io import SUFFIXES

ROOT = Path(__file__).resolve().parents[3]
CORPUS = ROOT / "tests" / "corpus"


def test_every_format_is_in_the_corpus() -> None:
    assert {path.suffix for path in CORPUS.iterdir()} >= {*SUFFIXES, ".json", ".npy", ".txt"}


def test_no_damaged_file_does_harm() -> None:
    """`make fuzz` tries many more."""
    command = [sys.executable, "-m", "tools.fuzz", "300"]
    ran = subprocess.run(
        command,
        cwd=ROOT,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ran.returncode, ran.stderr) == (0, ""), ran.stdout
    assert ran.stdout.startswith("0 faults in 300 inputs")
