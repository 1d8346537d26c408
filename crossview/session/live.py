"""Editing while the mouse moves: a kept factor, no refinement.

The surface of the last solution is refined around where its singularities were. While one of
them is dragged, or a new one is only considered, the others stay at their vertices and the moving
one is spread over the triangle it is in; the answer costs one back-substitution (the field) or a
table look-up (the holonomy defects).
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from crossview.session.document import Document
from crossview.workflow.marking import Marking
from crossview.workflow.pipeline import Solution
from solvers.fields import CrossField, IsotropicSolver
from solvers.progress import Progress
from solvers.singularities import Singularity
from solvers.surface import Refinement, SurfacePoint, TriSurface


@dataclass(frozen=True, eq=False)
class LiveBase:
    """A factored surface, perhaps a refinement of the document's, that edits are tried on.

    Parameters
    ----------
    refinement : Refinement
        Of the document's surface; it takes points from one to the other.
    solver : IsotropicSolver
        On the refined surface.
    marking : Marking
        The features that `solver` knows.
    """

    refinement: Refinement
    solver: IsotropicSolver
    marking: Marking = field(default_factory=Marking)

    @classmethod
    def from_solution(cls, solution: Solution) -> LiveBase:
        """Keep the factor of `solution`."""
        return cls(solution.prepared.refinement, solution.solver, solution.problem.marking)

    @property
    def surface(self) -> TriSurface:
        """The surface that is picked on and solved on."""
        return self.refinement.surface


def prepare(document: Document) -> Generator[Progress, None, LiveBase]:
    """Factor the unrefined surface, for configurations that cannot be solved yet."""
    yield Progress("preparing the surface", 0.1)
    features = document.problem.features
    solver = IsotropicSolver(document.surface, document.corners, features=features)
    yield Progress("preparing the holonomy conditions", 0.6)
    solver.holonomy.defects(())
    return LiveBase(Refinement.none(document.surface), solver, document.problem.marking)


@dataclass(frozen=True, eq=False)
class LiveEdit:
    """Singularities tried on a `LiveBase`.

    Parameters
    ----------
    base : LiveBase
        What is picked and solved on.
    singularities : tuple of Singularity
        On ``base.surface``.
    """

    base: LiveBase
    singularities: tuple[Singularity, ...]

    @classmethod
    def start(cls, document: Document, base: LiveBase) -> LiveEdit:
        """Place the singularities of `document` on the surface of `base`."""
        placed = (replace(s, point=base.refinement.locate(s.point)) for s in document.singularities)
        return cls(base, tuple(placed))

    def moved(self, index: int, point: SurfacePoint) -> LiveEdit:
        """Return the edit with singularity `index` at `point` of the base's surface."""
        singularities = list(self.singularities)
        singularities[index] = replace(singularities[index], point=point)
        return replace(self, singularities=tuple(singularities))

    def added(self, singularity: Singularity) -> LiveEdit:
        """Return the edit with one more singularity on the base's surface."""
        return replace(self, singularities=(*self.singularities, singularity))

    def defects(self) -> NDArray[np.float64]:
        """Return the holonomy defects in radians, shape (n_conditions,), by table look-up."""
        return self.base.solver.holonomy.defects(self.singularities)

    def solve(self) -> Generator[Progress, None, CrossField]:
        """Return the field of this moment; never yields, so that it is never cut short."""
        yield from ()
        return with_directions(self.base.solver.solve(self.singularities))


def with_directions(field: CrossField) -> CrossField:
    """Return `field` with its crosses computed: they are cached, and drawing asks for them."""
    _ = field.u, field.v
    return field


def cut(solution: Solution) -> Generator[Progress, None, NDArray[np.int64]]:
    """Compute the cut graph of a solution: vertex pairs, shape (k, 2)."""
    yield Progress("cutting to a disk", 0.0)
    return solution.cut_graph
