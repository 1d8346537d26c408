"""Measures distances and angles on the surface, beside all other work."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from functools import partial
from itertools import pairwise

from crossview.session.background import Background
from crossview.session.hand import MeasureTool, SelectTool
from crossview.session.loop import Loop
from crossview.session.store import Store
from solvers.progress import Progress
from solvers.surface import FloatArray, SurfacePoint, TriSurface, shortest_path

MOST = 3
"""Places of one measurement: the next click begins another."""


class Measuring:
    """Takes the tool that measures, and the places that it is to measure between.

    Parameters
    ----------
    store : Store
    loop : Loop
        The thread that answers come on.
    """

    def __init__(self, store: Store, loop: Loop) -> None:
        self._store = store
        self._background = Background(loop)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy

    def close(self) -> None:
        """End the background thread."""
        self._background.close()

    def take_tool(self) -> None:
        """Take the tool that measures, or put it back when it is in hand."""
        state = self._store.state
        self._store.update(state.tool_taken(SelectTool() if state.measure_tool else MeasureTool()))

    def click(self, place: SurfacePoint) -> None:
        """Measure from a place of the document's surface, or to it."""
        document, tool = self._store.state.document, self._store.state.measure_tool
        if document is None or tool is None:
            return
        goes_on = len(tool.places) < MOST
        taken = MeasureTool((*tool.places, place), tool.paths) if goes_on else MeasureTool((place,))
        self._store.update(self._store.state.tool_taken(taken))
        if len(taken.places) > 1:
            job = partial(_paths, document.surface, taken.places)
            done = partial(self._show, taken)
            self._background.submit(job, done, lambda error: self._store.fail(error, "measure"))

    def _show(self, taken: MeasureTool, paths: tuple[FloatArray, ...]) -> None:
        if self._store.state.tool is taken:
            self._store.update(self._store.state.tool_taken(replace(taken, paths=paths)))


def _paths(
    surface: TriSurface, places: tuple[SurfacePoint, ...]
) -> Generator[Progress, None, tuple[FloatArray, ...]]:
    yield Progress("measuring", 0.0)
    return tuple(shortest_path(surface, one, other) for one, other in pairwise(places))
