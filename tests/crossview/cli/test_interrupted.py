"""An interruption at any moment ends a command in one line and leaves nothing half done."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]

COMMAND = "from crossview_program import main"
MODULE = """
import runpy
from functools import partial

main = partial(runpy.run_module, "crossview", run_name="__main__", alter_sys=True)
"""

PROGRAM = """
import os, sys
sys.path.insert(0, sys.argv.pop(1))
exec(sys.argv.pop(1))

kind, counted, left = sys.argv.pop(1), sys.argv.pop(1), int(sys.argv.pop(1))

def count(event, arguments):
    global left
    if event == counted:
        left -= 1
        if left == 0:
            os.kill(os.getpid(), int(kind))

sys.addaudithook(count)
sys.exit(main())
"""


@pytest.mark.parametrize(
    ("program", "kind", "event", "number"),
    [
        (COMMAND, signal.SIGINT, "import", 1),
        (COMMAND, signal.SIGTERM, "import", 100),
        (COMMAND, signal.SIGINT, "import", 1000),
        (COMMAND, signal.SIGTERM, "open", 300),
        (COMMAND, signal.SIGINT, "os.mkdir", 1),
        (COMMAND, signal.SIGTERM, "os.mkdir", 2),
        (COMMAND, signal.SIGINT, "os.rename", 1),
        (COMMAND, signal.SIGTERM, "os.rmdir", 1),
        (MODULE, signal.SIGINT, "import", 1000),
        (MODULE, signal.SIGTERM, "os.mkdir", 1),
    ],
)
def test_it_ends_in_one_line_and_leaves_nothing(
    program: str, kind: signal.Signals, event: str, number: int, tmp_path: Path
) -> None:
    """The signal comes with the given import, opened file or change of a folder."""
    ran = subprocess.run(
        [
            *(sys.executable, "-c", PROGRAM, ROOT, program, str(int(kind)), event, str(number)),
            *("solve", "disk-4", "-o", "out", "--quiet"),
        ],
        cwd=tmp_path,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (130, "", "crossview: interrupted\n")
    # the last moment of all is after the results are in their place
    left = ["out"] if event == "os.rmdir" else []
    assert [path.name for path in tmp_path.iterdir()] == left
