"""Cross-fields: isotropic, aligned, anisotropic, natural, and what they are worth."""

from __future__ import annotations

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.connection import Condition, Discretization
from solvers.fields.crossfield import Convergence, CrossField, WorkingField
from solvers.fields.holonomy import Holonomy
from solvers.fields.integrable import FieldStep, alternating_field, anisotropic_field
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.natural import (
    CURVATURE_WEIGHT,
    NATURAL_ALIGNMENTS,
    NATURAL_METHODS,
    CrossesStep,
    natural_singularities,
)
from solvers.fields.pieces import field_existence
from solvers.fields.placement import MOST_VALENCE
from solvers.fields.prepared import Operators, PreparedSurface, prepare
from solvers.fields.sizes import size_map
from solvers.fields.turning import holonomy_class
from solvers.fields.verdict import TOLERANCE_DEGREES, Limits, Verdict, judge

__all__ = [
    "CURVATURE_WEIGHT",
    "MOST_VALENCE",
    "NATURAL_ALIGNMENTS",
    "NATURAL_METHODS",
    "TOLERANCE_DEGREES",
    "AlignedField",
    "Condition",
    "Convergence",
    "CrossField",
    "CrossesStep",
    "Discretization",
    "FieldStep",
    "Holonomy",
    "IntegratedField",
    "IsotropicSolver",
    "Limits",
    "Operators",
    "PreparedSurface",
    "Verdict",
    "WorkingField",
    "aligned_field",
    "alternating_field",
    "anisotropic_field",
    "field_existence",
    "holonomy_class",
    "judge",
    "natural_singularities",
    "prepare",
    "size_map",
]
