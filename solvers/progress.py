"""How long computations report: they are generators that yield `Progress` and return a result."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class Progress:
    """A step of a long computation.

    Parameters
    ----------
    stage : str
        What is being done, in plain words.
    fraction : float
        How much of the whole is done, from 0 to 1.

    Examples
    --------
    >>> from solvers import Progress
    >>> Progress("placing singularities", 0.5)
    Progress(stage='placing singularities', fraction=0.5)
    """

    stage: str
    fraction: float


def run(
    computation: Generator[Progress, None, T],
    on_progress: Callable[[Progress], object] | None = None,
) -> T:
    """Drive a computation to its end and return its result.

    Parameters
    ----------
    computation : generator of Progress
        What to run.
    on_progress : callable, optional
        Called with each `Progress`.

    Returns
    -------
    object
        What the computation returns.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import far_points
    >>> surface = disk(edge_length=0.25)
    >>> points = run(far_points(surface, [], count=2), lambda step: print(step.fraction))
    0.0
    0.5
    >>> len(points)
    2
    """
    while True:
        try:
            step = next(computation)
        except StopIteration as stop:
            result: T = stop.value
            return result
        if on_progress is not None:
            on_progress(step)


def relayed(
    computation: Generator[Progress, None, T], show: Callable[[Progress], Progress | None]
) -> Generator[Progress, None, T]:
    """Run a computation as part of another, which shows its steps in its own way.

    Parameters
    ----------
    computation : generator of Progress
        What to run; its result is returned.
    show : callable
        Takes each step to the one to yield in its place; None yields none.
    """
    while True:
        try:
            step = next(computation)
        except StopIteration as stop:
            result: T = stop.value
            return result
        shown = show(step)
        if shown is not None:
            yield shown


def between(
    computation: Generator[Progress, None, T], start: float, end: float
) -> Generator[Progress, None, T]:
    """Run a computation as part of another, its progress from `start` to `end` and never back.

    Parameters
    ----------
    computation : generator of Progress
        What to run; its result is returned.
    start, end : float
        Fractions of the whole.
    """
    reached = start

    def show(step: Progress) -> Progress:
        nonlocal reached
        reached = max(reached, start + (end - start) * step.fraction)
        return replace(step, fraction=reached)

    return relayed(computation, show)
