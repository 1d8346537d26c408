"""Tools that keep the index sum, as commands."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from crossview.session.commands import (
    AddSingularities,
    Command,
    MoveSingularity,
    ReplaceSingularities,
)
from crossview.session.document import Document
from crossview.workflow import configurations
from solvers.errors import SingularityError
from solvers.progress import Progress
from solvers.singularities import far_points, merged, mirrored, pair_at, rotated, split
from solvers.surface import SurfacePoint


def add_pair(document: Document, point: SurfacePoint) -> Command:
    """Put a valence 3 and a valence 5 around a point of the document's surface."""
    pair = pair_at(document.surface, document.singularities, point)
    return ReplaceSingularities(
        (*document.singularities, *pair),
        "add a pair of 3 and 5",
        connections=document.connections,
    )


def add_pair_somewhere(document: Document) -> Generator[Progress, None, Command]:
    """Put a pair where it is farthest from everything."""
    (point,) = yield from far_points(document.surface, document.singularities, 1)
    return add_pair(document, point)


def merge(document: Document, one: int, other: int) -> Command:
    """Make one singularity of two."""
    made = merged(document.surface, document.singularities, one, other)
    first, second = sorted((one, other))
    return ReplaceSingularities(made, f"merge singularities {first + 1} and {second + 1}")


def split_one(document: Document, which: int) -> Command:
    """Make two singularities of one."""
    made = split(document.surface, document.singularities, which)
    return ReplaceSingularities(made, f"split singularity {which + 1}")


def move_inside(document: Document, which: int) -> Command:
    """Take one singularity to the nearest vertex inside that is free.

    Raises
    ------
    SingularityError
        None is.
    """
    surface, placed = document.surface, document.singularities
    taken = [surface.nearest_vertex(s.point) for i, s in enumerate(placed) if i != which]
    free = ~surface.boundary_vertices
    free[taken] = False
    if not free.any():
        raise SingularityError("no vertex inside is free", advice="remove the singularity")
    away = np.linalg.norm(surface.vertices - surface.position(placed[which].point), axis=1)
    vertex = int(np.argmin(np.where(free, away, np.inf)))
    return MoveSingularity(which, surface.point_at_vertex(vertex))


def mirror(document: Document, axis: int) -> Command:
    """Mirror the configuration across x (0), y or z."""
    made = mirrored(document.surface, document.singularities, axis)
    name = f"mirror across {'xyz'[axis]}"
    return ReplaceSingularities(made, name, connections=document.connections)


def rotate(document: Document, axis: int) -> Command:
    """Turn the configuration by 90 degrees about x (0), y or z."""
    made = rotated(document.surface, document.singularities, axis, np.pi / 2)
    name = f"rotate about {'xyz'[axis]}"
    return ReplaceSingularities(made, name, connections=document.connections)


def distribute(document: Document) -> Generator[Progress, None, Command]:
    """Add what the index budget lacks, where it evens out the sizes most."""
    completed = yield from configurations.complete(document.problem)
    return AddSingularities(tuple(completed.singularities[len(document.singularities) :]))
