"""Cross-fields: isotropic, aligned, anisotropic, natural, and what they are worth."""

from __future__ import annotations

from solvers.fields.connection import Condition
from solvers.fields.crossfield import Convergence, CrossField
from solvers.fields.holonomy import Holonomy
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.natural import CrossesStep, natural_singularities
from solvers.fields.prepared import PreparedSurface, prepare

__all__ = [
    "Condition",
    "Convergence",
    "CrossField",
    "CrossesStep",
    "Holonomy",
    "IsotropicSolver",
    "PreparedSurface",
    "natural_singularities",
    "prepare",
]
