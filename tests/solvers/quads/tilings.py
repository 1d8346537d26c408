"""T-meshes for the tests: rectangles in the plane, and some closed ones."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.layouts.tmesh import TMesh
from solvers.quads.quadmesh import QuadMesh
from solvers.surface.trisurface import TriSurface

Place = tuple[float, float]

Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top."""

DIAGONALS = [(1e-7, 1e-7), (-1e-7, 1e-7), (-1e-7, -1e-7), (1e-7, -1e-7)]

ONE = [(0.0, 0.0, 5.3, 2.2)]
PINWHEEL = [
    (0.0, 0.0, 6.1, 2.3),
    (6.1, 0.0, 9.0, 5.2),
    (3.2, 5.2, 9.0, 8.0),
    (0.0, 2.3, 3.2, 8.0),
    (3.2, 2.3, 6.1, 5.2),
]
"""Five rectangles, each side of the middle one running on past its neighbour: four T-junctions."""


def tiling(
    rectangles: Iterable[Rectangle],
    critical: Iterable[tuple[float, float]] = (),
    period: float | None = None,
) -> TMesh:
    """Rectangles that tile a region of the plane, which may close up in x after a period.

    Critical are the nodes at given places and the corners of the region.
    """
    tiles = list(rectangles)
    shifts = [0.0] if period is None else [-period, 0.0, period]

    def at(x: float, y: float) -> tuple[float, float]:
        return round(x if period is None else x % period, 9), round(y, 9)

    places = sorted({at(x, y) for a, b, c, d in tiles for x in (a, c) for y in (b, d)})
    number = {place: i for i, place in enumerate(places)}
    everywhere = [(x + shift, y) for x, y in places for shift in shifts]
    arcs: dict[tuple[float, float, int], int] = {}  # by middle and direction
    ends: list[tuple[int, int]] = []
    lengths, offsets, halfarcs = [], [0], []
    for left, bottom, right, top in tiles:
        for start, end in pairwise(
            [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]
        ):
            along = int(start[0] == end[0])
            chain = sorted({start, end} | {p for p in everywhere if _between(start, p, end)})
            pieces = [
                arcs.setdefault((*at((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), along), len(arcs))
                for a, b in pairwise(chain)
            ]
            for (a, b), piece in zip(pairwise(chain), pieces, strict=True):
                if piece == len(ends):
                    ends.append((number[at(*a)], number[at(*b)]))
                    lengths.append(b[along] - a[along])
            forwards = start < end
            halfarcs += [2 * k + (not forwards) for k in pieces[:: 1 if forwards else -1]]
            offsets.append(len(halfarcs))
    rim = np.bincount(np.array(halfarcs) // 2) == 1
    on_rim = np.zeros(len(places), dtype=bool)
    on_rim[np.array(ends)[rim]] = True
    kept = on_rim & np.array([_quarters(tiles, p, shifts) != 2 for p in places])
    kept[[number[at(x, y)] for x, y in critical]] = True
    valence = np.bincount(np.array(ends).reshape(-1), minlength=len(places))
    sides = np.array(offsets), np.array(halfarcs)
    return TMesh(np.array(ends), np.array(lengths), rim, valence, kept, on_rim, *sides)


def _between(a: Place, p: Place, b: Place) -> bool:
    low, high = min(a, b), max(a, b)
    along = int(a[0] == b[0])
    return abs(p[1 - along] - a[1 - along]) < 1e-8 and low[along] < p[along] < high[along]


def _quarters(tiles: list[Rectangle], p: Place, shifts: list[float]) -> int:
    """How many of the four quarters around a place lie in a tile."""
    near = [(p[0] + shift + dx, p[1] + dy) for shift in shifts for dx, dy in DIAGONALS]
    return sum(a < x < c and b < y < d for x, y in near for a, b, c, d in tiles)


def dissection(seed: int, n: int, width: float = 7.0, height: float = 5.0) -> list[Rectangle]:
    """A rectangle cut n times, each time the largest piece, at a random place across."""
    rng = np.random.default_rng(seed)
    pieces: list[Rectangle] = [(0.0, 0.0, width, height)]
    for _ in range(n):
        pieces.sort(key=lambda r: (r[2] - r[0]) * (r[3] - r[1]))
        left, bottom, right, top = pieces.pop()
        share = float(rng.uniform(0.15, 0.85))
        if rng.random() < (right - left) / (right - left + top - bottom):
            x = round(left + share * (right - left), 6)
            pieces += [(left, bottom, x, top), (x, bottom, right, top)]
        else:
            y = round(bottom + share * (top - bottom), 6)
            pieces += [(left, bottom, right, y), (left, y, right, top)]
    return pieces


def cube() -> TMesh:
    """The six unit squares of a cube, all corners critical."""
    faces = [
        (0, 3, 2, 1),
        (4, 5, 6, 7),
        (0, 1, 5, 4),
        (1, 2, 6, 5),
        (2, 3, 7, 6),
        (3, 0, 4, 7),
    ]
    edges: dict[tuple[int, int], int] = {}
    halfarcs = []
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            edge = edges.setdefault((min(a, b), max(a, b)), len(edges))
            halfarcs.append(2 * edge + (a > b))
    none = np.zeros(8, dtype=bool)
    return TMesh(
        np.array(list(edges)),
        np.ones(12),
        np.zeros(12, dtype=bool),
        np.full(8, 3),
        ~none,
        none,
        np.arange(25),
        np.array(halfarcs),
    )


def torus(width: float = 6.3, height: float = 2.5) -> TMesh:
    """One rectangle glued to itself both ways."""
    return TMesh(
        np.zeros((2, 2), dtype=int),
        np.array([width, height]),
        np.zeros(2, dtype=bool),
        np.array([4]),
        np.array([False]),
        np.array([False]),
        np.arange(5),
        np.array([0, 2, 1, 3]),
    )


def assembled(t: TMesh, counts: np.ndarray, surface: TriSurface) -> QuadMesh:
    """The quads of a T-mesh, by joining all vertices that are one; only connectivity counts."""
    inner = np.concatenate([[0], np.cumsum(np.maximum(counts - 1, 0))]) + t.n_nodes
    pairs = [tuple(t.arcs[a]) for a in np.flatnonzero(counts == 0)]
    n, quads = int(inner[-1]), []

    def along(r: int, j: int) -> list[int]:
        line = [int(t.arcs[t.side(r, j)[0] // 2, t.side(r, j)[0] % 2])]
        for half in t.side(r, j).tolist():
            between = list(range(inner[half // 2], inner[half // 2 + 1]))
            end = int(t.arcs[half // 2, 1 - half % 2])
            line += [*between[:: -1 if half % 2 else 1], end] if counts[half // 2] else []
        return line

    for r in range(t.n_rectangles):
        low, right, top, left = (along(r, j) for j in range(4))
        grid = n + np.arange(len(low) * len(right)).reshape(len(low), len(right))
        n += grid.size
        pairs += zip(grid[:, 0], low, strict=True)
        pairs += zip(grid[:, -1], top[::-1], strict=True)
        pairs += zip(grid[0], left[::-1], strict=True)
        pairs += zip(grid[-1], right, strict=True)
        corners = [grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]]
        quads.append(np.stack(corners, axis=2).reshape(-1, 4))
    graph = coo_array((np.ones(len(pairs)), np.array(pairs).T), shape=(n, n))
    count, label = connected_components(graph, directed=False)
    loop, fixed = np.full(count, -1), np.zeros(count, dtype=bool)
    loop[label[: t.n_nodes][t.node_on_boundary]] = 0
    loop[label[: inner[-1]][t.n_nodes :][np.repeat(t.arc_on_boundary, np.diff(inner))]] = 0
    fixed[label[: t.n_nodes][t.critical]] = True
    four = label[np.concatenate(quads)].astype(np.int64)
    none = np.zeros(count, dtype=np.int64)
    return QuadMesh(
        surface,
        np.zeros((count, 3)),
        four,
        np.zeros(len(four), int),
        none,
        np.zeros((count, 3)),
        fixed,
        loop,
    )
