"""Which colour ranges stay as they are, so that pictures can be compared."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from crossview.session.state import SessionState
from crossview.view.scalars import density_limits
from crossview.workflow.problem import Problem

Range = tuple[float, float]
Ranges = Mapping[str, Range]
NO_RANGES: Ranges = MappingProxyType({})
"""Where nothing is held."""

HELD = {"H": ("H",), "H1": ("H1", "H2"), "H2": ("H1", "H2")}
"""Layers that a range is held for, by the layer shown."""


class HeldRanges:
    """Ranges fitted to the first field of a problem, kept for its other methods and for drags.

    That of the error density is the start's: what a method made of it is seen against it.
    """

    def __init__(self) -> None:
        self.ranges: dict[str, Range] = {}
        self._restored: dict[str, Range] = {}
        self._of: Problem | None = None

    def follow(self, state: SessionState) -> None:
        """Let go of what was fitted to the field of another problem."""
        problem = state.shown_problem
        if problem is None:
            return
        if self._of is None or not problem.same_but_method(self._of):
            self.ranges, self._restored = self._restored, {}
        self._of = problem
        if state.start is not None and "error" not in self.ranges:
            areas = state.start.surface.face_areas
            self.ranges["error"] = density_limits(state.start.error_density, areas)

    def restore(self, ranges: Ranges) -> None:
        """Hold ranges for the field that is to come."""
        self._restored, self._of = dict(ranges), None

    def hold(self, state: SessionState, shown: str, limits: Range) -> None:
        """Keep the limits that the layer `shown` has of a solution."""
        if state.iterating is not None or state.shown_problem is None:
            return
        for name in HELD.get(shown, ()):
            if state.layers[name].value_range is None:
                self.ranges.setdefault(name, limits)
