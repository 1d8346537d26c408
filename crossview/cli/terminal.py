"""What the command line shows: results on stdout, progress and errors on stderr."""

from __future__ import annotations

import json
import threading
from collections.abc import Generator
from typing import Any, TypeVar

from rich.console import Console

from solvers.errors import printable
from solvers.progress import Progress, run

T = TypeVar("T")

PATIENCE = 1.0
"""Seconds of work before a progress bar appears."""


def say(line: str) -> None:
    """Write a line to stdout as it is: no markup, no colour, no wrapping."""
    _write(Console(), line)


def say_json(value: Any) -> None:
    """Write a value to stdout as JSON and nothing else."""
    say(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False))


def complain(line: str) -> None:
    """Write a line to stderr as it is."""
    _write(Console(stderr=True), line)


def _write(console: Console, line: str) -> None:
    # a terminal of few letters shows the others by their numbers
    line = printable(line)
    line = line.encode(console.encoding, "backslashreplace").decode(console.encoding)
    console.print(line, markup=False, highlight=False, emoji=False, soft_wrap=True)


def watch(computation: Generator[Progress, None, T], quiet: bool = False) -> T:
    """Run a computation; show its progress on a terminal when it takes more than a second.

    Parameters
    ----------
    computation : generator of Progress
        What to run.
    quiet : bool
        Show nothing.
    """
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        return run(computation)
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    bar = Bar(
        TextColumn("{task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    )
    task = bar.add_task("starting", total=1.0)

    def show(step: Progress) -> None:
        bar.update(task, description=step.stage, completed=step.fraction)

    # a stage reports when it begins and may last, so a clock and no event brings the bar up
    patience = threading.Timer(PATIENCE, bar.start)
    patience.daemon = True
    patience.start()
    try:
        return run(computation, show)
    finally:
        patience.cancel()
        patience.join()
        if bar.live.is_started:
            bar.stop()
