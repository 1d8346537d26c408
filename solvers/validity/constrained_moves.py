"""Moves of all singularities at once: what they do to the defects, and how near they may come.

Features are walls: nobody crosses them, and who is on one stays there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from solvers.features.edges import Features
from solvers.features.regions import in_one_region
from solvers.fields.holonomy import Holonomy
from solvers.singularities.budget import Singularity
from solvers.singularities.spacing import Spacing
from solvers.surface.geodesics import straightest
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray
from solvers.surface.trisurface import TriSurface

LONGEST_STEP = 0.1
"""Longest move of a singularity in one step, in square roots of the surface's area. Chosen."""

HALVINGS, CONTACTS = 7, 4
"""How often a step is halved, and how often bent around what it would come too near to. Chosen."""

LEAST_HOLD = 1e-6
"""Change of a defect, radians, by a move of the square root of the area: less is no hold on it.

Chosen.
"""

Propose = Callable[[FloatArray, FloatArray, float], FloatArray]
"""From equations (rows, right sides) that a step must meet, and a share of it, to moves (k, 2)."""


class Obstacle(Enum):
    """What ends the way to an aim; the value says it in plain words."""

    TOO_FEW = "too few singularities may move, or only some far away"
    CROWDED = "singularities would come too near to each other, to the boundary or to a feature"
    STALLED = "no small move brings them nearer"
    UNSETTLED = "the surface is too coarse for its defects to be told"


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


@dataclass(frozen=True, eq=False)
class Step:
    """A move that was made.

    Parameters
    ----------
    singularities : tuple of Singularity
        Where they are now.
    moves : (k, 2) float array
        In the frames of the triangles they were in.
    turns : (k,) float array
        By how much vectors carried along have turned against the triangles' frames, radians.
    """

    singularities: tuple[Singularity, ...]
    moves: FloatArray
    turns: FloatArray


class ConstrainedMoves:
    """How the singularities of one configuration may move.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    guide : Holonomy
        Its holonomy potentials.
    singularities : sequence of Singularity
        Where they start; those locked, those of index 0 and those on features stay.
    features : Features
        Of the surface.

    Attributes
    ----------
    unit : float
        Square root of the surface's area.
    free : (k,) bool array
        Which move.
    weight : (k,) float array
        Curvature of each, radians: pi / 2 times the index; 0 if it stays.
    """

    def __init__(
        self,
        surface: TriSurface,
        guide: Holonomy,
        singularities: Sequence[Singularity],
        features: Features,
    ) -> None:
        self.surface, self.guide, self.features = surface, guide, features
        self._walls = np.zeros(len(surface.edges), dtype=bool)
        self._walls[features.edges] = True
        self.unit = float(np.sqrt(surface.area))
        index = np.array([s.index for s in singularities], dtype=np.float64)
        self.free: BoolArray = np.array([not s.locked for s in singularities], dtype=bool)
        self.free &= index != 0
        self.free &= in_one_region(features, [s.point for s in singularities]).diagonal()
        self.weight = QUARTER * index * self.free
        self.spacing = Spacing(surface, singularities, self.free, self._walls)

    def by_moves(self, gradients: FloatArray) -> FloatArray:
        """Return how the defects change with moves in the triangles' frames.

        Moving singularity j by d_j changes defect i by (pi/2) k_j grad Z_i(x_j) . d_j.

        Parameters
        ----------
        gradients : (c, k, 2) float array
            Of the holonomy potentials at the singularities.

        Returns
        -------
        (c, 2 k) float array
        """
        return np.asarray((gradients * self.weight[:, None]).reshape(-1, 2 * len(self.weight)))

    def moved(self, singularities: tuple[Singularity, ...], moves: FloatArray) -> Step:
        """Return where straight walks take them; those that stay do."""
        walks = [
            straightest(self.surface, s.point, d, self._walls) if free else None
            for s, d, free in zip(singularities, moves, self.free, strict=True)
        ]
        places = tuple(
            s if walk is None else replace(s, point=walk.end)
            for s, walk in zip(singularities, walks, strict=True)
        )
        turns = np.array([0.0 if walk is None else walk.turn for walk in walks])
        return Step(places, moves, turns)

    def advance(
        self,
        singularities: tuple[Singularity, ...],
        propose: Propose,
        accepted: Callable[[Step], bool],
        share: float = 1.0,
    ) -> Step | Obstacle:
        """Take a step, cut until it is accepted, bent so that distances are kept.

        Parameters
        ----------
        singularities : tuple of Singularity
            Where they are.
        propose : callable
            What gives a share of the step under further equations.
        accepted : callable
            Whether a step is good enough.
        share : float, optional
            The largest.

        Returns
        -------
        Step or Obstacle
            What is in the way if none is.
        """
        why = Obstacle.STALLED
        for _ in range(HALVINGS):
            rows, gaps = self.spacing.none
            for _ in range(CONTACTS):
                moves = propose(rows, gaps, share)
                if np.linalg.norm(moves, axis=1).max(initial=0) > 2 * LONGEST_STEP * self.unit:
                    break
                step = self.moved(singularities, moves)
                near = self.spacing.too_near(step.singularities)
                if not len(near) and accepted(step):
                    return step
                if not len(near):
                    break
                why = Obstacle.CROWDED
                more = self.spacing.equations(singularities, near)
                rows, gaps = np.concatenate([rows, more[0]]), np.concatenate([gaps, more[1]])
            share /= 2
        return why


def least_moves(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return the least moves (k, 2) that solve equations (c, 2 k) as well as can be."""
    moves = np.linalg.lstsq(matrix, right, rcond=1e-9)[0]
    return np.asarray(moves.reshape(-1, 2))


def rotations(turns: FloatArray) -> FloatArray:
    """Return the rotations (k, 2, 2) by angles (k,) in radians."""
    c, s = np.cos(turns), np.sin(turns)
    return np.stack([np.stack([c, -s], axis=1), np.stack([s, c], axis=1)], axis=1)
