"""Newton steps on the holonomy defects, with singularities that keep their distance."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from solvers.features.edges import Features
from solvers.fields.holonomy import Holonomy
from solvers.fields.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.singularities.budget import Singularity
from solvers.surface.refinement import Refinement, refine_at
from solvers.surface.triangulation import QUARTER, FloatArray, wrap
from solvers.surface.trisurface import TriSurface
from solvers.validity.constrained_moves import (
    LEAST_HOLD,
    LONGEST_STEP,
    Blocked,
    ConstrainedMoves,
    Obstacle,
    least_moves,
)

TOLERANCE = np.radians(1e-6)
"""Defect that counts as none, radians. Chosen, above rounding and below what a mesh can tell."""

NEAR = np.radians(1e-3)
"""Defect, radians, below which the refined surface's own operator takes over. Chosen."""

NUDGE = 0.1
"""How far singularities are nudged, in shortest edges of their triangles. Chosen."""


@dataclass(frozen=True)
class Moved(Progress):
    """A step on the way to a valid configuration.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    singularities : tuple of Singularity
        Where they are.
    defects : (c,) float array
        Their holonomy defects, radians.
    turns : tuple of int
        The quarter turns that each condition is taken to: 0 the nearest, else another layout.
    aim : str
        The same in words at the end of the way; empty: the nearest.

    Examples
    --------
    Each step can be shown; the last is the result:

    >>> from solvers import run
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import make_valid
    >>> surface = annulus(n=24)
    >>> places = [surface.closest_point(place) for place in ([0.8, 0, 0], [0.3, 0.5, 0])]
    >>> pair = [Singularity(place, valence) for place, valence in zip(places, (3, 5))]
    >>> worst = []
    >>> end = run(make_valid(surface, pair), lambda step: worst.append(abs(step.defects[0])))
    >>> end.stage, end.turns, bool(worst[0] > 1e-3 > 1e-6 > worst[-1])
    ('valid', (0,), True)
    """

    singularities: tuple[Singularity, ...]
    defects: FloatArray
    turns: tuple[int, ...]
    aim: str = ""


class Search:
    """Newton steps on one surface from one configuration.

    Of the moves that take all defects to their aims the least is taken. Where some would come too
    near to each other or to the boundary, their least distance becomes one more equation.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    guide : Holonomy
        Its holonomy potentials.
    singularities : sequence of Singularity
        The configuration; those locked, those of index 0 and those on features stay.
    features : Features
        Of the surface; they are not crossed.
    """

    def __init__(
        self,
        surface: TriSurface,
        guide: Holonomy,
        singularities: Sequence[Singularity],
        features: Features,
    ) -> None:
        self._surface = surface
        self._guide = guide
        self._moves = ConstrainedMoves(surface, guide, singularities, features)

    def approach(
        self, singularities: tuple[Singularity, ...], turns: tuple[int, ...], limit: int = 60
    ) -> Generator[Progress, None, tuple[Singularity, ...]]:
        """Follow the potentials of the surface to where the defects are multiples of 90 degrees.

        Parameters
        ----------
        singularities : tuple of Singularity
            Where to start.
        turns : tuple of int
            The quarter turn that each defect is taken to.
        limit : int, optional
            Of the number of steps.

        Raises
        ------
        Blocked
            The way ends before.
        """
        goal = QUARTER * np.array(turns, dtype=np.float64)
        remaining = self._guide.defects(singularities) - goal
        for _ in range(limit):
            worst = float(np.abs(remaining).max(initial=0.0))
            if worst < NEAR:
                return singularities
            gradients = self._guide.gradients([s.point for s in singularities])
            moved = self._advance(
                singularities, remaining, gradients, self._falls(singularities, remaining)
            )
            # Steps are short, so the defects have changed by less than an eighth of a turn.
            change = wrap(self._guide.defects(moved) - goal - remaining, QUARTER)
            singularities, remaining = moved, remaining + change
            done = 1 - float(np.log(max(worst, TOLERANCE) / TOLERANCE)) / 25
            yield Moved("making valid", max(0.0, done), singularities, remaining, turns)
        raise Blocked(Obstacle.STALLED, remaining)

    def verify(
        self,
        singularities: tuple[Singularity, ...],
        turns: tuple[int, ...],
        corners: Mapping[int, int] | None,
        levels: int,
        limit: int = 60,
    ) -> Generator[Progress, None, Moved]:
        """Correct what a fresh operator on the refined surface still finds.

        How the surface is refined depends on the small triangles that the singularities are in,
        and the operator's defects jump a little where that changes. Where corrections go to and
        fro over such a jump, all singularities are nudged along their level lines.

        Parameters
        ----------
        singularities, turns
            What `approach` has reached.
        corners, levels
            As of `make_valid`.
        limit : int, optional
            Of the number of corrections.

        Raises
        ------
        Blocked
            The fresh operator's defects do not vanish.
        """
        chance, before = np.random.default_rng(0), np.inf
        for _ in range(limit):
            refinement = refine_at(self._surface, [s.point for s in singularities], levels)
            fine = refinement.surface
            inserted = [
                replace(s, point=fine.point_at_vertex(int(v)))
                for s, v in zip(singularities, refinement.vertices, strict=True)
            ]
            fresh = IsotropicSolver(fine, corners).holonomy
            defects = fresh.defects(inserted)
            worst = float(np.abs(defects).max(initial=0.0))
            yield Moved("verifying", 0.9, singularities, defects, turns)
            if worst < TOLERANCE:
                return Moved("valid", 1.0, singularities, defects, turns)
            gradients = self._inserted_gradients(singularities, refinement, fresh)
            singularities = self._advance(singularities, defects, gradients, lambda _: True)
            if worst > 0.9 * before:
                singularities = self._nudged(singularities, defects, gradients, chance)
            before = worst
        raise Blocked(Obstacle.UNSETTLED, defects)

    def _falls(
        self, singularities: tuple[Singularity, ...], remaining: FloatArray
    ) -> Callable[[tuple[Singularity, ...]], bool]:
        """Return whether a move lets the defects fall."""
        now, before = self._guide.defects(singularities), float(np.linalg.norm(remaining))

        def falls(moved: tuple[Singularity, ...]) -> bool:
            change = wrap(self._guide.defects(moved) - now, QUARTER)
            return float(np.linalg.norm(remaining + change)) < before

        return falls

    def _inserted_gradients(
        self, singularities: tuple[Singularity, ...], refinement: Refinement, fresh: Holonomy
    ) -> FloatArray:
        """Return the gradients (c, k, 2) of a refined surface's potentials in the own triangles.

        At an inserted vertex the mean over the triangles around it.
        """
        fine, vertices = refinement.surface, refinement.vertices
        owner_of = np.full(fine.n_vertices, -1)
        owner_of[vertices] = np.arange(len(vertices))
        faces, corner = np.nonzero(owner_of[fine.faces] >= 0)
        owner = owner_of[fine.faces[faces, corner]]
        points = [fine.point(face, (1 / 3, 1 / 3, 1 / 3)) for face in faces.tolist()]
        frames = np.stack(fine.face_frames, axis=1)[faces]
        in_space = np.einsum("cpd,pdx->cpx", fresh.gradients(points), frames)
        in_space *= fine.face_areas[faces][:, None]
        sums = np.zeros((len(vertices), len(in_space), 3))
        np.add.at(sums, owner, in_space.swapaxes(0, 1))
        sums /= np.bincount(owner, fine.face_areas[faces])[:, None, None]
        own = np.stack(self._surface.face_frames, axis=1)[[s.point.face for s in singularities]]
        return np.asarray(np.einsum("kcx,kdx->ckd", sums, own))

    def _nudged(
        self,
        singularities: tuple[Singularity, ...],
        defects: FloatArray,
        gradients: FloatArray,
        chance: np.random.Generator,
    ) -> tuple[Singularity, ...]:
        """Move singularities a little so that no defect changes, as far as gradients tell."""
        matrix = self._matrix(gradients, defects)
        edge = self._surface.triangulation.lengths[[s.point.face for s in singularities]].min(1)
        step = NUDGE * edge[:, None] * chance.normal(size=(len(singularities), 2))
        step -= least_moves(matrix, matrix @ step.reshape(-1))
        moved = self._moves.moved(singularities, step).singularities
        return singularities if len(self._moves.spacing.too_near(moved)) else moved

    def _advance(
        self,
        singularities: tuple[Singularity, ...],
        remaining: FloatArray,
        gradients: FloatArray,
        accepted: Callable[[tuple[Singularity, ...]], bool],
    ) -> tuple[Singularity, ...]:
        """Take the least step, cut until it is accepted, bent so that distances are kept."""
        matrix = self._matrix(gradients, remaining)
        longest = np.linalg.norm(least_moves(matrix, -remaining), axis=1).max()
        share = min(1.0, LONGEST_STEP * self._moves.unit / max(float(longest), 1e-300))

        def propose(rows: FloatArray, gaps: FloatArray, part: float) -> FloatArray:
            both = np.concatenate([matrix, rows])
            return least_moves(both, np.concatenate([-part * remaining, gaps]))

        found = self._moves.advance(
            singularities, propose, lambda step: accepted(step.singularities), share
        )
        if isinstance(found, Obstacle):
            raise Blocked(found, remaining)
        return found.singularities

    def _matrix(self, gradients: FloatArray, remaining: FloatArray) -> FloatArray:
        """Return (c, 2 k) how the defects change with moves, if those have a hold on them."""
        matrix = self._moves.by_moves(gradients)
        scale = np.linalg.svd(matrix, compute_uv=False)
        if matrix.shape[1] < len(remaining) or scale[-1] * self._moves.unit < LEAST_HOLD:
            raise Blocked(Obstacle.TOO_FEW, remaining)
        return matrix
