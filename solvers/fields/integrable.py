"""The anisotropic and the alternating field of a configuration, from start to verdict."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from solvers.fields.aligned import AlignedField, IntegratedField
from solvers.fields.alternating import alternate
from solvers.fields.anisotropic import Descent, MinimumNormNewton, NewtonStep
from solvers.fields.crossfield import Convergence
from solvers.fields.sizes import size_map
from solvers.fields.verdict import NEARLY_INTEGRABLE
from solvers.progress import Progress, relayed
from solvers.surface.triangulation import FloatArray

HOMOTOPY_STAGES = (2, 4, 8)
"""Parts that the way from the isotropic to the aligned field is cut into, try after try. Chosen."""

Iteration = Generator[Progress, None, Descent]


@dataclass(frozen=True)
class FieldStep(Progress):
    """An iteration, with the field as it is.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    energies : tuple of float
        E at the start and after each iteration so far.
    so_far : IntegratedField
        The field of this iteration, not converged; its parts are computed when asked for.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import FieldStep, aligned_field, anisotropic_field, prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> steps = []
    >>> end = run(anisotropic_field(aligned_field(prepare(surface, [three, five]))), steps.append)
    >>> all(isinstance(step, FieldStep) for step in steps)
    True
    >>> steps[-1].energies == end.convergence.energies
    True
    """

    energies: tuple[float, ...]
    so_far: IntegratedField


def anisotropic_field(
    aligned: AlignedField,
    sizes: FloatArray | None = None,
    *,
    smooth: bool = True,
    detour: float | None = None,
) -> Generator[Progress, None, IntegratedField]:
    """Find two scales and an angle with E = 0: Newton, homotopy where it fails, smoothing.

    Parameters
    ----------
    aligned : AlignedField
        Where to start; left alone if it is integrable already.
    sizes : (n,) or (n, 2) float array, optional
        Sizes to follow as closely as E = 0 allows: one for both branches, or one along the
        branch nearer to the x axis and one along the other.
    smooth : bool, optional
        Whether to move along E = 0 to the smoothest scales.
    detour : float, optional
        Fraction of the correction, as of `AlignedField.partly`, with which to solve first; by
        default straight to all of it. There are many fields with E = 0, and another way leads to
        another.

    Returns
    -------
    IntegratedField
        The best found, converged or not; the result of the computation, for `solvers.run`.

    Raises
    ------
    CrossviewError
        If the sizes have the wrong length or are not positive and finite.

    Notes
    -----
    The smallest step onto E = 0 (paper, equation intError), linearised, in an augmented-Lagrangian
    form; quadratic convergence where the paper's alternation stalls.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import aligned_field, anisotropic_field, prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> field = run(anisotropic_field(aligned_field(prepare(surface, [three, five])))).field
    >>> field.convergence.energies[0] > 0.1, field.energy < 1e-11
    (True, True)
    >>> bool(abs(field.boundary_misalignment).max() < 1e-9)
    True
    """
    target = np.zeros((aligned.integrability.triangulation.n_faces, 2, 3))
    if sizes is not None:
        target = _log_targets(aligned, sizes)
    newton = MinimumNormNewton(aligned.integrability)
    way = _solve(aligned, newton) if detour is None else by_detour(aligned, newton, detour)
    integrated = yield from _shown(aligned, "anisotropic", way)
    smoothed_from = None
    if (
        smooth
        and integrated.converged
        and (sizes is not None or integrated.history[0] > NEARLY_INTEGRABLE)
    ):
        smoothed_from = len(integrated.history) - 1
        smoothing = newton.slide(integrated.x, target)
        smoothed = yield from _shown(aligned, "anisotropic", smoothing, integrated.history)
        integrated = replace(smoothed, history=integrated.history + smoothed.history[1:])
    convergence = Convergence(integrated.history, integrated.converged, smoothed_from)
    return IntegratedField(aligned, integrated.x, "anisotropic", convergence)


def alternating_field(
    aligned: AlignedField, weight: float = 1.0
) -> Generator[Progress, None, IntegratedField]:
    """Minimise E by the paper's Algorithm 3.

    Parameters
    ----------
    aligned : AlignedField
        Where to start.
    weight : float, optional
        Of the proximal term; the paper's is 1.

    Returns
    -------
    IntegratedField
        Where E no longer falls; the result of the computation, for `solvers.run`.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import aligned_field, alternating_field, prepare
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> aligned = aligned_field(prepare(surface, [three, five], refine=0))
    >>> energies = run(alternating_field(aligned, weight=1e-3)).convergence.energies
    >>> all(after <= before for before, after in zip(energies, energies[1:]))
    True
    """
    end = yield from _shown(aligned, "alternating", alternate(aligned, weight))
    convergence = Convergence(end.history, end.converged)
    return IntegratedField(aligned, end.x, "alternating", convergence)


def _solve(aligned: AlignedField, newton: MinimumNormNewton) -> Iteration:
    """Newton from the aligned field; if it stalls, from the isotropic one by stages."""
    direct = yield from newton.solve(aligned.start)
    if direct.converged:
        return direct
    for stages in HOMOTOPY_STAGES:
        last = yield from by_stages(aligned, newton, stages)
        if last.converged:
            return Descent(last.x, direct.history + last.history, True)
    return direct


def by_stages(aligned: AlignedField, newton: MinimumNormNewton, stages: int) -> Iteration:
    """Turn the misaligned boundaries and handles to zero bit by bit, with E = 0 at each stage.

    The isotropic field is integrable, whatever its defects; the field with a fraction of the
    harmonic correction is next to the one with a smaller fraction.

    Parameters
    ----------
    aligned : AlignedField
        Where to get.
    newton : MinimumNormNewton
        On its integrability problem.
    stages : int
        Into how many parts the correction is cut.
    """
    x = aligned.start
    for stage in range(1, stages):
        partly = MinimumNormNewton(aligned.partly(stage / stages))
        x = (yield from partly.solve(x)).x
    return (yield from newton.solve(x))


def by_detour(aligned: AlignedField, newton: MinimumNormNewton, fraction: float) -> Iteration:
    """Go by the smoothest field with another part of the harmonic correction.

    Where singularities are to be far apart along a boundary, crosses that nearly follow it spiral,
    and the aspect of the smoothest field grows as the logarithm of what they miss, beyond all
    bounds. From the other side, a negative fraction, the way leads to a field that stays bounded.

    Parameters
    ----------
    aligned : AlignedField
        Where to get.
    newton : MinimumNormNewton
        On its integrability problem.
    fraction : float
        As of `AlignedField.partly`.
    """
    partly = MinimumNormNewton(aligned.partly(fraction))
    x = (yield from partly.solve(aligned.start)).x
    follow_none = np.zeros((aligned.integrability.triangulation.n_faces, 2, 3))
    x = (yield from partly.slide(x, follow_none)).x
    return (yield from newton.solve(x))


def _shown(
    aligned: AlignedField, method: str, iteration: Iteration, before: tuple[float, ...] = ()
) -> Iteration:
    """Run an iteration, showing each step as a field."""
    energies = list(before) or [aligned.integrability.residual(aligned.start).energy]

    def show(step: Progress) -> Progress | None:
        if not isinstance(step, NewtonStep):
            return None
        energies.append(step.energy)
        convergence = Convergence(tuple(energies), False, len(before) - 1 if before else None)
        so_far = IntegratedField(aligned, step.x, method, convergence)
        return FieldStep(step.stage, step.fraction, convergence.energies, so_far)

    return (yield from relayed(iteration, show))


def _log_targets(aligned: AlignedField, sizes: npt.ArrayLike) -> FloatArray:
    """Return the (m, 2, 3) logarithms of the sizes along u and v at the corners."""
    d, field = aligned.integrability.discretization, aligned.isotropic
    surface, t = d.surface, d.triangulation
    values = size_map(sizes, surface.n_vertices)
    if values.ndim == 1:
        values = np.stack([values, values], axis=1)
    face, weights = d.vertex_points
    logarithms = np.einsum("ki,kij->kj", weights, np.log(values)[surface.faces[face]])
    corners = logarithms[t.faces].transpose(0, 2, 1)
    centres = d.working.lift(np.arange(t.n_faces), t.corner_positions.mean(axis=1))
    angle = field.solved.theta + centres.turn
    along, across = (frame[centres.face, 0] for frame in surface.face_frames)
    swapped = np.abs(np.cos(angle) * along + np.sin(angle) * across) < np.abs(
        np.cos(angle) * across - np.sin(angle) * along
    )
    return np.asarray(np.where(swapped[:, None, None], corners[:, ::-1], corners))
