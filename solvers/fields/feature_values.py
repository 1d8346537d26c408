"""What feature curves are worth: which is released first where not all can be followed."""

from __future__ import annotations

import numpy as np

from solvers.features.dihedral import dihedral_angles
from solvers.features.sectors import Sectors
from solvers.fields.connection import Discretization
from solvers.fields.sector_quads import Chains
from solvers.surface.triangulation import FloatArray

FREE_END = 0.5
"""What is left of the value of a curve for each of its ends at no other curve. Chosen."""


def edge_values(discretization: Discretization) -> FloatArray:
    """Return the value of each feature halfedge (k,): its length times one plus the bend, radians.

    Parameters
    ----------
    discretization : Discretization
        With features.
    """
    d = discretization
    bent = dihedral_angles(d.surface)[d.features.edges]
    return np.asarray(
        d.triangulation.lengths.reshape(-1)[d.feature_halfedges] * (1 + bent[d.feature_edge])
    )


def curve_values(chains: Chains, sectors: Sectors, values: FloatArray) -> FloatArray:
    """Return the value of each chain (count,): the sum of its edges', half for each free end.

    Parameters
    ----------
    chains : Chains
        Of feature edges.
    sectors : Sectors
        Between them.
    values : (k,) float array
        Of each of the edges.
    """
    free = sectors.start[(sectors.start == sectors.end) & (sectors.start >= 0)]
    ends = np.bincount(chains.number[free], minlength=chains.count)
    return np.asarray(np.bincount(chains.number, values, chains.count) * FREE_END**ends)
