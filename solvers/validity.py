"""From any configuration to a valid one: singularities moved as little as need be.

Newton on the holonomy defects (Abel-Jacobi conditions): moving singularity j by d_j changes defect
i by (pi/2) k_j grad Z_i(x_j) . d_j, and the least d that takes all defects to zero is taken. The
points walk straight on the surface. At the end they are inserted as vertices of the refined
surface, where the defects of a fresh operator are corrected until they vanish too.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from solvers.discretization import QUARTER
from solvers.errors import SingularityError
from solvers.geodesics import straightest
from solvers.holonomy import Holonomy
from solvers.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.refinement import refine_at
from solvers.singularities import Singularity, require_budget
from solvers.surface import TriSurface
from solvers.triangulation import BoolArray, FloatArray, wrap

TOLERANCE = np.radians(1e-6)
LONGEST_STEP = 0.1
"""Longest move of a singularity in one step, in square roots of the surface's area."""

CLOSEST = 0.02
"""How near singularities may come to each other, in the same unit."""


@dataclass(frozen=True)
class Moved(Progress):
    """A step on the way to a valid configuration.

    Parameters
    ----------
    stage, fraction
        As in `Progress`.
    singularities : tuple of Singularity
        Where they are.
    defects : (c,) float array
        Their holonomy defects, radians.
    """

    singularities: tuple[Singularity, ...]
    defects: FloatArray


def make_valid(
    surface: TriSurface,
    singularities: Sequence[Singularity],
    corners: Mapping[int, int] | None = None,
    levels: int = 3,
) -> Generator[Progress, None, Moved]:
    """Move the unlocked singularities until every holonomy defect is below 1e-6 degrees.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : sequence of Singularity
        A configuration that meets the index budget.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities, for the final check.

    Returns
    -------
    Moved
        The valid configuration, verified by a fresh operator.

    Raises
    ------
    SingularityError
        If the index budget is missed, or there is no valid configuration near enough; it says
        which condition is in the way.
    """
    start = tuple(singularities)
    _refuse_impossible(surface, start)
    solver = IsotropicSolver(surface, corners)
    require_budget(surface, start, solver.corners)
    guide = solver.holonomy
    search = _Search(surface, guide, start)
    first: SingularityError | None = None
    for goal in _goals(guide.defects(start)):
        try:
            moved = yield from search.approach(start, goal)
            return (yield from search.verify(moved, corners, levels))
        except SingularityError as error:
            first = first or error
    raise first if first else AssertionError  # there is always a first goal


def _refuse_impossible(surface: TriSurface, singularities: Sequence[Singularity]) -> None:
    indices = sorted(s.index for s in singularities)
    if surface.genus == 1 and not surface.boundary_loops and indices == [-1, 1]:
        raise SingularityError(
            "a torus with one valence 3 and one valence 5 is never valid, wherever they are",
            "Izmestiev et al. 2013",
            "add one more pair of singularities",
        )


def _goals(defects: FloatArray) -> list[FloatArray]:
    """Return the multiples of a quarter turn to aim at, the nearest first."""
    sides = [np.sign(r) if r else 1.0 for r in defects]
    shifts = [
        QUARTER * np.array(chosen) * sides
        for chosen in product((0, 1), repeat=len(defects))
        if sum(chosen) <= 2
    ]
    return sorted(shifts, key=lambda shift: float(np.linalg.norm(defects - shift)))


class _Search:
    """Newton steps on one surface."""

    def __init__(
        self, surface: TriSurface, guide: Holonomy, singularities: Sequence[Singularity]
    ) -> None:
        self._surface = surface
        self._guide = guide
        self._unit = float(np.sqrt(surface.area))
        self._index = np.array([s.index for s in singularities], dtype=np.float64)
        self._free = np.array([not s.locked for s in singularities]) & (self._index != 0)

    def approach(
        self, singularities: tuple[Singularity, ...], goal: FloatArray, limit: int = 60
    ) -> Generator[Progress, None, tuple[Singularity, ...]]:
        """Follow the potentials of the surface to where the defects equal the goal."""
        remaining = self._guide.defects(singularities) - goal
        for _ in range(limit):
            worst = float(np.abs(remaining).max(initial=0.0))
            if worst < TOLERANCE / 10:
                return singularities
            moved = self._advance(singularities, remaining)
            # Steps are short, so the defects have changed by less than an eighth of a turn.
            change = wrap(self._guide.defects(moved) - goal - remaining, QUARTER)
            singularities, remaining = moved, remaining + change
            done = 1 - float(np.log(max(worst, TOLERANCE) / TOLERANCE)) / 25
            yield Moved("making valid", max(0.0, done), singularities, remaining)
        raise self._stuck(remaining)

    def verify(
        self,
        singularities: tuple[Singularity, ...],
        corners: Mapping[int, int] | None,
        levels: int,
        limit: int = 12,
    ) -> Generator[Progress, None, Moved]:
        """Correct what a fresh operator on the refined surface still finds."""
        for _ in range(limit):
            refinement = refine_at(self._surface, [s.point for s in singularities], levels)
            fine = refinement.surface
            inserted = [
                replace(s, point=fine.point_at_vertex(int(v)))
                for s, v in zip(singularities, refinement.vertices, strict=True)
            ]
            defects = IsotropicSolver(fine, corners).holonomy.defects(inserted)
            yield Moved("verifying", 0.9, singularities, defects)
            if np.abs(defects).max(initial=0.0) < TOLERANCE:
                return Moved("valid", 1.0, singularities, defects)
            singularities = self._advance(singularities, defects)
        raise self._stuck(defects)

    def _step(
        self, singularities: tuple[Singularity, ...], remaining: FloatArray, free: BoolArray
    ) -> FloatArray:
        """Return the least moves (k, 2), in the triangles' frames, that undo the defects."""
        gradients = self._guide.gradients([s.point for s in singularities])
        weight = QUARTER * self._index * free
        flat = (gradients * weight[:, None]).reshape(len(remaining), -1)
        scale = np.linalg.svd(flat, compute_uv=False)
        if len(scale) == 0 or scale[-1] * self._unit < 1e-4 or flat.shape[1] < len(remaining):
            raise self._stuck(remaining, "too few singularities may move")
        moves = -np.linalg.pinv(flat) @ remaining
        return np.asarray(moves.reshape(-1, 2))

    def _advance(
        self, singularities: tuple[Singularity, ...], remaining: FloatArray
    ) -> tuple[Singularity, ...]:
        """Take the step, cut so that the defects fall; who would come too near stays behind."""
        free = self._free.copy()
        now, before = self._guide.defects(singularities), float(np.linalg.norm(remaining))
        while True:
            step = self._step(singularities, remaining, free)
            longest = float(np.linalg.norm(step, axis=1).max())
            length = min(1.0, LONGEST_STEP * self._unit / max(longest, 1e-300))
            near = np.zeros(len(free), dtype=bool)
            for _ in range(6):
                moved = self._moved(singularities, length * step)
                near = self._too_near(moved)
                change = wrap(self._guide.defects(moved) - now, QUARTER)
                if not near.any() and float(np.linalg.norm(remaining + change)) < before:
                    return moved
                length /= 2
            if not (near & free).any():
                raise self._stuck(remaining)
            free &= ~near

    def _moved(
        self, singularities: tuple[Singularity, ...], step: FloatArray
    ) -> tuple[Singularity, ...]:
        return tuple(
            replace(s, point=straightest(self._surface, s.point, d)) if free else s
            for s, d, free in zip(singularities, step, self._free, strict=True)
        )

    def _too_near(self, singularities: tuple[Singularity, ...]) -> BoolArray:
        """Return which singularities are too near to each other or to the boundary."""
        x = self._surface.positions([s.point for s in singularities])
        gaps = np.linalg.norm(x[:, None] - x[None], axis=2)
        np.fill_diagonal(gaps, np.inf)
        rim = self._surface.vertices[self._surface.boundary_vertices]
        off_rim = np.linalg.norm(x[:, None] - rim[None], axis=2).min(axis=1, initial=np.inf)
        return np.minimum(gaps.min(axis=1), off_rim) < CLOSEST * self._unit

    def _stuck(
        self, defects: FloatArray, why: str = "the way there is blocked"
    ) -> SingularityError:
        worst = int(np.argmax(np.abs(defects)))
        label = self._guide.conditions[worst].label
        return SingularityError(
            f"the configuration cannot be made valid by moving its singularities: {why}",
            f"{label}, {np.degrees(abs(defects[worst])):.3g} degrees off",
            "unlock or add a pair of singularities, or solve the anisotropic field",
        )
