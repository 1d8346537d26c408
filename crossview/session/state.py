"""What happens in a session, as transitions from one frozen state to the next.

Nothing is computed in any of them that takes longer than a look-up, and none knows of windows,
threads or files.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from crossview.session.document import Document
from crossview.session.facts import Facts
from crossview.session.hand import (
    OWN_TOOLS,
    AddTool,
    Focus,
    MarkTool,
    MeasureTool,
    SelectTool,
    Tool,
    Trial,
)
from crossview.session.live import LiveBase, LiveEdit
from crossview.session.live_tracer import Traced
from crossview.session.meshes import Meshes
from crossview.session.message import Message
from crossview.session.method_solver import MethodStep
from crossview.session.shown import (
    Iterating,
    Moving,
    Nothing,
    Provisional,
    Shown,
    Solved,
)
from crossview.session.waypoints import Waypoint
from crossview.view.scalars import SURFACE_SCALARS
from crossview.view.scene_view import LayerSettings
from crossview.workflow.pipeline import Solution
from solvers.progress import Progress
from solvers.singularities import Singularity
from solvers.surface import IntArray, SurfacePoint


@dataclass(frozen=True, eq=False)
class SessionState(Facts):
    """The state of a session; each method returns the state after something has happened."""

    def document_changed(
        self, document: Document, undo_name: str | None, redo_name: str | None
    ) -> SessionState:
        """Return the state with another document, without what does not fit it."""
        shown: Shown = self.drawn
        tool, focus, clip = self.tool, Focus(), self.clip
        before = None if self.document is None else self.document.surface
        if document.surface is not before:
            shown, clip = Nothing(), None
            tool = SelectTool() if isinstance(tool, MarkTool | MeasureTool) else tool
        else:
            had = () if self.document is None else self.document.singularities
            focus = self.focus.among(len(had), len(document.singularities))
            if not document.budget.satisfied:
                shown = Nothing(self.base)
        changed = replace(
            self,
            document=document,
            undo_name=undo_name,
            redo_name=redo_name,
            shown=shown,
            tool=tool,
            focus=focus,
            clip=clip,
            trial=None,
            feature_trial=None,
        )
        return changed.unsaid("edit", "mesh", "layout")

    def progressed(self, progress: Progress | None) -> SessionState:
        """Return the state with news of the background; None: it has nothing left to do."""
        shown, drawn = self.shown, self.drawn
        if isinstance(progress, MethodStep):
            if progress.field is not None:
                drawn = Provisional(progress.field, progress.base, self.last)
            shown = Iterating(progress.step, progress.start, drawn)
        elif isinstance(progress, Waypoint):
            field, base = progress.field, self.base
            if field is not None:
                on_base = base is not None and base.surface is field.surface
                # else the field is of the surface before refinement
                drawn = Provisional(field, base if on_base else None, self.last)
            shown = Moving(progress.singularities, progress.defects, drawn)
        elif progress is None and isinstance(shown, Moving):
            shown = drawn
        return replace(self, progress=progress, shown=shown)

    def work_ended(self) -> SessionState:
        """Return the state without a solve that runs or singularities on their way."""
        return self._showing(self.drawn)

    def base_prepared(self, base: LiveBase) -> SessionState:
        """Return the state with a surface to try edits on, and no field."""
        return self._showing(Nothing(base))

    def solution_found(self, solved: Solved) -> SessionState:
        """Return the state with a solution shown; what was made of the same one stays."""
        last = self.last
        if last is not None and last.solution is solved.solution:
            solved = replace(solved, meshes=last.meshes, cut_graph=last.cut_graph)
        return self._showing(solved).unsaid("solve")

    def no_solution(self) -> SessionState:
        """Return the state without a field."""
        return self._showing(Nothing(self.base))

    def put_back(self) -> SessionState:
        """Return the state with the document's own solution shown again, or with no field."""
        return self._showing(self.last) if self.last and self.solved else self.no_solution()

    def field_tried(self, traced: Traced) -> SessionState:
        """Return the state with the field of a drag, and its separatrices if there was time."""
        meshes = self.meshes
        if traced.separatrices is not None:
            meshes = Meshes(traced.field, traced.separatrices)
        return self._showing(Provisional(traced.field, self.base, self.last, meshes))

    def cut_along(self, solution: Solution, cut_graph: IntArray) -> SessionState:
        """Return the state with the cut graph of a solution, if that is still shown."""
        shown = self.shown
        if not isinstance(shown, Solved) or shown.solution is not solution:
            return self
        return self._showing(replace(shown, cut_graph=cut_graph))

    def meshes_made(self, meshes: Meshes) -> SessionState:
        """Return the state with what has been made of a field, if that is still shown."""
        shown = self.shown
        if not isinstance(shown, Solved) or shown.field is not meshes.of:
            return self
        return self._showing(replace(shown, meshes=meshes))

    def tool_taken(self, tool: Tool) -> SessionState:
        """Return the state with another tool in hand."""
        return replace(self, tool=tool, trial=None)

    def any_valence_chosen(self, valence: int) -> SessionState:
        """Return the state with another valence for the tool of any; in hand, it carries it."""
        held = self.added_valence
        carried = held is not None and held not in OWN_TOOLS
        chosen = replace(self, any_valence=valence)
        return replace(chosen, tool=AddTool(valence)) if carried else chosen

    def previewed(self, point: SurfacePoint | None) -> SessionState:
        """Return the state with what a click of the add tool at a point would do."""
        document, surface = self.document, self.shown_surface
        if point is None or document is None or surface is None or self.added_valence is None:
            return self.let_go()
        added = Singularity(self.lifted(point), self.added_valence)
        edit = self._edit(document)
        if edit is not None:
            edit = edit.added(replace(added, point=point))
        singularities = (*document.singularities, added)
        trial = Trial(singularities, len(singularities) - 1, point, surface, edit, drag=False)
        return replace(self, trial=trial)

    def taken_hold(self, index: int) -> SessionState:
        """Return the state with singularity `index` held; the same if it is locked."""
        document, surface = self.document, self.shown_surface
        if document is None or surface is None or document.singularities[index].locked:
            return self
        point = document.singularities[index].point
        placed = point if self.base is None else self.base.refinement.locate(point)
        edit = self._edit(document)
        trial = Trial(document.singularities, index, placed, surface, edit, drag=True)
        return replace(self, trial=trial, focus=self.focus.holding(index))

    def dragged_to(self, point: SurfacePoint) -> SessionState:
        """Return the state with the held singularity at a point of the shown surface."""
        if self.trial is None or not self.trial.drag:
            return self
        return replace(self, trial=self.trial.moved(point, self.lifted(point)))

    def let_go(self) -> SessionState:
        """Return the state with nothing tried out."""
        return replace(self, trial=None)

    def focused(self, focus: Focus) -> SessionState:
        """Return the state with something else selected or under the mouse."""
        return self if focus == self.focus else replace(self, focus=focus)

    def selecting(self, index: int) -> SessionState:
        """Return the state with singularity `index` selected in place of the one that was."""
        return self.focused(replace(self.focus, selected=index))

    def said(self, message: Message | None) -> SessionState:
        """Return the state with a message in place of any other."""
        return replace(self, message=message)

    def unsaid(self, *causes: str) -> SessionState:
        """Return the state without a message of these causes."""
        gone = self.message is not None and self.message.cause in causes
        return self.said(None) if gone else self

    def with_layer(self, name: str, settings: LayerSettings) -> SessionState:
        """Return the state with other settings of one layer; of scalars one at most is visible."""
        layers = {**self.layers, name: settings}
        if settings.visible and name in SURFACE_SCALARS:
            hidden = (other for other in SURFACE_SCALARS if other != name)
            layers |= {other: replace(layers[other], visible=False) for other in hidden}
        return replace(self, layers=layers)

    def with_layer_shown(self, name: str, visible: bool = True) -> SessionState:
        """Return the state with a layer shown, or hidden."""
        return self.with_layer(name, replace(self.layers[name], visible=visible))

    def _showing(self, shown: Shown) -> SessionState:
        return self if shown is self.shown else replace(self, shown=shown)

    def _edit(self, document: Document) -> LiveEdit | None:
        return None if self.base is None else LiveEdit.start(document, self.base)
