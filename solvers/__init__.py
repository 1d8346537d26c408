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

from solvers.lazy import names_of_stub

__getattr__, __dir__, __all__ = names_of_stub(__name__)
