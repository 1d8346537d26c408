"""The program crossview, which an interruption at any moment ends in one line.

It stands outside of the package: to import that takes a second, in which nothing else would hear.
"""

from __future__ import annotations

import signal
import sys
from types import FrameType

INTERRUPTED = 130
"""Exit status, as shells have it."""


def main() -> int:
    """Run the command line; Ctrl-C and SIGTERM undo what is half done.

    Returns
    -------
    int
        Exit status.
    """
    for kind in (signal.SIGINT, signal.SIGTERM):
        signal.signal(kind, _interrupt)
    try:
        from crossview.cli import main as run

        status = run()
    except KeyboardInterrupt:
        _deafen()
        sys.stderr.write("crossview: interrupted\n")
        return INTERRUPTED
    _deafen()
    return status


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt


def _deafen() -> None:
    """Let nothing disturb what is left to do, which is to end."""
    for kind in (signal.SIGINT, signal.SIGTERM):
        signal.signal(kind, signal.SIG_IGN)
