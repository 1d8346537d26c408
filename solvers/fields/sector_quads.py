"""How many quads a field has in the sectors between feature curves: linear in whole numbers.

From the edge that starts a sector to the one that ends it, an aligned field turns against the
surface by whole quarter turns: as many quads are there. The whole numbers are by how many quarter
turns the field is turned further at each curve and over each holonomy condition. Along a curve
there are two quads on both sides, but where it is broken.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from scipy.sparse import coo_array, csr_array

from solvers.features.edges import SHARP_TURN, along_chains
from solvers.features.sectors import Sectors, sectors_between
from solvers.frozen import freeze_arrays, frozen_property
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, IntrinsicTriangulation

Array = TypeVar("Array", IntArray, FloatArray)

REGULAR = 4
"""Quads around a vertex that is not singular. From theory."""

STRAIGHT = 2
"""Quads on each side of a curve that goes straight on. From theory."""


@dataclass(frozen=True, eq=False)
class Chains:
    """Feature edges in the order that they follow each other, as far as curves go on.

    Parameters
    ----------
    order : (k,) int array
        The edges, chain by chain.
    number : (k,) int array
        The chain of each edge.
    links : (l,) int array
        Where in `order` an edge follows another of its chain.
    sectors : (l,) int array
        The sector from that other edge to it.
    """

    order: IntArray
    number: IntArray
    links: IntArray
    sectors: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.order) - len(self.links)

    @frozen_property
    def last(self) -> IntArray:
        """(count,) the last edge of each."""
        last = np.empty(self.count, dtype=np.int64)
        last[self.number[self.order]] = self.order
        return last

    @frozen_property
    def of_link(self) -> IntArray:
        """(l,) the chain of each link."""
        return self.number[self.order[self.links]]

    def along(self, steps: IntArray) -> IntArray:
        """Return what steps (l, ...) over the links add up to at each edge (k, ...), from 0."""
        total = np.zeros((len(self.order), *steps.shape[1:]), dtype=np.int64)
        total[self.links] = steps
        total = np.cumsum(total, axis=0)
        first = np.ones(len(self.order), dtype=bool)
        first[self.links] = False
        total -= total[np.maximum.accumulate(np.where(first, np.arange(len(first)), 0))]
        result = np.empty_like(total)
        result[self.order] = total
        return result


@dataclass(frozen=True, eq=False)
class SectorQuads:
    """The numbers of quads in all sectors for each choice of the whole numbers.

    The first of these are quarter turns of chains, the others of conditions.

    Parameters
    ----------
    sectors : Sectors
        Of the features and the boundary.
    chains : Chains
        Of the feature edges.
    angles : (k, 1 + c) float array
        Of a field against each feature edge, and by how much that grows with a quarter turn of each
        condition; radians.
    rotations : (s, 1 + c) float array
        By how much a field turns over each sector against the surface, likewise.
    breaks : (l,) int array
        At each link, how many quads are missing on its side.
    """

    sectors: Sectors
    chains: Chains
    angles: FloatArray
    rotations: FloatArray
    breaks: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @cached_property
    def _shifts(self) -> IntArray:
        """(k, 1 + c) quarter turns at each edge that make its chain go straight on, or break."""
        steps = _turned_back(self.sectors, self.angles, self.rotations)[self.chains.sectors]
        steps[:, 0] += self.breaks - STRAIGHT
        return self.chains.along(steps)

    @frozen_property
    def turning(self) -> FloatArray:
        """(k, 1 + c) by how much to turn the field at each edge; radians."""
        return np.asarray(QUARTER * self._shifts - self.angles)

    @frozen_property
    def by_number(self) -> FloatArray:
        """(k, p) by how much more to turn it for each of the numbers; radians."""
        by_chain = QUARTER * np.eye(self.chains.count)[self.chains.number]
        return np.column_stack([by_chain, self.turning[:, 1:]])

    @cached_property
    def _whole(self) -> IntArray:
        whole = _turned_back(self.sectors, self.angles, self.rotations)
        return whole + _between(self.sectors, self._shifts)

    @frozen_property
    def constant(self) -> IntArray:
        """(s,) quads in each sector if all numbers are 0."""
        return self._whole[:, 0]

    @cached_property
    def matrix(self) -> csr_array:
        """(s, p) by how many more for each of the numbers."""
        n, columns = self.chains.count, self._whole.shape[1] - 1
        row, condition = np.nonzero(self._whole[:, 1:])
        value = self._whole[row, 1 + condition]
        rows, numbers, values = [row], [n + condition], [value]
        for edge, sign in ((self.sectors.start, 1), (self.sectors.end, -1)):
            at = np.flatnonzero(edge >= 0)
            rows.append(at)
            numbers.append(self.chains.number[edge[at]])
            values.append(np.full(len(at), sign))
        entries = (np.concatenate(rows), np.concatenate(numbers))
        shape = (len(self._whole), n + columns)
        matrix = csr_array(coo_array((np.concatenate(values), entries), shape=shape))
        matrix.eliminate_zeros()
        return matrix

    @frozen_property
    def beside(self) -> IntArray:
        """The sectors beside features."""
        return np.flatnonzero((self.sectors.start >= 0) | (self.sectors.end >= 0))

    def quads(self, numbers: FloatArray) -> IntArray:
        """Return the quads in each sector for given whole numbers (p,)."""
        return np.asarray(self.constant + np.rint(self.matrix @ numbers).astype(np.int64))


def sector_quads(
    triangulation: IntrinsicTriangulation,
    halfedges: IntArray,
    angles: FloatArray,
    corners: FloatArray,
) -> SectorQuads:
    """Return the quads in the sectors that a field gets by alignment with features.

    A closed curve is broken as often as the singularities beside it ask for, where the field turns
    most.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.
    halfedges : (k,) int array
        One of each feature edge.
    angles : (k, 1 + c) float array
        As of `SectorQuads`.
    corners : (m, 3, 1 + c) float array
        By how much a field turns over each corner, against the surface, and how that grows with the
        quarter turns.
    """
    sectors = sectors_between(triangulation, halfedges)
    rotations = np.stack([sectors.total(each) for each in np.moveaxis(corners, 2, 0)], axis=1)
    chains, openings = chained(sectors, _turned_back(sectors, angles, rotations)[:, 0])
    straight = np.zeros(len(chains.links), dtype=np.int64)
    found = SectorQuads(sectors, chains, angles, rotations, straight)
    return replace(found, breaks=_breaks(found, openings))


def turned_over_corners(offsets: FloatArray) -> FloatArray:
    """Return by how much a field turns over each corner, from edge to edge.

    Parameters
    ----------
    offsets : (m, 3) float array
        How far it turns from each triangle's barycentre to its edge midpoints.

    Returns
    -------
    (m, 3) float array
        Counter-clockwise, at the first corner of each halfedge.
    """
    return np.asarray(offsets[:, [2, 0, 1]] - offsets)


def _between(sectors: Sectors, values: Array) -> Array:
    """Return values (k, 1 + c) at the edge that starts each sector less those at its end."""
    padded = np.concatenate([values, np.zeros((1, values.shape[1]), dtype=values.dtype)])
    difference: Array = padded[sectors.start] - padded[sectors.end]
    return difference


def _turned_back(sectors: Sectors, angles: FloatArray, rotations: FloatArray) -> IntArray:
    """Return the (s, 1 + c) quads in sectors if the field is turned back by its angles."""
    return np.rint((rotations - _between(sectors, angles)) / QUARTER).astype(np.int64)


def chained(sectors: Sectors, whole: IntArray) -> tuple[Chains, IntArray]:
    """Link feature edges where two meet at a regular vertex without a sharp turn.

    Parameters
    ----------
    sectors : Sectors
        Between the edges.
    whole : (s,) int array
        Quads in each; only what they sum to at vertices counts.

    Returns
    -------
    chains : Chains
        Of the edges.
    openings : (o,) int array
        The sectors where closed chains are opened, from the last edge to the first.
    """
    s, n = sectors, int(sectors.start.max(initial=-1)) + 1
    at_vertex = np.bincount(s.vertex)[s.vertex]
    around = np.bincount(s.vertex, whole)[s.vertex]
    two = (s.start >= 0) & (s.end >= 0) & (s.start != s.end) & (at_vertex == 2)
    regular = np.flatnonzero(two & (around == REGULAR))
    passed = regular[np.argsort(s.vertex[regular], kind="stable")].reshape(-1, 2)
    turn = np.abs(np.diff(s.angle[passed], axis=1)[:, 0]) / 2
    passed, turn = passed[turn < SHARP_TURN], turn[turn < SHARP_TURN]
    pairs = np.stack([s.start[passed[:, 0]], s.end[passed[:, 0]]], axis=1)
    order, label = along_chains(n, pairs, turn)
    links = 1 + np.flatnonzero(label[order[1:]] == label[order[:-1]])
    # of both sectors at a vertex, that which runs along the chain
    sides = passed.reshape(-1)
    keys = s.start[sides] * n + s.end[sides]
    by_key = np.argsort(keys)
    asked = order[links - 1] * n + order[links]
    followed = sides[by_key[np.searchsorted(keys, asked, sorter=by_key)]]
    chains = Chains(order, np.unique(label, return_inverse=True)[1], links, followed)
    left = passed[~np.isin(s.vertex[passed[:, 0]], s.vertex[followed])]
    is_last = np.zeros(n, dtype=bool)
    is_last[chains.last] = True
    # of a chain of two edges the last edge ends one sector, and starts the other
    return chains, np.where(is_last[s.start[left[:, 0]]], left[:, 0], left[:, 1])


def _breaks(quads: SectorQuads, openings: IntArray) -> IntArray:
    """Return the breaks that leave what closed chains miss, a quad at most, at each vertex."""
    breaks, chains = quads.breaks.copy(), quads.chains
    for sector in openings[np.diff(quads.matrix.indptr)[openings] == 0].tolist():
        missing = STRAIGHT - int(quads.constant[sector])
        links = np.flatnonzero(chains.of_link == chains.number[quads.sectors.start[sector]])
        turned = quads.rotations[np.append(chains.sectors[links], sector), 0]
        broken = np.argsort(np.sign(missing) * turned, kind="stable")[: abs(missing)]
        breaks[links[broken[broken < len(links)]]] = np.sign(missing)
    return breaks
