"""The anisotropic cross-field: two scales, integrable and aligned where one scale cannot be both.

Minimum-norm Newton on E = 0, an underdetermined system, from the boundary-aligned field; then a
slide along E = 0 to the smoothest scales (the paper's regulariser). Where the paper's alternation
stalls in local minima of E, this converges quadratically.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from solvers.factorization import Analysis, Factorization
from solvers.integrability import Integrability, Residual
from solvers.progress import Progress
from solvers.triangulation import FloatArray

PENALTY = 1e-7
"""Augmented-Lagrangian penalty; with three passes a step solves J d = -rho to round-off."""

PASSES = 3
TURN_LIMIT = 0.5
"""Most that a step may turn a cross, radians."""

CONVERGED = 1e-11
"""E below which nothing but rounding is left."""

SMOOTH_SCALES, SMOOTH_TURNS = 1e-2, 1e-3


@dataclass(frozen=True)
class NewtonStep(Progress):
    """An iteration of a solver for E = 0.

    Parameters
    ----------
    stage, fraction
        As in `Progress`.
    energy : float
        E after the step.
    x : (N,) float array
        The unknowns of `Integrability` after the step.
    """

    energy: float
    x: FloatArray


@dataclass(frozen=True, eq=False)
class Iterate:
    """Where a solver for E = 0 ended.

    Parameters
    ----------
    x : (N,) float array
        The unknowns of `Integrability`: the best found.
    history : tuple of float
        E at the start and after each iteration.
    converged : bool
        Whether E came down to `CONVERGED`.
    """

    x: FloatArray
    history: tuple[float, ...]
    converged: bool


class MinimumNormNewton:
    """Steps onto E = 0, smallest in a metric, and steps along it.

    Parameters
    ----------
    integrability : Integrability
        The residual.
    """

    def __init__(self, integrability: Integrability) -> None:
        self.integrability = integrability
        self._metric = step_metric(integrability)
        self._roughness = roughness(integrability)
        zero = integrability.residual(np.zeros(integrability.assembly.n))
        self._analysis = Analysis(self._system(self._metric, zero))

    def solve(self, x: FloatArray, limit: int = 30) -> Generator[Progress, None, Iterate]:
        """Newton steps until E is nothing but rounding.

        Parameters
        ----------
        x : (N,) float array
            Where to start.
        limit : int, optional
            Most steps.
        """
        r = self.integrability.residual(x)
        history = [r.energy]
        while r.energy > CONVERGED and len(history) <= limit:
            factor = self._analysis.factor(self._system(self._metric, r))
            direction = self._constrained(factor, r, np.zeros_like(x))
            x, after = self._advance(x, r, direction)
            if after.energy >= r.energy:
                break
            r = after
            history.append(r.energy)
            yield NewtonStep("Newton", min(1.0, len(history) / 8), r.energy, x)
        # A last step may fail to lower E only because of rounding.
        return Iterate(x, tuple(history), r.energy <= 10 * CONVERGED)

    def slide(
        self, x: FloatArray, target: FloatArray, limit: int = 8
    ) -> Generator[Progress, None, Iterate]:
        """Move along E = 0 to the smoothest scales: min of sum |grad H_i - grad target_i|^2.

        Parameters
        ----------
        x : (N,) float array
            A point with E = 0.
        target : (m, 2, 3) float array
            Corner values the two scales are to follow; zero for none.
        limit : int, optional
            Most steps.

        Returns
        -------
        Iterate
            A point with E = 0.
        """
        metric = self._roughness + 1e-6 * self._metric
        rough = self._roughness_of(x, target)
        for count in range(limit):
            r = self.integrability.residual(x)
            factor = self._analysis.factor(self._system(metric, r))
            direction = self._constrained(factor, r, -self._roughness_gradient(x, target))
            trial = self._smoother(factor, r, x, direction, target, rough)
            if trial is None:
                break
            gain, x = 1 - self._roughness_of(trial, target) / rough, trial
            rough *= 1 - gain
            yield NewtonStep("smoothing the sizes", (count + 1) / limit, r.energy, x)
            if gain < 1e-2:
                break
        return (yield from self.solve(x))

    def _system(self, metric: FloatArray, r: Residual) -> csc_array:
        normal = np.einsum("mri,mrj->mij", r.jacobian, r.jacobian)
        return self.integrability.assembly.matrix(metric + normal / PENALTY)

    def _constrained(self, factor: Factorization, r: Residual, linear: FloatArray) -> FloatArray:
        """Return the d with J d = -rho that minimises d . metric d / 2 - linear . d."""
        assembly = self.integrability.assembly
        multiplier = np.zeros_like(r.values)
        for _ in range(PASSES):
            force = np.einsum("mri,mr->mi", r.jacobian, r.values / PENALTY + multiplier)
            d = factor.solve(linear - assembly.vector(force))
            reached = np.einsum("mri,mi->mr", r.jacobian, assembly.gathered(d)) + r.values
            multiplier += reached / PENALTY
        return d

    def _advance(
        self, x: FloatArray, r: Residual, direction: FloatArray
    ) -> tuple[FloatArray, Residual]:
        """Take the step, capped where crosses would turn too far and halved until E falls."""
        turn = np.abs(self.integrability.local(direction)[2].mean(axis=1)).max()
        length = min(1.0, TURN_LIMIT / max(turn, TURN_LIMIT))
        for _ in range(12):
            trial = x + length * direction
            after = self.integrability.residual(trial)
            if after.energy < r.energy:
                return trial, after
            length /= 2
        return x, r

    def _smoother(
        self,
        factor: Factorization,
        r: Residual,
        x: FloatArray,
        direction: FloatArray,
        target: FloatArray,
        rough: float,
    ) -> FloatArray | None:
        """Return a point along the direction, brought back to E = 0, that is smoother."""
        for length in (1.0, 0.5, 0.25, 0.125):
            trial = x + length * direction
            for _ in range(4):  # the factor still serves to correct: chord steps
                off = self.integrability.residual(trial)
                if off.energy < 1e-7:
                    break
                step = Residual(off.values, r.jacobian)
                trial = trial + self._constrained(factor, step, np.zeros_like(x))
            close = self.integrability.residual(trial).energy < 1e-3
            if close and self._roughness_of(trial, target) < rough:
                return trial
        return None

    def _differences(self, x: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return corner values of a and s less those of the target sizes."""
        a, s, _ = self.integrability.local(x)
        first, second = target[:, 0], target[:, 1]
        return a + (first + second) / 2, s - (second - first) / 2

    def _roughness_of(self, x: FloatArray, target: FloatArray) -> float:
        a, s = self._differences(x, target)
        laplacian = self.integrability.hat_stiffness
        return float(
            np.einsum("mi,mij,mj->", a, laplacian, a) + np.einsum("mi,mij,mj->", s, laplacian, s)
        )

    def _roughness_gradient(self, x: FloatArray, target: FloatArray) -> FloatArray:
        i = self.integrability
        a, s = self._differences(x, target)
        by_a = np.einsum("mij,mj->mi", i.hat_stiffness, a)
        by_s = np.einsum("mij,mj->mi", i.hat_stiffness, s) * i.sheet
        return i.assembly.vector(np.concatenate([by_a, by_s, np.zeros_like(a)], axis=1))


def step_metric(integrability: Integrability) -> FloatArray:
    """Return the (m, 9, 9) element matrices of the metric that makes a step small.

    Mass and a little stiffness on the scales, a thousandth of both on the turning; the mass is
    in parts of the surface's area, so that the metric does not depend on its size.
    """
    t, laplacian = integrability.triangulation, integrability.hat_stiffness
    mass = np.eye(3) * (t.areas / (3 * t.areas.sum()))[:, None, None]
    signs = integrability.sheet[:, :, None] * integrability.sheet[:, None, :]
    opposite = np.array([2, 0, 1])
    metric = np.zeros((t.n_faces, 9, 9))
    metric[:, :3, :3] = mass + SMOOTH_SCALES * laplacian
    metric[:, 3:6, 3:6] = mass + SMOOTH_SCALES * signs * laplacian
    edge_stiffness = 4 * laplacian[:, opposite][:, :, opposite]
    metric[:, 6:, 6:] = SMOOTH_TURNS * (mass + edge_stiffness)
    return metric


def roughness(integrability: Integrability) -> FloatArray:
    """Return the (m, 9, 9) element matrices of half the paper's regulariser.

    The integral of |grad H1|^2 + |grad H2|^2 is twice that of |grad a|^2 + |grad s|^2.
    """
    laplacian = integrability.hat_stiffness
    signs = integrability.sheet[:, :, None] * integrability.sheet[:, None, :]
    elements = np.zeros((len(laplacian), 9, 9))
    elements[:, :3, :3] = laplacian
    elements[:, 3:6, 3:6] = signs * laplacian
    return elements
