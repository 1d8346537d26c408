"""Marks feature edges: by an angle that is tried first, and by clicks on edges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crossview.session.commands import MarkFeatures
from crossview.session.edge_picker import EdgePicker
from crossview.session.hand import FeatureTrial, MarkTool, SelectTool
from crossview.session.verbs.group import VerbGroup
from crossview.workflow.marking import Marking
from solvers.surface import IntArray, SurfacePoint


class FeatureMarks(VerbGroup):
    """Tries features out, and makes them one step of the history each."""

    _picker: EdgePicker | None = None

    def take_tool(self) -> None:
        """Take the tool that marks edges, or put it back when it is in hand."""
        state = self._state
        self._store.update(state.tool_taken(SelectTool() if state.mark_tool else MarkTool()))

    def try_angle(self, degrees: float | None) -> None:
        """Show which edges are sharper than an angle, and take none yet."""
        document = self._state.document
        if document is not None:
            marking = replace(document.problem.marking, dihedral_degrees=degrees)
            trial = FeatureTrial(marking, marking.on(document.surface))
            self._store.update(replace(self._state, feature_trial=trial))

    def accept(self) -> None:
        """Take the features that are tried."""
        trial = self._state.feature_trial
        document = self._state.document
        self._store.update(replace(self._state, feature_trial=None))
        if trial is None or document is None or trial.marking == document.problem.marking:
            return
        degrees = trial.marking.dihedral_degrees
        name = "forget sharp edges" if degrees is None else f"mark edges over {degrees:g} degrees"
        self._do(MarkFeatures(trial.marking, name))

    def clear(self) -> None:
        """Take all marks away."""
        self._store.update(replace(self._state, feature_trial=None))
        self._do(MarkFeatures(Marking(), "remove all features"))

    def hover(self, point: SurfacePoint | None, onwards: bool) -> None:
        """Show the edges that a click at a point of the shown surface would mark."""
        tool = self._state.mark_tool
        if tool is None:
            return
        edges = None if point is None else self._edges(point, onwards)
        path = None
        if edges is not None and len(edges):
            path = self._edge_picker().vertices_along(self._start(onwards), edges)
        if path is not None or tool.path is not None:
            self._store.update(self._state.tool_taken(replace(tool, path=path)))

    def click(self, point: SurfacePoint, onwards: bool) -> None:
        """Mark the edge at a point of the shown surface, or no longer.

        Parameters
        ----------
        point : SurfacePoint
        onwards : bool
            Mark the shortest path from the last click instead.
        """
        document = self._state.document
        if document is None:
            return
        edges = self._edges(point, onwards)
        last = self._edge_picker().vertex_at(self._state.lifted(point))
        self._store.update(self._state.tool_taken(MarkTool(last)))
        inner = edges[document.surface.edge_faces[edges, 1] >= 0]
        if not len(inner):
            return
        marking = document.problem.marking.toggled(document.surface, inner)
        grown = len(marking.on(document.surface)) > len(document.problem.features)
        verb = "mark" if grown else "unmark"
        what = "an edge" if len(inner) == 1 else f"{len(inner)} edges"
        self._do(MarkFeatures(marking, f"{verb} {what}"))

    def _start(self, onwards: bool) -> int | None:
        tool = self._state.mark_tool
        return tool.last if onwards and tool is not None else None

    def _edges(self, point: SurfacePoint, onwards: bool) -> IntArray:
        picker, place = self._edge_picker(), self._state.lifted(point)
        start = self._start(onwards)
        if start is None:
            return np.array([picker.edge_at(place)])
        return picker.path(start, place)

    def _edge_picker(self) -> EdgePicker:
        document = self._state.document
        if document is None:
            raise RuntimeError("there is no surface to mark")
        if self._picker is None or self._picker.surface is not document.surface:
            self._picker = EdgePicker(document.surface)
        return self._picker
