"""What is shown of a field: one value for each case, which holds together what must agree.

A field is drawn on the surface of its base, its meshes and cut graph are of no other field, and
what was last solved is at hand for as long as something else is shown in its place::

    Nothing      no field                                            solved  -> Solved
    Solved       a solution                                          tried   -> Provisional
    Provisional  a field of no solution                              iterate -> Iterating
    Iterating    a solve that runs, its last field drawn             ended   -> what is drawn
    Moving       singularities on their way, their field drawn       ended   -> what is drawn
"""

from __future__ import annotations

from dataclasses import dataclass

from crossview.session.live import LiveBase
from crossview.session.meshes import NO_MESHES, Meshes
from crossview.workflow.pipeline import Solution
from solvers.fields import CrossField, FieldStep
from solvers.singularities import Singularity
from solvers.surface import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Nothing:
    """No field: nothing is open or solved yet, or the indices do not add up.

    Parameters
    ----------
    base : LiveBase or None
        What edits are tried on.
    """

    base: LiveBase | None = None

    @property
    def field(self) -> None:
        """None."""
        return

    @property
    def last(self) -> None:
        """No solution."""
        return

    @property
    def meshes(self) -> Meshes:
        """None of any field."""
        return NO_MESHES


@dataclass(frozen=True, eq=False)
class Solved:
    """A solution, whose document may have moved on.

    Parameters
    ----------
    solution : Solution
    start : CrossField or None
        The field that its method started from; None for the isotropic one.
    base : LiveBase
        Its surface and factor, that edits are tried on.
    meshes : Meshes
        What has been made of its field.
    cut_graph : (k, 2) int array or None
        Vertex pairs; only computed while its layer is visible.
    """

    solution: Solution
    start: CrossField | None
    base: LiveBase
    meshes: Meshes = NO_MESHES
    cut_graph: IntArray | None = None

    @property
    def field(self) -> CrossField:
        """The field of the solution."""
        return self.solution.field

    @property
    def last(self) -> Solved:
        """Itself."""
        return self


@dataclass(frozen=True, eq=False)
class Provisional:
    """A field of no solution: of a drag, or the last drawn of work on its way or cut short.

    Parameters
    ----------
    field : CrossField
    base : LiveBase or None
        Whose surface it is on; None: the document's.
    last : Solved or None
        The last solution.
    meshes : Meshes
        Separatrices that may be a moment behind the field.
    """

    field: CrossField
    base: LiveBase | None
    last: Solved | None
    meshes: Meshes = NO_MESHES


Drawn = Nothing | Solved | Provisional


@dataclass(frozen=True, eq=False)
class Iterating:
    """A solve that runs.

    Parameters
    ----------
    step : FieldStep
        Its last iteration.
    start : CrossField
        What it started from.
    drawn : Nothing, Solved or Provisional
        What is seen of it: the field of an iteration, of the last one or one before.
    """

    step: FieldStep
    start: CrossField
    drawn: Drawn


@dataclass(frozen=True, eq=False)
class Moving:
    """Singularities on their way, or about to come.

    Parameters
    ----------
    singularities : tuple of Singularity
        On the document's surface.
    defects : (c,) float array or None
        Their holonomy defects, radians; None before there are any singularities.
    drawn : Nothing, Solved or Provisional
        The field seen meanwhile.
    """

    singularities: tuple[Singularity, ...]
    defects: FloatArray | None
    drawn: Drawn


Shown = Drawn | Iterating | Moving


def drawn_of(shown: Shown) -> Drawn:
    """Return what is seen of a field."""
    return shown.drawn if isinstance(shown, Iterating | Moving) else shown
