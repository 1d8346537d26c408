"""Integrable cross-fields on triangle surfaces with imposed singularities.

Numerics only: NumPy and SciPy, no window and no file formats. Start with `TriSurface`, place
`Singularity` values on it, and give them to `IsotropicSolver`. Long computations are generators
that report their progress; `run` drives them and returns their result.
"""

from __future__ import annotations

from solvers.errors import CrossviewError, SingularityError, SolveError, SurfaceError
from solvers.progress import Progress, run
from solvers.remedies import MakeValid, Remedy, RepairSurface, TakeLargest, UseMethod
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint, TriSurface

__all__ = [
    "CrossviewError",
    "MakeValid",
    "Progress",
    "Remedy",
    "RepairSurface",
    "Singularity",
    "SingularityError",
    "SolveError",
    "SurfaceError",
    "SurfacePoint",
    "TakeLargest",
    "TriSurface",
    "UseMethod",
    "run",
]
