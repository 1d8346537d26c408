"""The anisotropic cross-field: two scales, integrable and aligned where one scale cannot be both.

Minimum-norm Newton on E = 0, an underdetermined system, from the boundary-aligned field; then a
slide along E = 0 to the smoothest scales (the paper's regulariser). Where the paper's alternation
stalls in local minima of E, this converges quadratically.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from solvers.algebra.factorization import Analysis, Factorization
from solvers.fields.integrability import Integrability, Residual, norm
from solvers.progress import Progress
from solvers.surface.triangulation import FloatArray

PENALTY = 1e-7
"""Augmented-Lagrangian penalty, a pure number as E is.

Measured: with three passes a step solves J d = -rho to round-off.
"""

PASSES, ROUNDING = 3, 1e-13
"""Most passes, and how small a part of rho is left when no further one helps. Measured; chosen."""

TURN_LIMIT = 0.5
"""Most that a step may turn a cross, radians. Chosen: less than the quarter turn's half."""

CONVERGED = 1e-11
"""E below which nothing but rounding is left. Chosen; measured at 109 000 triangles: 3e-14."""

LEAST_GAIN = 1e-2
"""Fall of the roughness in a step, relative, below which sliding ends. Chosen."""

SMOOTH_SCALES, SMOOTH_TURNS = 1e-2, 1e-3
"""Weights in the metric in which a step is smallest: of the scales' stiffness beside their mass,
and of the stiffness and mass of turns.

Measured on annuli with defects of 0 to 44 degrees: E at rounding in 4 to 7 steps.
"""


@dataclass(frozen=True)
class NewtonStep(Progress):
    """An iteration of a solver for E = 0.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    energy : float
        E after the step.
    x : (N,) float array
        The unknowns of `Integrability` after the step.
    """

    energy: float
    x: FloatArray


@dataclass(frozen=True, eq=False)
class Descent:
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
    accelerated : bool, optional
        As in `Analysis`.
    """

    def __init__(self, integrability: Integrability, *, accelerated: bool = True) -> None:
        self.integrability = integrability
        self._metric = integrability.assembly.packed(step_metric(integrability))
        self._analysis = Analysis(accelerated=accelerated, lower=True)

    def solve(self, x: FloatArray, limit: int = 30) -> Generator[Progress, None, Descent]:
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
            factor = self._factor(self._metric, r)
            direction = self._constrained(factor, r, r.values, None)
            x, after = self._advance(x, r, direction)
            if after.energy >= r.energy:
                break
            r = after
            history.append(r.energy)
            yield NewtonStep("Newton", min(1.0, len(history) / 8), r.energy, x)
        # A last step may fail to lower E only because of rounding.
        return Descent(x, tuple(history), r.energy <= 10 * CONVERGED)

    def slide(
        self, x: FloatArray, target: FloatArray, limit: int = 8
    ) -> Generator[Progress, None, Descent]:
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
        Descent
            A point with E = 0.
        """
        assembly = self.integrability.assembly
        metric = assembly.packed(roughness(self.integrability)) + 1e-6 * self._metric
        rough = self._roughness_of(x, target)
        r = self.integrability.residual(x)
        history = [r.energy]
        for count in range(limit):
            factor = self._factor(metric, r)
            downhill = -self._roughness_gradient(x, target)
            direction = self._constrained(factor, r, r.values, downhill)
            smoother = self._smoother(factor, r, x, direction, target, rough)
            if smoother is None:
                break
            x, r = smoother
            before, rough = rough, self._roughness_of(x, target)
            history.append(r.energy)
            yield NewtonStep("smoothing the sizes", (count + 1) / limit, r.energy, x)
            if rough > (1 - LEAST_GAIN) * before:
                break
        end = yield from self.solve(x)
        return Descent(end.x, (*history[:-1], *end.history), end.converged)

    def _factor(self, metric: FloatArray, r: Residual) -> Factorization:
        assembly = self.integrability.assembly
        normal = assembly.normal(r.jacobian)
        normal /= PENALTY
        normal += metric
        return self._analysis.factor(assembly.lower(normal))

    def _constrained(
        self, factor: Factorization, r: Residual, values: FloatArray, linear: FloatArray | None
    ) -> FloatArray:
        """Return the d with J d = -values that minimises d . metric d / 2 - linear . d."""
        assembly = self.integrability.assembly
        multiplier = np.zeros_like(values)
        enough = ROUNDING * norm(values)
        for _ in range(PASSES):
            force = -assembly.vector(r.pulled(values / PENALTY + multiplier))
            d = factor.solve(force if linear is None else linear + force)
            off = r.pushed(assembly.gathered(d)) + values
            if norm(off) <= enough:
                break
            multiplier += off / PENALTY
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
    ) -> tuple[FloatArray, Residual] | None:
        """Return a point along the direction, brought back to E = 0, that is smoother."""
        for length in (1.0, 0.5, 0.25, 0.125):
            trial = x + length * direction
            off = self.integrability.residual(trial)
            for _ in range(4):  # the factor still serves to correct: chord steps
                if off.energy < 1e-7:
                    break
                trial = trial + self._constrained(factor, r, off.values, None)
                off = self.integrability.residual(trial)
            if off.energy < 1e-3 and self._roughness_of(trial, target) < rough:
                return trial, off
        return None

    def _differences(self, x: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return corner values of a and s less those of the target sizes."""
        a, s, _ = self.integrability.local(x)
        first, second = target[:, 0], target[:, 1]
        return a + (first + second) / 2, s - (second - first) / 2

    def _roughness_of(self, x: FloatArray, target: FloatArray) -> float:
        a, s = self._differences(x, target)
        by_a, by_s = self._pull_of_roughness(a, s)
        return float((a * by_a).sum() + (s * by_s).sum())

    def _roughness_gradient(self, x: FloatArray, target: FloatArray) -> FloatArray:
        i = self.integrability
        a, s = self._differences(x, target)
        by_a, by_s = self._pull_of_roughness(a, s)
        return i.assembly.vector(np.concatenate([by_a, by_s * i.sheet, np.zeros_like(a)], axis=1))

    def _pull_of_roughness(self, a: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the element stiffness matrices times corner values (m, 3)."""
        laplacian = self.integrability.hat_stiffness.transpose(1, 2, 0)
        first, second = ((laplacian * values.T).sum(axis=1).T for values in (a, s))
        return first, second


def step_metric(integrability: Integrability) -> FloatArray:
    """Return the (m, 9, 9) element matrices of the metric that makes a step small.

    Mass and a little stiffness on the scales, a thousandth of both on the turning; the mass is
    in parts of the surface's area, so that the metric does not depend on its size.
    """
    t, laplacian = integrability.triangulation, integrability.hat_stiffness
    mass = np.eye(3) * (t.areas / (3 * t.areas.sum()))[:, None, None]
    signs = integrability.sheet[:, :, None] * integrability.sheet[:, None, :]
    opposite = np.array([2, 0, 1])
    metric = np.zeros((9, 9, t.n_faces)).transpose(2, 0, 1)
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
    elements = np.zeros((9, 9, len(laplacian))).transpose(2, 0, 1)
    elements[:, :3, :3] = laplacian
    elements[:, 3:6, 3:6] = signs * laplacian
    return elements
