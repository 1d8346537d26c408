"""Newton steps on the holonomy defects, with singularities that keep their distance."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from solvers.fields.holonomy import Holonomy
from solvers.fields.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.singularities.budget import Singularity
from solvers.singularities.spacing import Spacing
from solvers.surface.geodesics import straightest
from solvers.surface.refinement import Refinement, refine_at
from solvers.surface.triangulation import QUARTER, FloatArray, wrap
from solvers.surface.trisurface import TriSurface

TOLERANCE = np.radians(1e-6)
"""Defect that counts as none, radians. Chosen, above rounding and below what a mesh can tell."""

LONGEST_STEP = 0.1
"""Longest move of a singularity in one step, in square roots of the surface's area. Chosen."""

HALVINGS, CONTACTS = 7, 4
"""How often a step is halved, and how often bent around what it would come too near to. Chosen."""

NEAR = np.radians(1e-3)
"""Defect, radians, below which the refined surface's own operator takes over. Chosen."""

NUDGE = 0.1
"""How far singularities are nudged, in shortest edges of their triangles. Chosen."""

LEAST_HOLD = 1e-6
"""Change of a defect, radians, by a move of the square root of the area: less is no hold on it.

Chosen.
"""


class Obstacle(Enum):
    """What ends the way to an aim; the value says it in plain words."""

    TOO_FEW = "too few singularities may move, or only some far away"
    CROWDED = "singularities would come too near to each other or to the boundary"
    STALLED = "no small move brings them nearer"
    UNSETTLED = "the surface is too coarse for its defects to be told"


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


class Blocked(Exception):
    """The way to the aim ends.

    Parameters
    ----------
    why : Obstacle
    remaining : (c,) float array
        What is left of the defects, radians.
    """

    def __init__(self, why: Obstacle, remaining: FloatArray) -> None:
        super().__init__(why.value)
        self.why = why
        self.remaining = remaining


class Search:
    """Newton steps on one surface from one configuration.

    Moving singularity j by d_j changes defect i by (pi/2) k_j grad Z_i(x_j) . d_j; of the moves
    that take all defects to their aims the least is taken. Where some would come too near to each
    other or to the boundary, their least distance becomes one more equation of the step.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    guide : Holonomy
        Its holonomy potentials.
    singularities : sequence of Singularity
        The configuration; those locked, and those of index 0, stay.
    """

    def __init__(
        self, surface: TriSurface, guide: Holonomy, singularities: Sequence[Singularity]
    ) -> None:
        self._surface = surface
        self._guide = guide
        self._unit = float(np.sqrt(surface.area))
        self._index = np.array([s.index for s in singularities], dtype=np.float64)
        self._free = np.array([not s.locked for s in singularities], dtype=bool)
        self._free &= self._index != 0
        self._spacing = Spacing(surface, singularities, self._free)

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
        step -= _least(matrix, matrix @ step.reshape(-1))
        moved = self._moved(singularities, step)
        return singularities if len(self._spacing.too_near(moved)) else moved

    def _advance(
        self,
        singularities: tuple[Singularity, ...],
        remaining: FloatArray,
        gradients: FloatArray,
        accepted: Callable[[tuple[Singularity, ...]], bool],
    ) -> tuple[Singularity, ...]:
        """Take the least step, cut until it is accepted, bent so that distances are kept."""
        matrix = self._matrix(gradients, remaining)
        longest = np.linalg.norm(_least(matrix, -remaining), axis=1).max()
        reach = LONGEST_STEP * self._unit
        share, why = min(1.0, reach / max(float(longest), 1e-300)), Obstacle.STALLED
        for _ in range(HALVINGS):
            rows, gaps = self._spacing.none
            for _ in range(CONTACTS):
                both = np.concatenate([matrix, rows])
                step = _least(both, np.concatenate([-share * remaining, gaps]))
                if np.linalg.norm(step, axis=1).max() > 2 * reach:
                    break
                moved = self._moved(singularities, step)
                near = self._spacing.too_near(moved)
                if not len(near) and accepted(moved):
                    return moved
                if not len(near):
                    break
                why = Obstacle.CROWDED
                more = self._spacing.equations(singularities, near)
                rows, gaps = np.concatenate([rows, more[0]]), np.concatenate([gaps, more[1]])
            share /= 2
        raise Blocked(why, remaining)

    def _matrix(self, gradients: FloatArray, remaining: FloatArray) -> FloatArray:
        """Return (c, 2 k): how the defects change with moves in the triangles' frames."""
        weight = QUARTER * self._index * self._free
        matrix = np.asarray((gradients * weight[:, None]).reshape(len(remaining), -1))
        scale = np.linalg.svd(matrix, compute_uv=False)
        if matrix.shape[1] < len(remaining) or scale[-1] * self._unit < LEAST_HOLD:
            raise Blocked(Obstacle.TOO_FEW, remaining)
        return matrix

    def _moved(
        self, singularities: tuple[Singularity, ...], step: FloatArray
    ) -> tuple[Singularity, ...]:
        return tuple(
            replace(s, point=straightest(self._surface, s.point, d)) if free else s
            for s, d, free in zip(singularities, step, self._free, strict=True)
        )


def _least(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return the least moves (k, 2) that solve the equations as well as can be."""
    moves = np.linalg.lstsq(matrix, right, rcond=1e-9)[0]
    return np.asarray(moves.reshape(-1, 2))
