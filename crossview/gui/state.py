"""Everything the window shows, as one frozen value."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from crossview.cases.model import METHODS
from crossview.scene import Elements, GuideLine, LayerSettings, default_layers
from crossview.session.document import Document
from crossview.session.live import LiveBase, LiveEdit
from crossview.session.meshes import NO_MESHES, Meshes
from crossview.session.methods import Iterate
from crossview.session.moving import Moving
from crossview.session.opening import Opening
from crossview.workflow.marking import Marking
from crossview.workflow.pipeline import Solution
from crossview.workflow.problem import Problem
from crossview.workflow.quads import MeshOptions
from solvers.features.edges import Features
from solvers.fields.crossfield import CrossField
from solvers.layouts.separatrices import Separatrices
from solvers.progress import Progress
from solvers.remedies import Remedy
from solvers.singularities.budget import IndexBudget, Singularity, index_budget
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class ShowWhere(Remedy):
    """Show the file that could not be opened, with the offending elements pointed out.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    elements : Elements
        Numbered as in the file.
    """

    elements: Elements


@dataclass(frozen=True, eq=False)
class Faulty:
    """Triangles that are no surface, and what is wrong with them.

    Parameters
    ----------
    vertices : (n, 3) float array
    faces : (m, 3) int array
    elements : Elements
        The offending ones.
    """

    vertices: FloatArray
    faces: IntArray
    elements: Elements


@dataclass(frozen=True, eq=False)
class Message:
    """One line over the scene.

    Parameters
    ----------
    text : str
        What, where and what to do.
    cause : str
        What the message is about; it goes when that succeeds ("open", "solve", "edit", ...).
    severity : {"error", "warning", "info"}
    details : str
        More to read and copy; may be empty.
    remedies : tuple of Remedy
        What the window can do about it: its buttons.
    tried : Opening, MeshOptions or None
        What was to be opened or made, which a remedy goes on with.
    stopped : bool
        Whether it tells that the user has stopped something.
    faulty : Faulty or None
        What it is about, to be shown in the scene as long as the message stands.
    pointed : Elements or None
        The same, where it is a part of the surface shown.
    """

    text: str
    cause: str
    severity: str = "error"
    details: str = ""
    remedies: tuple[Remedy, ...] = ()
    tried: Opening | MeshOptions | None = None
    stopped: bool = False
    faulty: Faulty | None = None
    pointed: Elements | None = None


@dataclass(frozen=True, eq=False)
class MarkTool:
    """The tool that marks feature edges.

    Parameters
    ----------
    last : int or None
        Vertex of the document's surface at the last click.
    path : (k,) int array or None
        Vertices along the edges that a click would mark, to be pointed out.
    """

    last: int | None = None
    path: IntArray | None = None


@dataclass(frozen=True, eq=False)
class FeatureTrial:
    """Features that are looked at and not yet taken.

    Parameters
    ----------
    marking : Marking
    features : Features
        On the document's surface.
    """

    marking: Marking
    features: Features


@dataclass(frozen=True, eq=False)
class Trial:
    """Something that would happen: a singularity under the mouse, dragged or not yet placed.

    Parameters
    ----------
    singularities : tuple of Singularity
        On the document's surface, with the change made.
    index : int
        Which of them it is about.
    placed : SurfacePoint
        The same one on the surface that is shown.
    surface : TriSurface
        That surface; another may have come into its place.
    edit : LiveEdit or None
        The same on the kept factor, where there is one.
    drag : bool
        Whether it is dragged (else it only previews a click of the add tool).
    """

    singularities: tuple[Singularity, ...]
    index: int
    placed: SurfacePoint
    surface: TriSurface
    edit: LiveEdit | None
    drag: bool


@dataclass(frozen=True, eq=False)
class WindowState:
    """What the window shows. See the properties for what follows from it.

    Parameters
    ----------
    document : Document or None
        None: nothing is open.
    base : LiveBase or None
        The factored surface that edits are tried on.
    solution : Solution or None
        The last finished one, whose document may have moved on.
    field : CrossField or None
        What is drawn: of `solution`, of `iterate`, of a drag or of `moving`.
    start : CrossField or None
        What the method of `solution` or `iterate` started from; None if it is isotropic.
    iterate : Iterate or None
        The last iteration of a solve that runs.
    moving : Moving or None
        Where singularities are while they are made valid.
    comparing : bool
        Whether the error density of `start` is shown in place of that of `field`.
    cut_graph : (k, 2) int array or None
        Vertex pairs, of the field of `solution`; only computed while its layer is visible.
    meshes : Meshes
        Separatrices, layout and quads, of a field that may no longer be `field`: see `made`.
    tool : int or None
        Valence that the add tool carries; None: the select tool.
    any_valence : int
        What the tool "any valence" carries.
    mark_tool : MarkTool or None
        In hand while clicks mark feature edges; `tool` is None then.
    feature_trial : FeatureTrial or None
    along_curvature : bool
        Whether natural singularities come from crosses that are drawn to principal directions.
    selected : int or None
        Number of the selected singularity.
    partner : int or None
        Number of a second selected singularity: see `pair`.
    hovered : int or None
        Number of the singularity under the mouse.
    condition : int or None
        Number of the holonomy condition whose loop is pointed out.
    pinned : int or None
        Number of the holonomy condition that the guide keeps to: see `followed`.
    guide : tuple of GuideLine
        Where the singularity under the mouse may go.
    poor : bool
        Whether the poor triangles are pointed out.
    trial : Trial or None
    layers : mapping of str to LayerSettings
    dark : bool
        Whether the scene has a dark background.
    message : Message or None
    progress : Progress or None
        What the background is doing; None: nothing.
    undo_name, redo_name : str or None
    """

    document: Document | None = None
    base: LiveBase | None = None
    solution: Solution | None = None
    field: CrossField | None = None
    start: CrossField | None = None
    iterate: Iterate | None = None
    moving: Moving | None = None
    comparing: bool = False
    cut_graph: IntArray | None = None
    meshes: Meshes = NO_MESHES
    tool: int | None = None
    any_valence: int = 7
    mark_tool: MarkTool | None = None
    feature_trial: FeatureTrial | None = None
    along_curvature: bool = False
    selected: int | None = None
    partner: int | None = None
    hovered: int | None = None
    condition: int | None = None
    pinned: int | None = None
    guide: tuple[GuideLine, ...] = ()
    poor: bool = False
    trial: Trial | None = None
    layers: Mapping[str, LayerSettings] = dataclasses.field(default_factory=default_layers)
    dark: bool = False
    message: Message | None = None
    progress: Progress | None = None
    undo_name: str | None = None
    redo_name: str | None = None

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        """The singularities on the document's surface, a drag or their own way included."""
        if self.moving is not None:
            return self.moving.singularities
        if self.trial is not None and self.trial.drag:
            return self.trial.singularities
        return () if self.document is None else self.document.singularities

    @property
    def pair(self) -> tuple[int, int] | None:
        """The two singularities that are selected, if two are."""
        if self.selected is None or self.partner is None or self.partner == self.selected:
            return None
        return self.partner, self.selected

    @property
    def followed(self) -> int | None:
        """The one holonomy condition that the guide shows: pointed at, else pinned; None: all."""
        return self.pinned if self.condition is None else self.condition

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
        if self.iterate is not None:
            return self.iterate.step.so_far.aligned.isotropic.defects
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
        if self.iterate is not None and self.document is not None:
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
        return point if self.base is None else self.base.lift(point)

    def with_layer(self, name: str, **changes: object) -> WindowState:
        """Return the state with settings of one layer changed."""
        layers = {**self.layers, name: replace(self.layers[name], **changes)}  # type: ignore[arg-type]
        return replace(self, layers=layers)
