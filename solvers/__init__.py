"""Integrable cross-fields on triangle surfaces with imposed singularities.

Numerics only: NumPy and SciPy, no window and no file formats. Start with `TriSurface`, place
`Singularity` values on it, and give them to `IsotropicSolver`. Long computations are generators
that report their progress; `run` drives them and returns their result.
"""

from __future__ import annotations

from solvers.progress import Progress, run
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint, TriSurface

__all__ = [
    "Progress",
    "Singularity",
    "SurfacePoint",
    "TriSurface",
    "run",
]
