"""By how many quarter turns a field turns from one boundary of an annulus to the other."""

from __future__ import annotations

import numpy as np

from solvers.fields.aligned import AlignedField
from solvers.fields.crossfield import CrossField
from solvers.surface.homology import DualTree
from solvers.surface.triangulation import QUARTER, wrap


def holonomy_class(aligned: AlignedField) -> tuple[int, ...]:
    """Return the turns of an aligned field as `solvers.singularities.existence` takes them.

    Parameters
    ----------
    aligned : AlignedField
        The field.

    Returns
    -------
    tuple of int
        Over each condition; those of an annulus with corners against a path between its
        boundaries, all others besides those nearest to the isotropic field.

    Examples
    --------
    Four corners of a boundary turn it one way, then the other; the crosses opposite make up for it:

    >>> from solvers.fields import aligned_field, holonomy_class, prepare
    >>> from solvers.primitives import annulus
    >>> surface = annulus(n=48)
    >>> corners = dict(zip(surface.boundary_loops[0][[5, 15, 25, 35]].tolist(), [1, 1, -1, -1]))
    >>> [holonomy_class(aligned_field(prepare(surface, corners=corners), [n])) for n in (0, 2)]
    [(-1,), (1,)]
    """
    field = aligned.isotropic
    surface = field.surface
    if surface.genus or len(surface.boundary_loops) != 2 or not any(field.corners.values()):
        return aligned.turns
    nearest = round(turns_across(field) - float(field.defects[0]) / QUARTER)
    return (nearest + aligned.turns[0],)


def turns_across(field: CrossField) -> float:
    """Return the turns of the crosses against a path between the first two boundaries.

    The path leaves the edge behind the first vertex of the first boundary, and arrives at that
    behind the first vertex of the second, both at right angles. The crosses of neighbouring
    triangles are matched by the nearest of their branches.

    Parameters
    ----------
    field : CrossField
        On a surface with two boundaries at least.

    Returns
    -------
    float
        Quarter turns, counterclockwise; whole if the field is aligned with both boundaries.
    """
    t = field.surface.triangulation
    free = t.boundary_halfedges
    start, end = (
        int(free[t.tail[free] == loop[0]][0]) for loop in field.surface.boundary_loops[:2]
    )
    none = np.zeros((1, len(t.twin)), dtype=bool)
    crossed = DualTree(t, start // 3, none).path(end // 3)
    entered = np.concatenate([[start], t.twin[crossed]])
    left = np.concatenate([crossed, [end]])
    places = t.corner_positions.reshape(-1, 2) @ np.array([1, 1j])
    middle = 0.5 * (places + places.reshape(-1, 3)[:, [1, 2, 0]].reshape(-1))
    across = np.angle(middle[left] - middle[entered])
    heading = np.concatenate([[t.directions[start] + QUARTER], across])
    following = np.concatenate([across, [t.directions[end] - QUARTER]])
    heading[1:-1] += t.transport[crossed]
    bends = wrap(following - heading, 2 * np.pi)
    theta = field.theta
    steps = wrap(theta[entered[1:] // 3] - theta[crossed // 3] - t.transport[crossed], QUARTER)
    return float(steps.sum() - bends.sum()) / QUARTER
