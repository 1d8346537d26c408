"""What a session shows and holds, and what follows from it: one frozen value."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass

from crossview.cases.model import METHODS
from crossview.session.document import Document
from crossview.session.hand import (
    AddTool,
    FeatureTrial,
    Focus,
    MarkTool,
    MeasureTool,
    SelectTool,
    Tool,
    Trial,
)
from crossview.session.live import LiveBase
from crossview.session.meshes import NO_MESHES, Meshes
from crossview.session.message import Faulty, Message
from crossview.session.shown import (
    Drawn,
    Iterating,
    Moving,
    Nothing,
    Shown,
    Solved,
    drawn_of,
)
from crossview.view.scene_view import LayerSettings, default_layers
from crossview.view.values import Elements, GuideLine, Plane
from crossview.workflow.pipeline import Solution
from crossview.workflow.problem import Problem
from solvers.features import Features
from solvers.fields import CrossField
from solvers.layouts import NearMisses, Separatrices
from solvers.progress import Progress
from solvers.singularities import Existence, IndexBudget, Singularity, index_budget
from solvers.surface import FloatArray, IntArray, SurfacePoint, TriSurface


@dataclass(frozen=True, eq=False)
class Facts:
    """Fields that are set, by `SessionState`, and properties that follow from them.

    Parameters
    ----------
    document : Document or None
        None: nothing is open.
    kept : Document or None
        What its file holds; None: nothing of it.
    undo_name, redo_name : str or None
        What undo and redo would do.
    shown : Nothing, Solved, Provisional, Iterating or Moving
        What is shown of a field.
    uncompared : frozenset of str or None
        While the error density of `start` is shown: the scalars that were visible before.
    tool : SelectTool, AddTool, MarkTool or MeasureTool
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
    fewest_natural : bool
        Whether as few natural singularities are left as the index budget allows.
    guide : tuple of GuideLine
        Where the singularity under the mouse may go.
    near_misses : NearMisses or None
        Separatrices that a click makes meet what they nearly meet, where they have been looked for.
    clip : Plane or None
        What is before it is not shown.
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
    kept: Document | None = None
    undo_name: str | None = None
    redo_name: str | None = None
    shown: Shown = dataclasses.field(default_factory=Nothing)
    uncompared: frozenset[str] | None = None
    tool: Tool = dataclasses.field(default_factory=SelectTool)
    any_valence: int = 7
    focus: Focus = dataclasses.field(default_factory=Focus)
    trial: Trial | None = None
    feature_trial: FeatureTrial | None = None
    along_curvature: bool = False
    fewest_natural: bool = False
    guide: tuple[GuideLine, ...] = ()
    near_misses: NearMisses | None = None
    clip: Plane | None = None
    poor: bool = False
    layers: Mapping[str, LayerSettings] = dataclasses.field(default_factory=default_layers)
    dark: bool = False
    message: Message | None = None
    progress: Progress | None = None

    @property
    def comparing(self) -> bool:
        """Whether the error density of `start` is shown in place of that of `field`."""
        return self.uncompared is not None

    @property
    def stale(self) -> bool:
        """Whether the field that is drawn was solved for another configuration."""
        document, shown = self.document, self.shown
        if document is None or not isinstance(shown, Solved) or self.solved:
            return False
        return not _unlocked(shown.solution.problem).same_but_method(_unlocked(document.problem))

    @property
    def modified(self) -> bool:
        """Whether closing would lose something."""
        return self.document is not self.kept

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
    def measure_tool(self) -> MeasureTool | None:
        """The tool that measures, if it is in hand."""
        return self.tool if isinstance(self.tool, MeasureTool) else None

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
    def covered(self) -> frozenset[str]:
        """The visible layers that nothing is seen of, under a quad mesh or layout."""
        if self.made.quads is not None and self.layers["quads"].visible:
            hidden: tuple[str, ...] = ("surface", "layout", "crosses")
        elif self.made.layout is not None and self.layers["layout"].visible:
            hidden = ("surface",)
        else:
            hidden = ()
        return frozenset(name for name in hidden if self.layers[name].visible)

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
    def existence(self) -> Existence | None:
        """Whether any quad mesh has what the trial would make of the configuration.

        Without one, by the turns and the sectors of the solution too.
        """
        if self.document is None:
            return None
        if self.trial is None or self.trial.drag:
            verdict = self.solution.verdict if self.solved and self.solution else None
            if verdict is None or verdict.theorem is None or self.trial is not None:
                return self.document.existence
            return Existence("impossible", verdict.theorem, verdict.remedies)
        return self.document.existence_with(self.trial.singularities)

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


def _unlocked(problem: Problem) -> Problem:
    """Return a problem without locks, which change no field."""
    free = tuple(dataclasses.replace(s, locked=False) for s in problem.singularities)
    return dataclasses.replace(problem, singularities=free)
