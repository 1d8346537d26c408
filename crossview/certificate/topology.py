"""Whether a mesh is of quads, one oriented surface, and of the topology that it should have."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crossview.certificate.faces import Faces
from crossview.certificate.fault import Fault, Measures, first


def counts(mesh: Faces) -> Measures:
    """How many vertices and faces there are, and how many of what should not be."""
    four = (mesh.sizes == 4) & mesh.whole
    return {
        "vertices": len(mesh.points),
        "unused_vertices": len(mesh.points) - len(mesh.used),
        "faces": len(mesh.sizes),
        "quads": int(np.count_nonzero(four)),
        "non_quads": int(np.count_nonzero(~four)),
        "repeating_faces": int(np.count_nonzero(~mesh.whole)),
        "non_manifold_edges": len(mesh.crowded),
        "non_manifold_vertices": len(mesh.pinched),
        "turned_faces": int(np.count_nonzero(mesh.turned[0])),
        "two_sided": mesh.turned[1],
    }


def topology(mesh: Faces) -> Measures:
    """Euler characteristic, connected boundaries and pieces."""
    return {
        "euler_characteristic": mesh.euler,
        "boundary_loops": mesh.loops,
        "pieces": mesh.pieces[0],
    }


def topology_faults(mesh: Faces, surface: Faces) -> Iterator[Fault]:
    """What is wrong with either."""
    middles, points = mesh.middles, mesh.points
    crowded, pinched = points[mesh.crowded].mean(axis=1), points[mesh.pinched]
    yield from first("non-quads", "face", "without four corners", middles[mesh.sizes != 4])
    yield from first("repeating", "face", "with a vertex twice", middles[~mesh.whole])
    yield from first("non-manifold edges", "edge", "of more than two faces", crowded)
    yield from first("non-manifold vertices", "vertex", "where faces only touch", pinched)
    if mesh.turned[1]:
        against = middles[mesh.turned[0]]
        yield from first("turned", "face", "oriented against the others", against)
    else:
        yield Fault("one-sided", "the mesh has only one side")
    for name, found in topology(mesh).items():
        wanted = topology(surface)[name]
        if found != wanted:
            word = name.replace("_", " ").replace("euler", "Euler")
            yield Fault("topology", f"{word} {found}, that of the surface is {wanted}")
