"""A solved problem, and what is shared by the methods that may solve it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crossview.workflow.problem import Problem
from solvers.features import Features, no_features
from solvers.fields import (
    CrossField,
    IntegratedField,
    IsotropicSolver,
    Limits,
    PreparedSurface,
    Verdict,
)
from solvers.frozen import freeze_arrays
from solvers.layouts import Separatrices, field_separatrices
from solvers.maps import MappedField
from solvers.singularities import Singularity
from solvers.surface import FloatArray, IntArray, Refinement, TriSurface

NO_ROOM, NO_MAP = "no room for a quad beside them", "no injective map was found with them"
"""Why features are released."""


@dataclass(frozen=True, eq=False)
class Solution:
    """A solved problem.

    Parameters
    ----------
    problem : Problem
        What was solved.
    prepared : PreparedSurface
        The surface solved on: refined around the singularities, which are vertices of it.
    solver : IsotropicSolver
        Keeps the factorisation of that surface; its fields are turned as `field` is.
    field : CrossField
        Crosses and sizes, with their own measures.
    holonomy_defects : (2 g + max(b - 1, 0),) float array
        Of the isotropic field of the same configuration, whatever the method; radians in
        (-pi/4, pi/4], in the order of ``solver.holonomy.conditions``.
    seconds : mapping of str to float
        Time of each stage; next to nothing for one that was kept.
    integrated : IntegratedField, or None
        The field with its unknowns; None for the isotropic method.
    limits : Limits
        Within which the problem's options call a field valid.
    verdict : Verdict
        What the field is worth, and what helps.
    mapped : MappedField, or None
        The field with its seamless map; None where it is refused before, or is not integrable.

    Examples
    --------
    A valence 3 and a valence 5 half a turn apart on an annulus: the largest defect there can be.

    >>> import numpy as np
    >>> import crossview
    >>> surface = crossview.primitives.annulus(inner=0.4, n=48)
    >>> places = [surface.closest_point(place) for place in ([0.8, 0, 0], [-0.6, 0, 0])]
    >>> pair = [crossview.Singularity(place, k) for place, k in zip(places, (3, 5))]
    >>> solution = crossview.solve(crossview.Problem(surface, pair))
    >>> np.degrees(np.abs(solution.holonomy_defects)).round(2), solution.valid
    (array([45.]), False)
    """

    problem: Problem
    prepared: PreparedSurface
    solver: IsotropicSolver
    field: CrossField
    holonomy_defects: FloatArray
    seconds: Mapping[str, float]
    integrated: IntegratedField | None
    limits: Limits
    verdict: Verdict
    mapped: MappedField | None = None

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def inverted(self) -> int | None:
        """Number of inverted triangles of the seamless map; None where there is no map."""
        return None if self.mapped is None else len(self.mapped.map.inverted)

    @property
    def wrong_windings(self) -> int | None:
        """Number of vertices around which the map's angles do not add up to the quads there."""
        return None if self.mapped is None else len(self.mapped.map.wrong_windings)

    @property
    def surface(self) -> TriSurface:
        """The refined surface that was solved on."""
        return self.prepared.surface

    @property
    def refinement(self) -> Refinement:
        """From the problem's surface to `surface`."""
        return self.prepared.refinement

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        """On `surface`, in the order of the problem's."""
        return self.prepared.singularities

    @property
    def features(self) -> Features:
        """The edges of `surface` that crosses are to follow, less those released."""
        integrated = self.integrated
        return self.prepared.features if integrated is None else integrated.aligned.features

    @property
    def released(self) -> Features:
        """Feature edges of `surface` that are not followed."""
        none = no_features(self.surface)
        return none.united(
            np.concatenate([none.edges, *(f.edges for f in self.released_for.values())])
        )

    @property
    def released_for(self) -> Mapping[str, Features]:
        """The released features for each reason that there is to release some, in plain words."""
        if self.integrated is None:
            return {}
        aligned = self.integrated.aligned
        found = {NO_ROOM: aligned.released, NO_MAP: aligned.without}
        return {reason: features for reason, features in found.items() if len(features)}

    @property
    def turns(self) -> tuple[int, ...]:
        """Quarter turns over each holonomy condition besides those nearest to the isotropic field.

        Those asked for, or others where the field of the nearest has a folded map.
        """
        if self.integrated is None:
            return (0,) * len(self.holonomy_defects)
        return self.integrated.aligned.turns

    @cached_property
    def cut_graph(self) -> IntArray:
        """(k, 2) vertex pairs of `surface` that cut it to a disk and meet every singularity."""
        return self.solver.cut_graph(self.singularities)

    @cached_property
    def separatrices(self) -> Separatrices:
        """Traced along the crosses, quick and near those of a layout."""
        return field_separatrices(self.field)

    @property
    def valid(self) -> bool:
        """Whether every holonomy defect is below the tolerance (the budget holds if solved)."""
        return not self.limits.missed(self.holonomy_defects).any()
