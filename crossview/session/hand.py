"""What the user's hand is about: the tool it carries, what it selects, what it tries out."""

from __future__ import annotations

from dataclasses import dataclass, replace

from crossview.session.live import LiveEdit
from crossview.workflow.marking import Marking
from solvers.features import Features
from solvers.singularities import Singularity
from solvers.surface import FloatArray, IntArray, SurfacePoint, TriSurface

OWN_TOOLS = (3, 5, 6, 8)
"""Valences that have a tool of their own; of all others there is one."""


@dataclass(frozen=True)
class SelectTool:
    """Clicks select."""


@dataclass(frozen=True)
class AddTool:
    """Clicks add a singularity of this valence."""

    valence: int


@dataclass(frozen=True, eq=False)
class MarkTool:
    """Clicks mark feature edges.

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
class MeasureTool:
    """Clicks measure: the second the distance from the first, the third the angle at the second.

    Parameters
    ----------
    places : tuple of SurfacePoint
        Where it was clicked, on the document's surface; three at most.
    paths : tuple of (k, 3) float array
        Shortest paths from each to the next, as far as they are found.
    """

    places: tuple[SurfacePoint, ...] = ()
    paths: tuple[FloatArray, ...] = ()


Tool = SelectTool | AddTool | MarkTool | MeasureTool


@dataclass(frozen=True)
class Focus:
    """What is selected or under the mouse: singularities and holonomy conditions by number.

    Parameters
    ----------
    selected : int or None
        The selected singularity.
    others : frozenset of int
        Further ones that are selected with it.
    hovered : int or None
        The singularity under the mouse.
    condition : int or None
        The condition whose loop is pointed out.
    pinned : int or None
        The condition that the guide keeps to: see `followed`.
    """

    selected: int | None = None
    others: frozenset[int] = frozenset()
    hovered: int | None = None
    condition: int | None = None
    pinned: int | None = None

    @property
    def pair(self) -> tuple[int, int] | None:
        """The two singularities that are selected, if two are."""
        if self.selected is None or len(self.others) != 1:
            return None
        (other,) = self.others
        return other, self.selected

    @property
    def all(self) -> tuple[int, ...]:
        """All that are selected, in ascending order."""
        return () if self.selected is None else tuple(sorted({self.selected, *self.others}))

    @property
    def followed(self) -> int | None:
        """The one condition that the guide shows: pointed at, else pinned; None: all."""
        return self.pinned if self.condition is None else self.condition

    def on(self, index: int | None, *, both: bool = False) -> Focus:
        """Return this with `index` selected.

        With `both` what was selected stays so, and one that was is so no longer.
        """
        if not both or index is None:
            return replace(self, selected=index, others=frozenset())
        if index not in self.all:
            return replace(self, selected=index, others=frozenset(self.all))
        left = [one for one in self.all if one != index]
        return replace(self, selected=left[-1] if left else None, others=frozenset(left[:-1]))

    def holding(self, index: int) -> Focus:
        """Return this with `index` foremost of those it is selected with, else alone."""
        others = frozenset(self.all) - {index} if index in self.all else frozenset[int]()
        return replace(self, selected=index, others=others)

    def among(self, before: int, count: int) -> Focus:
        """Return what is left of this after an edit of `before` singularities leaves `count`."""
        gone = self.selected is not None and self.selected >= count
        selected = None if gone else self.selected
        others = self.others if count == before else frozenset()
        return replace(self, selected=selected, others=others, hovered=None)


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

    @property
    def held(self) -> Singularity:
        """The one that it is about, on the document's surface."""
        return self.singularities[self.index]

    def moved(self, placed: SurfacePoint, lifted: SurfacePoint) -> Trial:
        """Return the trial elsewhere: at a point of the surface shown, and of the document's."""
        singularities = list(self.singularities)
        singularities[self.index] = replace(self.held, point=lifted)
        edit = None if self.edit is None else self.edit.moved(self.index, placed)
        return replace(self, singularities=tuple(singularities), placed=placed, edit=edit)
