"""What meshes are checked against: the surface of a problem, and what was imposed on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from crossview.certificate import (
    Certificate,
    Faces,
    Fault,
    Irregular,
    Reference,
    Sizes,
    certify,
    certify_corners,
)
from crossview.io import read_polygons
from crossview.workflow.problem import Problem
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError, counted
from solvers.features import Features
from solvers.quads import QuadMesh
from solvers.surface import FloatArray, TriSurface


def faces_in(path: str | Path) -> Faces:
    """The faces in a file, whole.

    Raises
    ------
    CrossviewError
        It cannot be read, or holds no faces.
    """
    found = read_polygons(path)
    try:
        return Faces(found.points, found.sizes, found.corners)
    except CrossviewError as error:
        error.locate(str(path))
        raise


def faces_of(mesh: QuadMesh) -> Faces:
    """The faces of a quad mesh."""
    return Faces.of_one_size(mesh.vertices, mesh.quads)


def own_surface(surface: TriSurface) -> Reference:
    """Return what a mesh on a surface is checked against: that alone."""
    return Reference(Faces.of_one_size(surface.vertices, surface.faces))


def reference(problems: Sequence[Problem], imposed: bool, wanted: int | None = None) -> Reference:
    """Return what a mesh on the surfaces of problems is checked against.

    Parameters
    ----------
    problems : sequence of Problem
        One for each piece of the surface.
    imposed : bool
        Whether irregular vertices are to be the singularities and corners of the problems.
    wanted : int, optional
        How many quads there should be.
    """
    surfaces = [problem.surface for problem in problems]
    first = np.cumsum([0] + [surface.n_vertices for surface in surfaces])
    faces = [s.faces + start for s, start in zip(surfaces, first, strict=False)]
    points = np.concatenate([surface.vertices for surface in surfaces])
    features = [_segments(problem.features) for problem in problems]
    return Reference(
        Faces.of_one_size(points, np.concatenate(faces)),
        np.concatenate(features),
        _singularities(problems) if imposed else None,
        _corners(problems) if imposed else None,
        wanted,
    )


ADVICE = {
    "inverted": "try another number of quads",
    "slivers": "try another number of quads",
    "surface": "try more quads",
    "boundary": "try more quads",
    "features": "try more quads",
    "area": "try more quads",
}
"""What helps against kinds of faults."""

SAFE = 0.3
"""Least scaled Jacobian above which the certificate is not asked whether quads are inverted.

Chosen: the two measure normals in different ways.
"""

_GIVEN: WeakKeyDictionary[QuadMesh, Certificate] = WeakKeyDictionary()
"""Certificates of meshes that still are: report and summary ask one after the other."""


def certified(solution: Solution, mesh: QuadMesh) -> Certificate:
    """Check the quads of a solution: its singularities, features kept, sizes and number are wanted.

    Parameters
    ----------
    solution : Solution
    mesh : QuadMesh
        Of that solution; its certificate is kept as long as it is.
    """
    if mesh not in _GIVEN:
        _GIVEN[mesh] = _certified(solution, mesh)
    return _GIVEN[mesh]


class Worth(NamedTuple):
    """What meshes are compared by, the most important first.

    Parameters
    ----------
    upright : bool
        Whether no quad is inverted.
    met : bool
        Whether there are as many as were wanted.
    fewest : int
        Number of inverted quads, negative.
    quality : float
        Least scaled Jacobian.
    """

    upright: bool
    met: bool
    fewest: int
    quality: float


def worth(mesh: QuadMesh, surface: Reference) -> Worth:
    """What a mesh is worth on its surface; the certificate decides unless all quads are good.

    Parameters
    ----------
    mesh : QuadMesh
    surface : Reference
        As of `own_surface`.
    """
    met = mesh.quantization is None or not mesh.quantization.missed
    quality = float(mesh.scaled_jacobian.min(initial=1.0))
    if quality > SAFE:
        return Worth(True, met, 0, quality)
    corners, _ = certify_corners(faces_of(mesh), surface)
    inverted = int(corners["inverted_faces"])
    return Worth(inverted == 0, met, -inverted, float(corners["min_scaled_jacobian"]))


def inverted(mesh: QuadMesh) -> Fault | None:
    """What the certificate of a mesh says of inverted quads; None: there are none.

    Of a mesh that has no certificate yet one is made, on its own surface.
    """
    own = _GIVEN.get(mesh) or certify(faces_of(mesh), own_surface(mesh.surface))
    return next((fault for fault in own.faults if fault.kind == "inverted"), None)


def verdict(certificate: Certificate) -> str:
    """What the certificate of a solution's quads says, in one line: that all is right, or what not.

    The same words stand in the window and in the summary.
    """
    if certificate.right:
        return "all quads, irregular exactly where imposed, the surface covered"
    worst, *others = certificate.faults
    more = f" (and {counted(len(others), 'more fault')})" if others else ""
    advice = f": {ADVICE[worst.kind]}" if worst.kind in ADVICE else ""
    return f"{worst}{more}{advice}"


def _certified(solution: Solution, mesh: QuadMesh) -> Certificate:
    chosen = mesh.quantization
    wanted = None if chosen is None else chosen.n_wanted
    surface = solution.surface
    sizes = Sizes(surface.vertices[surface.faces], solution.field.H[surface.faces])
    against = reference([solution.problem], True, wanted)
    against = replace(against, features=_segments(solution.features), sizes=sizes)
    return certify(faces_of(mesh), against)


def _segments(features: Features) -> FloatArray:
    """The edges of features (k, 2, 3)."""
    surface = features.surface
    return surface.vertices[surface.edges[features.edges]]


def _singularities(problems: Sequence[Problem]) -> Irregular:
    places = [p.surface.positions([s.point for s in p.singularities]) for p in problems]
    valences = [s.valence for p in problems for s in p.singularities]
    return _without(4, np.concatenate(places), valences)


def _corners(problems: Sequence[Problem]) -> Irregular:
    places = [p.surface.vertices[list(p.chosen_corners)] for p in problems]
    meeting = [2 - index for p in problems for index in p.chosen_corners.values()]
    return _without(2, np.concatenate(places), meeting)


def _without(regular: int, places: FloatArray, meeting: Sequence[int]) -> Irregular:
    """The places where another number of quads meets than the regular one."""
    numbers = np.array(meeting, dtype=np.int64)
    return Irregular(places[numbers != regular], numbers[numbers != regular])
