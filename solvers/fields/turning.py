"""By how many quarter turns an aligned field turns around handles and between boundaries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solvers.fields.aligned import AlignedField
from solvers.fields.connection import Condition, Discretization
from solvers.singularities.topology import FULL
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, wrap


def holonomy_class(aligned: AlignedField) -> tuple[int, ...]:
    """Return the turns of an aligned field as `solvers.singularities.existence` takes them.

    Parameters
    ----------
    aligned : AlignedField
        The field.

    Returns
    -------
    tuple of int
        Quarter turns, counterclockwise, of the crosses against the path of each condition: around
        a handle, or from behind the first vertex of the first boundary to behind that of a further
        one, leaving and arriving at right angles. On closed surfaces of higher genus those around
        pairs of loops as of `decide` where all are whole.

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
    i = aligned.integrability
    d, offset = i.discretization, i.offsets.reshape(-1)
    turns = []
    for condition in d.conditions:
        entered, left = _path(d, condition)
        turned = offset[left].sum() - offset[entered].sum()
        turns.append(round((turned - _bent(d, condition, entered, left)) / QUARTER))
    if d.boundary_loops or len(turns) <= 2 or any(n % FULL for n in turns):
        return tuple(turns)
    forms = [d.dual_path(condition).reshape(-1, 3) for condition in d.conditions]
    crossings = [[int(a[:, 0] @ b[:, 1] - a[:, 1] @ b[:, 0]) // 2 for b in forms] for a in forms]
    return paired(turns, crossings)


def _path(d: Discretization, condition: Condition) -> tuple[IntArray, IntArray]:
    """Return where the path of a condition enters its triangles and where it leaves them."""
    twin, h = d.triangulation.twin, condition.halfedge
    out = d.tree.path(h // 3)
    if condition.kind == "boundary":
        return np.concatenate([[d.reference], twin[out]]), np.append(out, h)
    back = d.tree.path(int(twin[h]) // 3)
    shared = 0
    while shared < min(len(out), len(back)) and out[shared] == back[shared]:
        shared += 1
    left = np.concatenate([out[shared:], [h], twin[back[shared:][::-1]]])
    return np.roll(twin[left], 1), left


def paired(turns: Sequence[int], crossings: Sequence[Sequence[int]]) -> tuple[int, ...]:
    """Return whole turns, modulo two, around loops that cross once two by two, and no others.

    Parameters
    ----------
    turns : sequence of int
        Around loops that are no combinations of others but to nothing, in quarters.
    crossings : sequence of sequence of int
        How often each crosses each, signed.

    Returns
    -------
    tuple of int
        In quarters, 0 or 4.

    Notes
    -----
    Modulo two the whole turns plus one are a quadratic form on the loops (Johnson 1980).

    Examples
    --------
    One loop crosses two others, of which one crosses a fourth:

    >>> from solvers.fields.turning import paired
    >>> paired([0, 0, 0, 4], [[0, 1, 1, 0], [-1, 0, 0, 0], [-1, 0, 0, 1], [0, 0, -1, 0]])
    (4, 0, 0, 0)
    """
    odd = (np.array(turns, dtype=np.int64) // FULL + 1) % 2
    crossing = np.array(crossings, dtype=np.int64).reshape(len(odd), len(odd)) % 2
    left, found = list(range(len(odd))), list[int]()
    while left:
        one = left.pop()
        other = next((i for i in left if crossing[one, i]), None)
        if other is None:
            continue
        left.remove(other)
        for i in left:
            for added in [a for a, b in ((one, other), (other, one)) if crossing[i, b]]:
                odd[i] = (odd[i] + odd[added] + crossing[i, added]) % 2
                crossing[i] = (crossing[i] + crossing[added]) % 2
                crossing[:, i] = (crossing[:, i] + crossing[:, added]) % 2
        found += [one, other]
    return tuple(int(n) for n in FULL * ((odd[found] + 1) % 2))


def _bent(d: Discretization, condition: Condition, entered: IntArray, left: IntArray) -> float:
    """Return by how much a path from midpoint to midpoint bends, radians, counterclockwise."""
    t = d.triangulation
    places = t.corner_positions.reshape(-1, 2) @ np.array([1, 1j])
    middle = 0.5 * (places + places.reshape(-1, 3)[:, [1, 2, 0]].reshape(-1))
    heading: FloatArray = np.angle(middle[left] - middle[entered])
    if condition.kind == "loop":
        bends = np.roll(heading, -1) - heading - t.transport[left]
    else:
        inward = t.directions[entered[0]] + QUARTER
        outward = t.directions[left[-1]] - QUARTER
        following = np.append(heading, outward)
        carried = np.append(inward, heading)
        carried[1:-1] += t.transport[left[:-1]]
        bends = following - carried
    return float(wrap(bends, 2 * np.pi).sum())
