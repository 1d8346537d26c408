"""Feature edges: sharp or marked edges inside a surface that crosses are to follow."""

from __future__ import annotations

from solvers.features.dihedral import dihedral_angles, sharp_edges
from solvers.features.edges import FeatureCurve, Features, no_features
from solvers.features.regions import face_regions, in_one_region
from solvers.features.sectors import Sectors, sectors_between
from solvers.features.strays import without_spurs, without_strays

__all__ = [
    "FeatureCurve",
    "Features",
    "Sectors",
    "dihedral_angles",
    "face_regions",
    "in_one_region",
    "no_features",
    "sectors_between",
    "sharp_edges",
    "without_spurs",
    "without_strays",
]
