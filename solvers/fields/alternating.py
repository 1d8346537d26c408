"""The paper's own solver: Algorithms 1, 2 and 3, scales and angle in turn.

It stalls in local minima of E where the configuration is far from valid;
`solvers.fields.anisotropic` does not. Kept as the paper writes it, for comparison, with the
proximal weight as a parameter.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from solvers.algebra.factorization import Analysis, Factorization
from solvers.fields.aligned import AlignedField
from solvers.fields.anisotropic import Descent, NewtonStep, roughness
from solvers.fields.integrability import Integrability, Residual
from solvers.number_checks import real_number, whole_number
from solvers.progress import Progress
from solvers.surface.triangulation import FloatArray

LEAST_GAIN = 1e-4
"""Relative fall of E in an iteration below which it counts as having stopped. Chosen."""


def alternate(
    aligned: AlignedField, weight: float = 1.0, outer: int = 50, inner: int = 50
) -> Generator[Progress, None, Descent]:
    """Minimise E over (H1, H2) and over theta in turn (paper, Algorithm 3).

    Parameters
    ----------
    aligned : AlignedField
        Where to start.
    weight : float, optional
        Of the proximal term of Algorithm 1; the paper's is 1.
    outer, inner : int, optional
        Most iterations of Algorithm 3, and of Algorithms 1 and 2 within it.

    Returns
    -------
    Descent
        With E after each inner iteration; converged if E fell below 1e-10.
    """
    weight = real_number("the proximal weight", weight, above=0)
    outer, inner = (
        whole_number("outer iterations", outer, 0),
        whole_number("inner iterations", inner, 0),
    )
    i = aligned.integrability
    scales, angle = _ScaleStep(i, weight), _AngleStep(i)
    x = aligned.start
    history = [i.residual(x).energy]
    x = yield from _descend(scales, x, history, inner)
    for _ in range(outer):
        before = history[-1]
        x = yield from _descend(angle, x, history, inner)
        x = yield from _descend(scales, x, history, inner)
        if history[-1] >= before * (1 - LEAST_GAIN):
            break
    return Descent(x, tuple(history), history[-1] <= 1e-10)


def _descend(
    step: _ScaleStep | _AngleStep, x: FloatArray, history: list[float], limit: int
) -> Generator[Progress, None, FloatArray]:
    """Iterate while E falls; the last, which does not fall, is not taken."""
    step.prepare(x)
    for _ in range(limit):
        trial, before = step(x), history[-1]
        energy = step.integrability.residual(trial).energy
        if energy < before:
            history.append(energy)
            x = trial
            yield NewtonStep("alternating", min(1.0, len(history) / 100), energy, x)
        if energy >= before * (1 - LEAST_GAIN):
            break
    return x


class _ScaleStep:
    """Algorithm 1: min E(theta, f1, f2) + weight int |grad f_i - grad H_i|^2, theta fixed."""

    def __init__(self, integrability: Integrability, weight: float) -> None:
        self.integrability = integrability
        t = integrability.triangulation
        # Half the proximal term; the mass only fixes the constant, which E does not see.
        elements = 2 * weight * roughness(integrability)
        diagonal = np.arange(9)
        elements[:, diagonal, diagonal] += 1e-9 * (t.areas / t.areas.sum())[:, None]
        self._proximal = integrability.assembly.packed(elements)
        self._analysis = Analysis(lower=True)
        self._factor: Factorization

    def prepare(self, x: FloatArray) -> None:
        i = self.integrability
        by_all = i.residual(x).jacobian
        by_scales = by_all.copy(order="K")
        by_scales[:, :, 6:] = 0.0
        self._at = Residual(np.zeros((len(by_all), 2)), lambda: by_scales)
        matrix = i.assembly.lower(i.assembly.normal(by_scales) + self._proximal)
        self._factor = self._analysis.factor(matrix)

    def __call__(self, x: FloatArray) -> FloatArray:
        i = self.integrability
        force = self._at.pulled(i.residual(x).values)
        return np.asarray(x - self._factor.solve(i.assembly.vector(force)))


class _AngleStep:
    """Algorithm 2: min of E over theta with the directions u, v frozen at the last theta."""

    def __init__(self, integrability: Integrability) -> None:
        i = self.integrability = integrability
        t = i.triangulation
        opposite = np.array([2, 0, 1])
        elements = np.zeros((9, 9, t.n_faces)).transpose(2, 0, 1)
        elements[:, 6:, 6:] = 4 * i.hat_stiffness[:, opposite][:, :, opposite]
        diagonal = np.arange(9)
        elements[:, diagonal, diagonal] += 1e-9 * (t.areas / t.areas.sum())[:, None]
        matrix = i.assembly.lower(i.assembly.packed(elements))
        # u and v are orthonormal, so the system is the Crouzeix-Raviart one whatever theta is.
        self._factor = Analysis(lower=True).factor(matrix)

    def prepare(self, x: FloatArray) -> None:
        """Nothing changes with x."""

    def __call__(self, x: FloatArray) -> FloatArray:
        i = self.integrability
        r = i.residual(x)
        frozen = i.frozen_turning(x)
        force = np.zeros((9, len(frozen))).T
        for rho in (0, 1):
            force[:, 6:] += frozen[:, rho] * r.values[:, rho, None]
        return np.asarray(x - self._factor.solve(i.assembly.vector(force)))
