"""What topology says of an aligned field: of the whole, and of each piece that features cut off."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from solvers.fields.aligned import AlignedField
from solvers.fields.sector_quads import REGULAR, STRAIGHT
from solvers.fields.turning import holonomy_class
from solvers.singularities.decision import Existence, existence
from solvers.singularities.remedies import AddPair
from solvers.singularities.theorems import BUDGET
from solvers.singularities.topology import decide
from solvers.surface.triangulation import next_halfedge


@dataclass(frozen=True)
class Piece:
    """What a field has in one of the pieces that features cut a surface into.

    Parameters
    ----------
    genus : int
        Number of handles.
    corners : tuple of tuple of int
        The indices along each boundary loop, the piece on its left; those of straight corners are
        left out.
    indices : tuple of int
        Of the singularities inside.
    """

    genus: int
    corners: tuple[tuple[int, ...], ...]
    indices: tuple[int, ...]


def field_existence(aligned: AlignedField) -> Existence:
    """Decide whether any quad mesh has the configuration, the turns and the sectors of a field.

    Parameters
    ----------
    aligned : AlignedField
        The field.

    Returns
    -------
    Existence
        Of the whole surface by the turns; impossible too if one of its pieces is.

    Examples
    --------
    A strip between two circles of a cylinder is straight on both sides, or else has singularities:

    >>> from solvers.fields import aligned_field, field_existence, prepare
    >>> from solvers.primitives import cylinder
    >>> field_existence(aligned_field(prepare(cylinder(n=24)), [0])).answer
    'possible'
    >>> print(field_existence(aligned_field(prepare(cylinder(n=24)), [1])).theorem)
    Between two straight boundaries without singularities the crosses do not turn (developing...
    """
    field = aligned.isotropic
    turns = holonomy_class(aligned)
    whole = existence(field.surface, field.singularities, field.corners, turns)
    if whole.theorem is not None or not len(aligned.features):
        return whole
    for piece in pieces(aligned):
        _, theorem = decide(piece.genus, piece.corners, piece.indices)
        if theorem is not None and theorem is not BUDGET:
            statement = f"In a piece between feature curves: {theorem.statement}"
            return Existence("impossible", replace(theorem, statement=statement), (AddPair(),))
    return whole


def pieces(aligned: AlignedField) -> Iterator[Piece]:
    """Yield what a field has in each of the pieces that its features cut the surface into.

    Parameters
    ----------
    aligned : AlignedField
        The field.
    """
    t, s = aligned.integrability.triangulation, aligned.sectors
    border = t.twin < 0
    for h in (aligned.integrability.features, t.twin[aligned.integrability.features]):
        border[h] = True
    h = np.flatnonzero(~border)
    shape = (t.n_faces, t.n_faces)
    graph = csr_array((np.ones(len(h), dtype=np.int8), (h // 3, t.twin[h] // 3)), shape=shape)
    count, piece = connected_components(graph, directed=False)
    of_sector = np.empty(len(s.vertex), dtype=np.int64)
    of_sector[s.of_corner] = np.repeat(piece, 3)
    rim = np.flatnonzero(border)
    starting = np.full(len(s.vertex), -1, dtype=np.int64)
    starting[s.of_corner[rim]] = rim
    following = dict(
        zip(rim.tolist(), starting[s.of_corner[next_halfedge(rim)]].tolist(), strict=True)
    )
    quads = np.rint(aligned.sector_quads).astype(np.int64)
    n_edges = np.bincount(piece[rim // 3], minlength=count) + (
        np.bincount(piece[h // 3], minlength=count) // 2
    )
    characteristic = (
        np.bincount(of_sector, minlength=count) - n_edges + np.bincount(piece, minlength=count)
    )
    corners: list[list[tuple[int, ...]]] = [[] for _ in range(count)]
    while following:
        at, following_one = following.popitem()
        loop = [at]
        while following_one != loop[0]:
            loop.append(following_one)
            following_one = following.pop(following_one)
        index = STRAIGHT - quads[s.of_corner[loop]]
        corners[piece[at // 3]].append(tuple(index[index != 0].tolist()))
    inner = (starting < 0) & (quads != REGULAR)
    for number in range(count):
        n_loops = len(corners[number])
        indices = REGULAR - quads[inner & (of_sector == number)]
        genus = (2 - n_loops - int(characteristic[number])) // 2
        yield Piece(genus, tuple(corners[number]), tuple(indices.tolist()))
