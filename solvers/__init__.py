"""Integrable cross-fields on triangle surfaces with imposed singularities.

Numerics only: NumPy and SciPy, no window and no file formats. Start with a `TriSurface`, place
`Singularity` values on it, and give them to an `IsotropicSolver`. What most programs need is here;
the rest is exported by the rooms, from the ground up:

- `solvers.surface`: the triangle surface, its loops, paths and refinement
- `solvers.algebra`: finite element matrices, and the one place that solves with them
- `solvers.primitives`, `solvers.repair`: surfaces made by functions, or of a triangle soup
- `solvers.singularities`: the index budget, corners, pairs, symmetry
- `solvers.features`: edges inside a surface that crosses are to follow
- `solvers.fields`: isotropic, aligned, anisotropic and natural cross-fields, and verdicts
- `solvers.validity`: where singularities may go, and the way there
- `solvers.maps`, `solvers.layouts`, `solvers.quads`: from a field to quads

Long computations are generators that report their progress and return a result: `run` drives them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from solvers.lazy import when_wanted

if TYPE_CHECKING:
    from solvers.errors import CrossviewError, SingularityError, SolveError, SurfaceError
    from solvers.fields import CrossField, IsotropicSolver
    from solvers.progress import Progress, run
    from solvers.remedies import MakeValid, Remedy, RepairSurface, TakeLargest, UseMethod
    from solvers.singularities import Singularity
    from solvers.surface import SurfacePoint, TriSurface

__all__ = [
    "CrossField",
    "CrossviewError",
    "IsotropicSolver",
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

__getattr__ = when_wanted(
    __name__,
    {
        "solvers.errors": (
            "CrossviewError",
            "SingularityError",
            "SolveError",
            "SurfaceError",
        ),
        "solvers.fields": (
            "CrossField",
            "IsotropicSolver",
        ),
        "solvers.progress": (
            "Progress",
            "run",
        ),
        "solvers.remedies": (
            "MakeValid",
            "Remedy",
            "RepairSurface",
            "TakeLargest",
            "UseMethod",
        ),
        "solvers.singularities": ("Singularity",),
        "solvers.surface": (
            "SurfacePoint",
            "TriSurface",
        ),
    },
)


def __dir__() -> list[str]:
    """Return the names that there are, also those not wanted yet."""
    return sorted({*globals(), *__all__})
