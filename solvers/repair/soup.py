"""Make a surface of a triangle soup, and say what that took."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from solvers.errors import SurfaceError, counted
from solvers.repair.flat_triangles import mend_flat_triangles
from solvers.repair.orientation import orient
from solvers.repair.seams import share_vertices
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface
from solvers.surface.validation import (
    HalfedgePairs,
    array_problems,
    as_arrays,
    duplicate_faces,
    face_components,
    fan_labels,
    problems,
)

Step = Callable[[FloatArray, IntArray], tuple[FloatArray, IntArray, str]]


class NoComponent(SurfaceError):
    """A component that is asked for and not there.

    Parameters
    ----------
    what, where, advice : str
        As in `SurfaceError`.
    elements : array_like of int, optional
        As in `SurfaceError`.
    kind : {"", "faces", "vertices", "edges"}, optional
        As in `SurfaceError`.
    remedies : iterable of Remedy, optional
        As in `SurfaceError`.

    Examples
    --------
    >>> from solvers.repair import NoComponent, repair
    >>> try:
    ...     repair([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], component=9)
    ... except NoComponent as error:
    ...     print(error)
    there is no component 9 (of 1): choose "largest" or a number from 0 to 0
    """


@dataclass(frozen=True)
class Repaired:
    """A surface, and what was done to the arrays it comes from.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    notes : tuple of str, optional
        One for each change, in plain words.

    Examples
    --------
    >>> from solvers.repair import repair
    >>> repaired = repair([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> repaired.surface.n_faces, repaired.notes  # nothing had to be done
    (1, ())
    """

    surface: TriSurface
    notes: tuple[str, ...] = ()


def repair(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    merge: bool = False,
    cut_apart: bool = False,
    component: int | str | None = None,
) -> Repaired:
    """Make a surface, changing the arrays where that is safe or asked for.

    Always, as it leaves the surface what it is: vertices that belong to no triangle and all but one
    of triangles with the same corners are dropped, boundary edges that lie on each other are
    joined, triangles without area are flipped or collapsed, and triangles are turned to agree with
    their neighbours; a closed surface that had to be turned faces outwards.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Coordinates.
    faces : (m, 3) array_like of int
        Corner vertices.
    merge : bool, optional
        Make one vertex of those at the same place, for formats that do not share vertices.
    cut_apart : bool, optional
        Whether to cut the surface apart at non-manifold edges and vertices.
    component : int, "largest" or None, optional
        Keep one connected component, numbered from the largest, 0, down.

    Returns
    -------
    Repaired
        The surface, and what it took.

    Raises
    ------
    SurfaceError
        What still keeps the arrays from being one oriented manifold surface. Its elements are
        numbered as in the arrays given, unless what was mended, `merge`, `cut_apart` or `component`
        changed them.

    Examples
    --------
    >>> from solvers.repair import repair
    >>> vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [9, 9, 9]]
    >>> repaired = repair(vertices, [[0, 1, 2], [1, 2, 3]])
    >>> for note in repaired.notes:
    ...     print(note)
    dropped 1 unused vertex
    turned 1 triangle to agree with the others
    >>> repaired.surface.n_vertices
    4
    """
    points, triangles, notes = _mended(vertices, faces, merge, cut_apart)
    if component is not None:
        triangles, note = _choose(len(points), triangles, component)
        notes += [note] if note else []
    return Repaired(_surface(points, triangles), tuple(notes))


def repair_each(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, *, merge: bool = False, cut_apart: bool = False
) -> tuple[Repaired, ...]:
    """Make a surface of every connected component, the largest first.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Coordinates.
    faces : (m, 3) array_like of int
        Corner vertices.
    merge, cut_apart : bool, optional
        As of `repair`.

    Returns
    -------
    tuple of Repaired
        Each with all notes.

    Raises
    ------
    SurfaceError
        As of `repair`.

    Examples
    --------
    >>> from solvers.repair import repair_each
    >>> vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [5, 0, 0], [6, 0, 0], [5, 1, 0]]
    >>> pieces = repair_each(vertices, [[4, 5, 6], [0, 1, 2], [2, 1, 3]])
    >>> [piece.surface.n_faces for piece in pieces]
    [2, 1]
    """
    points, triangles, notes = _mended(vertices, faces, merge, cut_apart)
    of_face = face_components(len(points), triangles)
    return tuple(
        Repaired(_surface(points, triangles[of_face == number]), tuple(notes))
        for number in range(int(of_face.max(initial=0)) + 1)
    )


def _mended(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, merge: bool, cut_apart: bool
) -> tuple[FloatArray, IntArray, list[str]]:
    """Return the arrays after all repairs but the choice of a component, and notes on them."""
    points, triangles = as_arrays(vertices, faces)
    unused = ~np.isin(np.arange(len(points)), triangles)
    points[unused] = 0.0  # whatever stands there does no harm
    for problem in array_problems(points, triangles):
        raise problem
    notes = [f"dropped {counted(int(unused.sum()), 'unused vertex')}"] if unused.any() else []
    steps: list[Step] = [partial(share_vertices, merge=merge)]
    steps += [mend_flat_triangles, _drop_duplicates, orient]
    steps += [_cut_apart] if cut_apart else []
    for step in steps:
        points, triangles, note = step(points, triangles)
        notes += [note] if note else []
    return points, triangles, notes


def _surface(points: FloatArray, triangles: IntArray) -> TriSurface:
    """Return the surface of the triangles, without the vertices they do not use."""
    used = np.zeros(len(points), dtype=bool)
    used[triangles] = True
    if used.all():
        return TriSurface(points, triangles)
    for problem in problems(points, triangles):
        # in the caller's numbers; that vertices are unused is no problem here
        if problem.kind != "vertices" or used[problem.elements].any():
            raise problem
    number = np.cumsum(used) - 1
    return TriSurface(points[used], number[triangles])


def _drop_duplicates(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray, str]:
    again = duplicate_faces(triangles)
    note = f"dropped {counted(int(again.sum()), 'duplicate triangle')}" if again.any() else ""
    return points, triangles[~again], note


def _cut_apart(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray, str]:
    """Give each fan of triangles around a vertex a vertex of its own.

    Fans end at boundary edges and at edges of more than two triangles.
    """
    pairs = HalfedgePairs(len(points), triangles)
    crowded = round((1 / pairs.count[pairs.count > 2]).sum())
    count, label = fan_labels(pairs.twin)
    corner = triangles.reshape(-1)
    fans = np.unique(np.stack([corner, label]), axis=1)[0]
    several = int((np.bincount(fans) > 1).sum())
    if not several:
        return points, triangles, ""
    place = np.empty(count, dtype=np.int64)
    place[label] = corner
    note = f"cut apart at {counted(several, 'vertex')}"
    if crowded:
        note += f" and {counted(crowded, 'non-manifold edge')}"
    return points[place], label.reshape(-1, 3), note


def _choose(n_points: int, triangles: IntArray, component: int | str) -> tuple[IntArray, str]:
    of_face = face_components(n_points, triangles)
    count = int(of_face.max(initial=0)) + 1
    number = 0 if component == "largest" else component
    if not isinstance(number, int) or not 0 <= number < count:
        raise NoComponent(
            f"there is no component {component}",
            f"of {count}",
            f'choose "largest" or a number from 0 to {count - 1}',
        )
    kept = of_face == number
    if count == 1:
        return triangles, ""
    which = "the largest" if number == 0 else f"number {number}"
    return triangles[kept], (
        f"kept {which} of {count} components, {kept.sum()} of {len(kept)} triangles"
    )
