"""Ways to satisfy the index budget, offered as ready commands."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from crossview.session.commands import (
    MAX_VALENCE,
    MIN_VALENCE,
    AddSingularities,
    ChangeValence,
    Command,
    RemoveSingularities,
)
from crossview.session.document import Document
from solvers.points import SurfacePoint
from solvers.progress import Progress
from solvers.singularities import Singularity
from solvers.surface import TriSurface

MOST_ADDED = 64


@dataclass(frozen=True)
class Mending:
    """One offer.

    Parameters
    ----------
    label : str
        What the button says.
    make : callable
        Returns a generator that yields Progress and returns the Command; placing a singularity
        measures distances over the whole surface and does not belong in the GUI thread.
    """

    label: str
    make: Callable[[], Generator[Progress, None, Command]]


def mendings(document: Document) -> tuple[Mending, ...]:
    """Return what would bring the index sum nearer to the required one, the most likely first."""
    missing = document.budget.missing
    if missing == 0:
        return ()
    valence = 3 if missing > 0 else 5
    offers = [_offer_added(document, valence, 1)]
    if 1 < abs(missing) <= MOST_ADDED:
        offers.append(_offer_added(document, valence, abs(missing)))
    changed = _last_changeable(document, missing)
    return (*offers, changed) if changed is not None else tuple(offers)


def _offer_added(document: Document, valence: int, count: int) -> Mending:
    many = "one" if count == 1 else f"all {count}"
    return Mending(f"Add {many} valence {valence}", lambda: _added(document, valence, count))


def _last_changeable(document: Document, missing: int) -> Mending | None:
    """Offer to change the newest unlocked singularity that alone can take up `missing`."""
    for index in reversed(range(len(document.singularities))):
        singularity = document.singularities[index]
        valence = singularity.valence - missing
        if singularity.locked or not MIN_VALENCE <= valence <= MAX_VALENCE:
            continue
        if valence == 4:  # regular: it is to go
            return _offer(f"Delete #{index + 1}", RemoveSingularities(frozenset({index})))
        return _offer(f"Make #{index + 1} a valence {valence}", ChangeValence(index, valence))
    return None


def _offer(label: str, command: Command) -> Mending:
    return Mending(label, lambda: _ready(command))


def _ready(command: Command) -> Generator[Progress, None, Command]:
    yield Progress("mending", 1.0)
    return command


def _added(document: Document, valence: int, count: int) -> Generator[Progress, None, Command]:
    points = yield from far_points(document.surface, document.singularities, count)
    return AddSingularities(tuple(Singularity(point, valence) for point in points))


def far_points(
    surface: TriSurface, singularities: tuple[Singularity, ...], count: int
) -> Generator[Progress, None, tuple[SurfacePoint, ...]]:
    """Place `count` points far from the boundary, from `singularities` and from each other.

    Each is the vertex farthest, along edges, from all that came before (Gonzalez 1985); on a closed
    surface without singularities the first is the vertex farthest from the centroid.
    """
    graph = _edge_graph(surface)
    used = [surface.faces[s.point.face][np.argmax(s.point.barycentric)] for s in singularities]
    sources = np.concatenate([*surface.boundary_loops, np.asarray(used, dtype=np.int64)])
    if sources.size:
        distance = dijkstra(graph, indices=np.unique(sources).astype(np.int64), min_only=True)
    else:
        distance = np.linalg.norm(surface.vertices - surface.vertices.mean(axis=0), axis=1)
    chosen: list[int] = []
    for k in range(count):
        yield Progress("placing singularities", k / count)
        chosen.append(int(np.argmax(distance)))
        from_new = dijkstra(graph, indices=chosen[-1])
        distance = np.minimum(distance, from_new) if chosen[1:] or sources.size else from_new
    return tuple(surface.point_at_vertex(vertex) for vertex in chosen)


def _edge_graph(surface: TriSurface) -> csr_array:
    start, end = surface.edges[:, 0], surface.edges[:, 1]
    length: NDArray[np.float64] = np.linalg.norm(
        surface.vertices[end] - surface.vertices[start], axis=1
    )
    n = surface.n_vertices
    both = (np.concatenate([start, end]), np.concatenate([end, start]))
    return csr_array((np.concatenate([length, length]), both), shape=(n, n))
