"""Where not four faces meet, and whether that is where it should be."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from crossview.certificate.faces import Bools, Faces, Floats
from crossview.certificate.fault import Fault, Measures, at
from crossview.certificate.reference import Irregular
from solvers.errors import counted

PLACE_LIMIT = 0.35
"""How far an irregular vertex may be from its place, in mean edges. Chosen."""


def irregular(mesh: Faces) -> tuple[Irregular, Irregular]:
    """The irregular vertices of a mesh, inside and on the boundary."""
    used = mesh.meeting > 0
    return (
        _of(mesh, used & ~mesh.on_rim & (mesh.meeting != 4)),
        _of(mesh, used & mesh.on_rim & (mesh.meeting != 2)),
    )


def _of(mesh: Faces, chosen: Bools) -> Irregular:
    return Irregular(mesh.points[chosen], mesh.meeting[chosen])


def by_number(found: Irregular) -> dict[str, int]:
    """How many there are of each number of faces; written as text, for they are keys."""
    number, count = np.unique(found.meeting, return_counts=True)
    return {str(n): c for n, c in zip(number.tolist(), count.tolist(), strict=True)}


def compared(found: Irregular, wanted: Irregular, edge: float) -> tuple[Measures, list[Fault]]:
    """How many are missing or too many, and how far the others are off, in mean edges."""
    missing, added, off = [], [], [(0.0, np.zeros(3))]
    for number in np.union1d(found.meeting, wanted.meeting):
        here = found.positions[found.meeting == number]
        there = wanted.positions[wanted.meeting == number]
        gaps = cdist(here, there)
        i, j = linear_sum_assignment(gaps)
        added += [(number, x) for x in np.delete(here, i, axis=0)]
        missing += [(number, x) for x in np.delete(there, j, axis=0)]
        off += [(gaps[k] / edge, there[k[1]]) for k in zip(i, j, strict=True)]
    worst, place = max(off, key=lambda pair: pair[0])
    measures = {"missing": len(missing), "added": len(added), "max_distance": float(worst)}
    return measures, [*_faults(missing, added, worst, place)]


def _faults(
    missing: list[tuple[int, Floats]],
    added: list[tuple[int, Floats]],
    worst: float,
    place: Floats,
) -> Iterator[Fault]:
    for listed, said in ((missing, "missing"), (added, "too many")):
        if listed:
            number, where = listed[0]
            noun = counted(len(listed), "irregular vertex")
            what = f"{noun} {said}, the first, of {number} faces,"
            yield at("irregular", what, where)
    if worst > PLACE_LIMIT:
        yield at("irregular", f"an irregular vertex is {worst:.2g} edges from its place", place)
