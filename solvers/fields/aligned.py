"""The field aligned with every boundary and feature: theta imposed, integrable or not.

The paper solves for theta with known values on all boundaries and known jumps over the cut (section
"Local manifold basis generation and theta initialization"). The holonomy potentials already hold
the answer: the harmonic correction that takes the defects to zero. With features a single-valued
turn is added that aligns the field with them too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from solvers.errors import CrossviewError
from solvers.features.edges import Features, no_features
from solvers.features.sectors import Sectors, sectors_between
from solvers.fields.crossfield import Convergence, CrossField, WorkingField
from solvers.fields.feature_alignment import align_with_features
from solvers.fields.integrability import Integrability
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import PreparedSurface
from solvers.fields.sampled import sampled
from solvers.fields.sector_quads import STRAIGHT, turned_over_corners
from solvers.frozen import freeze_arrays, frozen_property
from solvers.number_checks import whole_numbers
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray

FORCED = np.radians(60)
"""By how much the corners of quads may miss the angle they fill on a feature, radians. Chosen."""

AS_IT_IS = Convergence()
"""Of a field that no iteration changed."""


@dataclass(frozen=True, eq=False)
class AlignedField:
    """A field aligned with boundaries and features, and the integrability problem around it.

    Parameters
    ----------
    prepared : PreparedSurface
        The surface and the configuration.
    solver : IsotropicSolver
        Of the prepared surface; turned as the field is.
    isotropic : CrossField
        The isotropic field of the same configuration.
    correction : (m, 3) float array
        Corner values of the harmonic correction that aligns it.
    integrability : Integrability
        With the aligned field as its initial field.
    released : Features
        Those that it does not follow: there is no room for a quad beside each of these and the
        others.
    turns : tuple of int
        Quarter turns over each condition's path, besides those nearest to the isotropic field.
    turning : (m, 3) float array, or None
        What aligns it with features, or by how much the solver turns all crosses; None for
        neither.
    without : Features
        Further ones that it does not follow, as it was not to.

    Examples
    --------
    What the isotropic field misses on an annulus, the sum of indices times polar angles over four:

    >>> import numpy as np
    >>> from solvers.fields import aligned_field, prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> aligned = aligned_field(prepare(surface, [three, five]))
    >>> (defect,) = aligned.isotropic.defects  # of +1 at the angle 0 and -1 at arctan(0.3 / 0.5)
    >>> bool(abs(defect + np.arctan(0.6) / 4) < 2e-3), aligned.turns
    (True, (0,))
    """

    prepared: PreparedSurface
    solver: IsotropicSolver
    isotropic: CrossField
    correction: FloatArray
    integrability: Integrability
    released: Features
    turns: tuple[int, ...]
    turning: FloatArray | None
    without: Features

    @property
    def features(self) -> Features:
        """Those that it follows."""
        return self.integrability.discretization.features

    def partly(self, fraction: float) -> Integrability:
        """Return the problem around the field with only a fraction of the correction.

        Parameters
        ----------
        fraction : float
            From 0, the isotropic field, to 1, the aligned one; below 0 off to the other side.
        """
        i = self.integrability
        conjugate = self.isotropic.solved.H[i.triangulation.faces] + fraction * self.correction
        turning = None if self.turning is None else fraction * self.turning
        return Integrability(i.discretization, conjugate, i.period_jumps, i.features, turning)

    @cached_property
    def sectors(self) -> Sectors:
        """What features and boundary cut the neighbourhoods of vertices into, as it is solved."""
        return sectors_between(self.integrability.triangulation, self.integrability.features)

    @frozen_property
    def sector_quads(self) -> FloatArray:
        """(s,) how many quads meet in each of the sectors, whole beside features."""
        i = self.integrability
        turned = i.triangulation.angles - turned_over_corners(i.offsets)
        return self.sectors.total(turned) / QUARTER

    @frozen_property
    def forced_corners(self) -> IntArray:
        """Regular vertices of features where quads meet in another number than the angles ask for.

        There the singularities on both sides of a curve do not fit it.
        """
        features, sectors = self.features, self.sectors
        off = np.abs(QUARTER * self.sector_quads - sectors.angle)
        regular = np.zeros(self.integrability.triangulation.n_vertices, dtype=bool)
        regular[: len(features.degrees)] = features.degrees > 0
        for s in self.isotropic.singularities:
            regular[self.isotropic.surface.nearest_vertex(s.point)] = False
        return np.unique(sectors.vertex[(off > FORCED) & regular[sectors.vertex]])

    @frozen_property
    def bent(self) -> IntArray:
        """Vertices of the triangulation at which features do not go straight on in a map."""
        s = self.sectors
        other = np.rint(self.sector_quads) != STRAIGHT
        return np.unique(s.vertex[other & ((s.start >= 0) | (s.end >= 0))])

    @property
    def start(self) -> FloatArray:
        """The unknowns of the aligned field with the isotropic size for both scales."""
        x = np.zeros(self.integrability.assembly.n)
        h = self.isotropic.solved.H
        x[: len(h)] = -h
        return x


@dataclass(frozen=True, eq=False)
class IntegratedField:
    """A point of the integrability problem around an aligned field: the field itself, or solved.

    Parameters
    ----------
    aligned : AlignedField
        The problem.
    x : (N,) float array
        Its unknowns.
    method : str
        The solver's name.
    convergence : Convergence
        How it came to `x`.

    Examples
    --------
    The aligned field itself, before any solve for two sizes; it is not integrable:

    >>> import numpy as np
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> aligned = aligned_field(prepare(surface, [three, five]))
    >>> field = IntegratedField(aligned, aligned.start).field
    >>> bool(np.abs(field.boundary_misalignment).max() < 1e-9), field.energy > 0.1
    (True, True)
    """

    aligned: AlignedField
    x: FloatArray
    method: str = "aligned"
    convergence: Convergence = AS_IT_IS

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @cached_property
    def field(self) -> CrossField:
        """The crosses, sizes and errors."""
        i, x = self.aligned.integrability, self.x
        d, t = i.discretization, i.triangulation
        a, s, delta = i.local(x)
        theta = i.theta + delta.mean(axis=1)
        # The turning is affine in each triangle; its value at midpoints less the barycentre's.
        offsets = i.offsets + delta - delta.mean(axis=1)[:, None]
        density = (i.residual(x).values ** 2).sum(axis=1) / t.areas
        h = -x[: t.n_vertices]
        mean = -(t.areas @ a.mean(axis=1)) / t.areas.sum()
        none = np.zeros(len(d.conditions))
        solved = WorkingField(d.working, h - mean, theta, s, density)
        # The function of halfedge i is 1 - 2 times the hat function of corner i + 2.
        seen = sampled(d, solved, t.gradients(-2.0 * offsets[:, [1, 2, 0]]))
        return replace(
            self.aligned.isotropic,
            method=self.method,
            H=seen.H,
            theta=seen.theta,
            defects=d.defects(theta, offsets),
            boundary_misalignment=d.boundary_misalignment(theta, offsets),
            max_closing_error=d.max_closing_error(theta, offsets, none),
            feature_misalignment=d.feature_misalignment(theta, offsets),
            half_log_aspect=seen.half_log_aspect,
            error_density=seen.error_density,
            convergence=self.convergence,
            on_working=None if d.working.unchanged else solved,
        )


def aligned_field(
    prepared: PreparedSurface,
    turns: Sequence[int] | None = None,
    *,
    like: CrossField | None = None,
    without: Features | None = None,
) -> AlignedField:
    """Align the field of a configuration with every boundary, handle and feature.

    Parameters
    ----------
    prepared : PreparedSurface
        The surface and the configuration, as `prepare` makes them.
    turns : sequence of int, optional
        Quarter turns to add over each condition's path; by default none, which is the multiple
        nearest to the isotropic rotation; with features those that leave the field smoothest.
        Others are different layouts.
    like : CrossField, optional
        On the same surface. Where neither a boundary nor a feature fixes the direction of the
        crosses, they are turned to be nearest to those of this field.
    without : Features, optional
        Features of the prepared surface that are not to be followed.

    Returns
    -------
    AlignedField
        With the integrability problem around it.

    Raises
    ------
    CrossviewError
        If `turns` has the wrong length, or one is no whole number.
    SingularityError
        As `IsotropicSolver.solve`.

    Notes
    -----
    The paper's section "Local manifold basis generation and theta initialization"; with the
    multiple of 90 degrees that is nearest to the isotropic rotation.

    Examples
    --------
    A square needs no correction: its isotropic field is aligned with all sides.

    >>> from solvers.fields import aligned_field, prepare
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> bool(abs(aligned.correction).max() < 1e-12)
    True
    """
    solver, singularities = prepared.operators.solver, prepared.singularities
    field, d = solver.solve(singularities), solver.discretization
    if turns is not None:
        turns = whole_numbers("the turns", turns, (None,)).tolist()
        if len(turns) != len(field.defects):
            raise CrossviewError(
                f"{len(turns)} turns are given for {len(field.defects)} holonomy conditions",
                "turns",
                "give one whole number for each condition",
            )
    if like is not None and solver.gauge_free:
        solver = solver.in_gauge(field.turn_to(like))
        field = solver.solve(singularities)
    conjugate, turning = field.solved.H[d.triangulation.faces], None
    released = none = no_features(solver.surface)
    left_out = none if without is None else without.require_on(solver.surface)
    if len(d.features):
        found = align_with_features(
            solver.holonomy, conjugate, field.defects, turns, left_out.edges
        )
        turns, turning, released = found.turns.tolist(), found.turning, found.released
        if len(found.discretization.features) < len(d.features):
            d = found.discretization
            solver = solver.following(d)
            field = solver.solve(singularities)
    elif solver.gauge:
        turning = np.full(conjugate.shape, solver.gauge)
    chosen = tuple(turns or [0] * len(field.defects))
    correction = solver.holonomy.harmonic_correction(QUARTER * np.array(chosen) - field.defects)
    integrability = Integrability(
        d, conjugate + correction, features=d.feature_halfedges, turning=turning
    )
    return AlignedField(
        prepared, solver, field, correction, integrability, released, chosen, turning, left_out
    )
