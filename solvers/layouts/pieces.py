"""The pieces between arcs, walked around with the piece on the left."""

from __future__ import annotations

import numpy as np

from solvers.layouts.curves import Curves
from solvers.layouts.errors import LayoutError
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray


def cycles(
    arcs: IntArray, on_boundary: BoolArray, quads: IntArray, inner: BoolArray
) -> list[list[tuple[int, bool]]]:
    """Return the half-arcs around each piece, with whether it turns by 90 degrees after each."""
    leaving = {}
    for arc, (one, onwards, other, back) in enumerate(arcs.tolist()):
        leaving[one, onwards], leaving[other, back] = 2 * arc, 2 * arc + 1
    following: dict[int, tuple[int, bool]] = {}
    for arc, (one, onwards, other, back) in enumerate(arcs.tolist()):
        for half, node, slot in ((2 * arc, other, back), (2 * arc + 1, one, onwards)):
            if half % 2 and on_boundary[arc]:
                continue  # the surface lies on the other side
            for turn in range(1, quads[node] + 1):
                at = (slot - turn) % quads[node] if inner[node] else slot - turn
                if (node, at) in leaving:
                    break
            if turn > 2 or (node, at) not in leaving:
                raise LayoutError("the separatrices do not cut the surface into rectangles")
            following[half] = leaving[node, at], turn == 1
    return _closed_chains(following)


def _closed_chains(following: dict[int, tuple[int, bool]]) -> list[list[tuple[int, bool]]]:
    """Take apart what follows what, with a mark each, into closed chains."""
    found = []
    for half in list(following):
        chain = []
        while half in following:
            after, corner = following.pop(half)
            chain.append((half, corner))
            half = after
        if chain:
            found.append(chain)
    return found


def as_sides(
    cycles: list[list[tuple[int, bool]]], curves: Curves, curve: IntArray, span: FloatArray
) -> tuple[IntArray, IntArray]:
    """Return the sides of the pieces, which must be rectangles."""
    offsets, halfarcs = [0], []
    for cycle in cycles:
        corners = [i for i, (_, corner) in enumerate(cycle) if corner]
        if len(corners) != 4:
            arcs = np.array([half // 2 for half, _ in cycle])
            faces = curves.chords.face[curves.chords_at(curve[arcs], span[arcs, 0])[0]]
            raise LayoutError(
                f"a piece between the separatrices has {len(corners)} corners instead of four",
                faces=curves.chart.on_surface(faces),
            )
        first = corners[-1] + 1
        for half, corner in cycle[first:] + cycle[:first]:
            halfarcs.append(half)
            if corner:
                offsets.append(len(halfarcs))
    return np.array(offsets, dtype=np.int64), np.array(halfarcs, dtype=np.int64)
