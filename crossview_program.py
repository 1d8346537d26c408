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
    if getattr(sys, "frozen", False) and sys.argv[1:2] == ["-P"]:
        return _as_python(sys.argv[2:])
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


def _as_python(arguments: list[str]) -> int:
    """Do what Python would with these arguments after -P: a bundle has no other interpreter."""
    if arguments[0] == "-c":
        code, sys.argv = arguments[1], ["-c", *arguments[2:]]
        exec(compile(code, "<string>", "exec"), {"__name__": "__main__"})
    else:
        import runpy

        sys.argv = arguments
        runpy.run_path(arguments[0], run_name="__main__")
    return 0


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt


def _deafen() -> None:
    """Let nothing disturb what is left to do, which is to end."""
    for kind in (signal.SIGINT, signal.SIGTERM):
        signal.signal(kind, signal.SIG_IGN)


if __name__ == "__main__":  # of a bundle
    sys.exit(main())
