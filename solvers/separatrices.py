"""Separatrices: the curves along the cross that leave its singularities and corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.surface import TriSurface
from solvers.triangulation import FloatArray, IntArray

SINGULARITY, BOUNDARY, T_JUNCTION, OPEN = range(4)
"""Where a separatrix ends; `OPEN`: nowhere, it was cut for its length."""


@dataclass(frozen=True, eq=False)
class Separatrices:
    """Curves on a surface.

    Parameters
    ----------
    surface : TriSurface
        Where they lie.
    points : (p, 3) float array
        Of all curves, one after the other.
    offsets : (n + 1,) int array
        Curve i is ``points[offsets[i]:offsets[i + 1]]``.
    valences : (n,) int array
        Valence of the singularity each leaves; 0 for a corner or another point of the surface.
    ends : (n,) int array
        `SINGULARITY` (or a corner), `BOUNDARY`, `T_JUNCTION` (a limit cycle, cut at its first
        orthogonal crossing) or `OPEN`.
    """

    surface: TriSurface
    points: FloatArray
    offsets: IntArray
    valences: IntArray
    ends: IntArray

    @property
    def t_junctions(self) -> FloatArray:
        """(k, 3) where limit cycles are cut."""
        return self.points[self.offsets[1:][self.ends == T_JUNCTION] - 1]

    @property
    def limit_cycles(self) -> int:
        """Number of curves that end neither at a singularity nor at the boundary."""
        return int(np.count_nonzero(self.ends >= T_JUNCTION))
