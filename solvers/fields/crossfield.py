"""The result of every solver: a cross-field with its scales and its own consistency measure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from solvers.errors import CrossviewError
from solvers.frozen import freeze_arrays, frozen_property
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import FloatArray, IntrinsicTriangulation
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import WorkingTriangulation


@dataclass(frozen=True)
class Convergence:
    """How an iteration for E = 0 went.

    Parameters
    ----------
    energies : tuple of float
        E at the start and after each iteration.
    converged : bool
        Whether the iteration reached its goal; if not, the field is the best iterate.
    smoothed_from : int, optional
        Number of iterations after which the sizes are smoothed, each step of which leaves E = 0
        for a moment; None: they are not.

    Examples
    --------
    >>> from solvers.fields import Convergence
    >>> Convergence()  # of a field that needs no iteration
    Convergence(energies=(), converged=True, smoothed_from=None)
    """

    energies: tuple[float, ...] = ()
    converged: bool = True
    smoothed_from: int | None = None


@dataclass(frozen=True, eq=False)
class WorkingField:
    """A cross in each triangle of a working triangulation: what is solved for.

    Parameters
    ----------
    working : WorkingTriangulation
        Of a surface.
    H : (n,) float array
        As of `CrossField`, at the vertices of the triangulation.
    theta : (m,) float array
        As of `CrossField`, in its triangles.
    half_log_aspect : (m, 3) float array
        As of `CrossField`, at their corners.
    error_density : (m,) float array
        As of `CrossField`, in its triangles.

    Examples
    --------
    Its triangulation may have more triangles than the surface:

    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import rectangle
    >>> strip = rectangle(40, 3, 4, 2)
    >>> field = IsotropicSolver(strip).solve([])
    >>> len(field.theta), len(field.solved.theta) > len(field.theta)
    (16, True)
    """

    working: WorkingTriangulation
    H: FloatArray
    theta: FloatArray
    half_log_aspect: FloatArray
    error_density: FloatArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def triangulation(self) -> IntrinsicTriangulation:
        """What it lives on."""
        return self.working.triangulation


@dataclass(frozen=True, eq=False)
class CrossField:
    """A cross in each triangle of a surface; its arrays cannot be written to.

    Parameters
    ----------
    surface : TriSurface
        Where.
    singularities : tuple of Singularity
        The imposed configuration.
    corners : mapping of int to int
        Index of each boundary vertex where the field turns.
    method : str
        The solver's name.
    H : (n,) float array
        Logarithm of the size at each vertex, with area-weighted mean zero (paper, L = e^H).
    theta : (m,) float array
        Angle of u at each barycentre against the triangle's first edge, radians.
    defects : (2 g + max(b - 1, 0),) float array
        Holonomy defect of each condition of the surface, radians in (-pi/4, pi/4].
    boundary_misalignment : (b,) float array
        Largest angle between the crosses and each boundary loop, with sign, radians.
    residual : float
        Largest residual of the system for H, relative to its terms.
    max_closing_error : float
        Largest angle, over all edges, by which the crosses of two triangles fail to differ by
        whole quarter turns (and the defect of the handle loop, for edges on one), radians.
    half_log_aspect : (m, 3) float array
        (H2 - H1) / 2 at the corners of each triangle; 0 for one scale.
    error_density : (m,) float array
        rho1^2 + rho2^2 in each triangle (paper, equation intError).
    convergence : Convergence
        How the solver came to E.
    feature_misalignment : (c,) float array
        Largest angle between the crosses and each feature curve, with sign, radians.
    on_working : WorkingField, optional
        What was solved for, where that is on other triangles than the surface's; this is sampled
        from it, but for the measures of the whole field.

    Examples
    --------
    Around an annulus the crosses follow the circles, and quads grow with their radius, e^H = c r:

    >>> import numpy as np
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import annulus
    >>> surface = annulus(n=48)
    >>> field = IsotropicSolver(surface).solve([])
    >>> size = np.exp(field.H) / np.linalg.norm(surface.vertices, axis=1)
    >>> float(size.max() / size.min()) < 1.003  # less by four if n is twice as large
    True
    >>> radial = surface.barycentres / np.linalg.norm(surface.barycentres, axis=1)[:, None]
    >>> away = np.abs((field.u * radial).sum(axis=1))  # a cross has a branch along the radius
    >>> bool(np.minimum(away, 1 - away).max() < 1e-9)
    True
    """

    surface: TriSurface
    singularities: tuple[Singularity, ...]
    corners: Mapping[int, int]
    method: str
    H: FloatArray = field(repr=False)
    theta: FloatArray = field(repr=False)
    defects: FloatArray
    boundary_misalignment: FloatArray
    residual: float
    max_closing_error: float
    half_log_aspect: FloatArray = field(repr=False)
    error_density: FloatArray = field(repr=False)
    convergence: Convergence
    feature_misalignment: FloatArray = field(default_factory=lambda: np.zeros(0))
    on_working: WorkingField | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @cached_property
    def solved(self) -> WorkingField:
        """What was solved for, on the triangles it was solved on."""
        if self.on_working is not None:
            return self.on_working
        own = WorkingTriangulation.of(self.surface.triangulation)
        return WorkingField(own, self.H, self.theta, self.half_log_aspect, self.error_density)

    def turned(self, angle: float) -> CrossField:
        """Return it with all crosses turned by an angle, as if nothing fixed their direction.

        Parameters
        ----------
        angle : float
            Radians.
        """
        inner = self.on_working
        if inner is not None:
            inner = replace(inner, theta=inner.theta + angle)
        return replace(self, theta=self.theta + angle, on_working=inner)

    @frozen_property
    def H1(self) -> FloatArray:
        """(m, 3) logarithm of the size along u at the corners of each triangle."""
        return self.H[self.surface.faces] - self.half_log_aspect

    @frozen_property
    def H2(self) -> FloatArray:
        """(m, 3) logarithm of the size along v at the corners of each triangle."""
        return self.H[self.surface.faces] + self.half_log_aspect

    @frozen_property
    def log_aspect(self) -> FloatArray:
        """(m,) |H2 - H1| at each barycentre."""
        return np.asarray(np.abs(2 * self.half_log_aspect.mean(axis=1)))

    @cached_property
    def max_log_aspect(self) -> float:
        """Largest |H2 - H1| away from the triangles around singularities."""
        t = self.solved.triangulation
        singular = np.zeros(t.n_vertices, dtype=bool)
        for s in self.singularities:
            singular[self.surface.nearest_vertex(s.point)] = True
        away = ~singular[t.faces].any(axis=1)
        log_aspect = np.abs(2 * self.solved.half_log_aspect.mean(axis=1))
        return float(log_aspect[away].max(initial=0.0))

    @cached_property
    def energy(self) -> float:
        """The integrability error E (paper, equation intError)."""
        return float(np.sqrt(self.solved.triangulation.areas @ self.solved.error_density))

    @frozen_property
    def u(self) -> FloatArray:
        """(m, 3) unit vector of the cross's first branch at each barycentre."""
        along, across = self.surface.face_frames
        return np.cos(self.theta)[:, None] * along + np.sin(self.theta)[:, None] * across

    @frozen_property
    def v(self) -> FloatArray:
        """(m, 3) unit vector of the second branch, 90 degrees from the first."""
        along, across = self.surface.face_frames
        return np.cos(self.theta)[:, None] * across - np.sin(self.theta)[:, None] * along

    def turn_to(self, other: CrossField) -> float:
        """Return the one turn of all crosses that brings them nearest to those of another field.

        Parameters
        ----------
        other : CrossField
            On the same surface.

        Returns
        -------
        float
            Radians in (-pi/4, pi/4]; of the mean fourth power, weighted by area.

        Raises
        ------
        CrossviewError
            If the other is on another surface.
        """
        if other.surface is not self.surface and other.surface.mark != self.surface.mark:
            raise CrossviewError("the other field is on another surface")
        power = self.surface.face_areas @ np.exp(4j * (other.theta - self.theta))
        return float(np.angle(power)) / 4

    @property
    def index_sum(self) -> int:
        """Sum of the indices of singularities and corners."""
        return sum(s.index for s in self.singularities) + sum(self.corners.values())

    @property
    def index_required(self) -> int:
        """Four times the Euler characteristic."""
        return 4 * self.surface.euler_characteristic
