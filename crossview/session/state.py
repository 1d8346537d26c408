"""Everything that is shown and held in a session, as one frozen value.

What happens is a method that returns the next state; nothing is computed in any of them that
takes longer than a look-up, and none knows of windows, threads or files.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from crossview.cases.model import METHODS
from crossview.session.document import Document
from crossview.session.hand import (
    OWN_TOOLS,
    AddTool,
    FeatureTrial,
    Focus,
    MarkTool,
    SelectTool,
    Tool,
    Trial,
)
from crossview.session.live import LiveBase, LiveEdit
from crossview.session.meshes import NO_MESHES, Meshes
from crossview.session.message import Faulty, Message
from crossview.session.methods import Iterate
from crossview.session.moving import Waypoint
from crossview.session.shown import (
    Drawn,
    Iterating,
    Moving,
    Nothing,
    Provisional,
    Shown,
    Solved,
    drawn_of,
)
from crossview.session.tracing import Traced
from crossview.view.scene_view import LayerSettings, default_layers
from crossview.view.values import Elements, GuideLine
from crossview.workflow.pipeline import Solution
from crossview.workflow.problem import Problem
from solvers.features.edges import Features
from solvers.fields.crossfield import CrossField
from solvers.layouts.separatrices import Separatrices
from solvers.progress import Progress
from solvers.singularities.budget import IndexBudget, Singularity, index_budget
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class SessionState:
    """What a session shows and holds. See the properties for what follows from it.

    Parameters
    ----------
    document : Document or None
        None: nothing is open.
    undo_name, redo_name : str or None
        What undo and redo would do.
    shown : Nothing, Solved, Provisional, Iterating or Moving
        What is shown of a field.
    comparing : bool
        Whether the error density of `start` is shown in place of that of `field`.
    tool : SelectTool, AddTool or MarkTool
        What a click does.
    any_valence : int
        What the tool "any valence" carries.
    focus : Focus
        What is selected or under the mouse.
    trial : Trial or None
        A singularity dragged or not yet placed.
    feature_trial : FeatureTrial or None
    along_curvature : bool
        Whether natural singularities come from crosses that are drawn to principal directions.
    guide : tuple of GuideLine
        Where the singularity under the mouse may go.
    poor : bool
        Whether the poor triangles are pointed out.
    layers : mapping of str to LayerSettings
    dark : bool
        Whether the scene has a dark background.
    message : Message or None
    progress : Progress or None
        What the background is doing; None: nothing.
    """

    document: Document | None = None
    undo_name: str | None = None
    redo_name: str | None = None
    shown: Shown = dataclasses.field(default_factory=Nothing)
    comparing: bool = False
    tool: Tool = dataclasses.field(default_factory=SelectTool)
    any_valence: int = 7
    focus: Focus = dataclasses.field(default_factory=Focus)
    trial: Trial | None = None
    feature_trial: FeatureTrial | None = None
    along_curvature: bool = False
    guide: tuple[GuideLine, ...] = ()
    poor: bool = False
    layers: Mapping[str, LayerSettings] = dataclasses.field(default_factory=default_layers)
    dark: bool = False
    message: Message | None = None
    progress: Progress | None = None

    # What happens.

    def document_changed(
        self, document: Document | None, undo_name: str | None, redo_name: str | None
    ) -> SessionState:
        """Return the state with another document, without what does not fit it."""
        shown: Shown = self.drawn
        tool, focus = self.tool, Focus()
        before = None if self.document is None else self.document.surface
        if document is None or document.surface is not before:
            shown = Nothing()
            tool = SelectTool() if isinstance(tool, MarkTool) else tool
        else:
            focus = self.focus.among(len(document.singularities))
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
            trial=None,
            feature_trial=None,
        )
        return changed.unsaid("edit", "mesh", "layout")

    def progressed(self, progress: Progress | None) -> SessionState:
        """Return the state with news of the background; None: it has nothing left to do."""
        shown, drawn = self.shown, self.drawn
        if isinstance(progress, Iterate):
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
        return replace(self, trial=trial, focus=replace(self.focus, selected=index))

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

    def said(self, message: Message | None) -> SessionState:
        """Return the state with a message in place of any other."""
        return replace(self, message=message)

    def unsaid(self, *causes: str) -> SessionState:
        """Return the state without a message of these causes."""
        gone = self.message is not None and self.message.cause in causes
        return self.said(None) if gone else self

    def with_layer(self, name: str, settings: LayerSettings) -> SessionState:
        """Return the state with other settings of one layer."""
        return replace(self, layers={**self.layers, name: settings})

    def with_layer_shown(self, name: str, visible: bool = True) -> SessionState:
        """Return the state with a layer shown, or hidden."""
        return self.with_layer(name, replace(self.layers[name], visible=visible))

    def _showing(self, shown: Shown) -> SessionState:
        return self if shown is self.shown else replace(self, shown=shown)

    def _edit(self, document: Document) -> LiveEdit | None:
        return None if self.base is None else LiveEdit.start(document, self.base)

    # What follows.

    @property
    def drawn(self) -> Drawn:
        """What is seen of a field, whatever runs."""
        return drawn_of(self.shown)

    @property
    def field(self) -> CrossField | None:
        """The field that is drawn."""
        return self.drawn.field

    @property
    def base(self) -> LiveBase | None:
        """The factored surface that edits are tried on."""
        return self.drawn.base

    @property
    def last(self) -> Solved | None:
        """What was last solved on this surface."""
        return self.drawn.last

    @property
    def solution(self) -> Solution | None:
        """The last solution, whose document may have moved on."""
        return None if self.last is None else self.last.solution

    @property
    def start(self) -> CrossField | None:
        """What the method that runs or has run started from; None if it is isotropic."""
        if isinstance(self.shown, Iterating):
            return self.shown.start
        return None if self.last is None else self.last.start

    @property
    def iterating(self) -> Iterating | None:
        """The solve that runs, from its first iteration on."""
        return self.shown if isinstance(self.shown, Iterating) else None

    @property
    def moving(self) -> Moving | None:
        """The singularities on their way, if they are."""
        return self.shown if isinstance(self.shown, Moving) else None

    @property
    def cut_graph(self) -> IntArray | None:
        """The cut graph of the field, where it is known: vertex pairs, shape (k, 2)."""
        drawn = self.drawn
        return drawn.cut_graph if isinstance(drawn, Solved) else None

    @property
    def meshes(self) -> Meshes:
        """Separatrices, layout and quads, of a field that may no longer be `field`: see `made`."""
        return self.drawn.meshes

    @property
    def added_valence(self) -> int | None:
        """The valence that the tool in hand adds, if it adds."""
        return self.tool.valence if isinstance(self.tool, AddTool) else None

    @property
    def mark_tool(self) -> MarkTool | None:
        """The tool that marks edges, if it is in hand."""
        return self.tool if isinstance(self.tool, MarkTool) else None

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        """The singularities on the document's surface, a drag or their own way included."""
        if self.moving is not None:
            return self.moving.singularities
        if self.trial is not None and self.trial.drag:
            return self.trial.singularities
        return () if self.document is None else self.document.singularities

    @property
    def shown_surface(self) -> TriSurface | None:
        """The surface that is drawn and picked on: the kept refined one where there is one."""
        if self.faulty is not None:
            return None
        if self.base is not None:
            return self.base.surface
        return None if self.document is None else self.document.surface

    @property
    def faulty(self) -> Faulty | None:
        """What is shown in place of the document while its message stands."""
        return None if self.message is None else self.message.faulty

    @property
    def pointed(self) -> Elements | None:
        """What the message points out on the surface shown."""
        return None if self.message is None else self.message.pointed

    @property
    def made(self) -> Meshes:
        """What has been made of the field that is drawn: nothing that is of another."""
        return self.meshes if self.meshes.of is self.field else NO_MESHES

    @property
    def separatrices(self) -> Separatrices | None:
        """The separatrices to draw; in a drag they may be a moment behind the field."""
        dragged = self.trial is not None and self.trial.drag and self.field is not None
        return self.meshes.separatrices if dragged else self.made.separatrices

    @property
    def features(self) -> Features | None:
        """The feature edges to show, on `shown_surface` or, the same vertices, the document's."""
        if self.feature_trial is not None:
            return self.feature_trial.features
        if self.document is None:
            return None
        own = self.document.problem.features
        return own if self.field_along_features is None else self.known_features

    @property
    def field_along_features(self) -> CrossField | None:
        """The field shown, where it tells by how much it misses the present features."""
        features, field = self.known_features, self.field
        if features is None or field is None or field.surface is not features.surface:
            return None
        return field if len(field.feature_misalignment) == len(features.curves) else None

    @property
    def known_features(self) -> Features | None:
        """The features that `base` knows; None where they are no longer those of the document."""
        if self.document is None or self.base is None or self.base.marking is None:
            return None
        same = self.base.marking == self.document.problem.marking
        return self.base.solver.discretization.features if same else None

    @property
    def budget(self) -> IndexBudget | None:
        """The index budget, with what the trial would change."""
        if self.document is None:
            return None
        if self.trial is None or self.trial.drag:
            return self.document.budget
        return index_budget(self.document.surface, self.trial.singularities, self.document.corners)

    @property
    def defects(self) -> FloatArray | None:
        """Holonomy defects in radians of the isotropic field, with the trial; None without one.

        They are of the configuration: a method that bridges them leaves them as they are.
        """
        if self.moving is not None:
            return self.moving.defects
        budget = self.budget
        if budget is None or not budget.satisfied:
            return None
        if self.trial is not None:
            return None if self.trial.edit is None else self.trial.edit.defects()
        if self.iterating is not None:
            return self.iterating.step.so_far.aligned.isotropic.defects
        if self.solution is not None and self.field is self.solution.field:
            return self.solution.holonomy_defects
        return None if self.field is None else self.field.defects

    @property
    def valid(self) -> bool:
        """Whether the index budget holds and all holonomy defects are known and small."""
        defects = self.defects
        limit = math.radians(self.tolerance)
        return defects is not None and all(abs(defect) < limit for defect in defects)

    @property
    def method(self) -> str:
        """The method that the document is solved by."""
        return METHODS[0] if self.document is None else self.document.problem.method

    @property
    def shown_problem(self) -> Problem | None:
        """What `field` solves, or is about to solve; None while it only follows the mouse."""
        if self.iterating is not None and self.document is not None:
            return self.document.problem
        if self.solution is not None and self.field is self.solution.field:
            return self.solution.problem
        return None

    @property
    def tolerance(self) -> float:
        """Largest defect called valid, degrees."""
        options = None if self.document is None else self.document.problem.options
        return 0.01 if options is None else options.tolerance_degrees

    @property
    def solved(self) -> bool:
        """Whether `solution` is of the present document."""
        if self.document is None or self.solution is None:
            return False
        return self.solution.problem is self.document.problem

    def lifted(self, point: SurfacePoint) -> SurfacePoint:
        """Return a point of the shown surface as one of the document's."""
        return point if self.base is None else self.base.refinement.lift(point)
