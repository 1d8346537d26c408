"""Built-in surfaces in space: spheres and what is made from them, tori, cylinders."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import ConvexHull

from solvers.errors import SurfaceError
from solvers.primitives.checks import affordable, positive, whole
from solvers.primitives.lattices import grid, rings, subdivide
from solvers.primitives.polygons import fill
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


def sphere(subdivisions: int = 4, radius: float = 1.0) -> TriSurface:
    """Return a sphere about the origin: an icosahedron, its triangles split in four, blown up.

    Parameters
    ----------
    subdivisions : int, optional
        How often the triangles are split; 0 is the icosahedron.
    radius : float, optional
        Of the sphere.

    Returns
    -------
    TriSurface
        Of 20 * 4^subdivisions triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import sphere
    >>> surface = sphere(subdivisions=2, radius=3.0)
    >>> surface.n_faces, surface.euler_characteristic
    (320, 2)
    >>> bool(np.allclose(np.linalg.norm(surface.vertices, axis=1), 3.0))
    True
    """
    vertices, faces = _icosphere(subdivisions)
    return TriSurface(positive("radius", radius) * vertices, faces)


def cube_sphere(n: int = 24, radius: float = 1.0) -> TriSurface:
    """Return a sphere with the symmetry of the cube, whose corners are vertices.

    Parameters
    ----------
    n : int, optional
        Cells along each edge of the cube; even.
    radius : float, optional
        Of the sphere.

    Returns
    -------
    TriSurface
        Of 12 n^2 triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Notes
    -----
    The lines of the grid are great circles at equal angles (an equiangular cubed sphere: Ronchi,
    Iacono and Paolucci 1996).

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import cube_sphere
    >>> surface = cube_sphere(n=4, radius=np.sqrt(3))
    >>> surface.n_faces
    192
    >>> surface.position(surface.closest_point([1, 1, 1])).round(9).tolist()  # a corner of the cube
    [1.0, 1.0, 1.0]
    """
    n = whole("n", n, 2, 2)
    affordable(6.0 * n * n)
    odd = 2 * np.arange(n + 1) - n
    x, y = (a.reshape(-1) for a in np.meshgrid(odd, odd))
    face = np.column_stack([x, y, np.full_like(x, n)])
    turns = [np.roll(np.eye(3, dtype=int), k, axis=1) for k in range(3)]
    turns += [turn * [[-1], [1], [-1]] for turn in turns]
    places = np.concatenate([face @ turn for turn in turns])
    faces = np.concatenate([grid(n, n) + k * len(face) for k in range(6)])
    places, number = np.unique(places, axis=0, return_inverse=True)
    # equal angles along the cube's edges; odd in the place, so that mirror images match exactly
    angle = np.sign(places) * (np.abs(places) * (0.25 * math.pi / n))
    on_cube = np.where(np.abs(places) == n, np.sign(places), np.tan(angle))
    squares = np.sort(on_cube**2, axis=1)
    length = np.sqrt(squares[:, 0] + squares[:, 1] + squares[:, 2])
    return TriSurface(
        positive("radius", radius) * on_cube / length[:, None], number.reshape(-1)[faces]
    )


def ellipsoid(x: float = 1.5, y: float = 1.0, z: float = 0.75, subdivisions: int = 4) -> TriSurface:
    """Return an ellipsoid about the origin: the triangles of `sphere`, stretched.

    Parameters
    ----------
    x, y, z : float, optional
        Half axes.
    subdivisions : int, optional
        As of `sphere`.

    Returns
    -------
    TriSurface
        Of 20 * 4^subdivisions triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> from solvers.primitives import ellipsoid
    >>> ellipsoid(3.0, 2.0, 1.0, subdivisions=2).vertices.max(axis=0).round(9).tolist()
    [3.0, 2.0, 1.0]
    """
    vertices, faces = _icosphere(subdivisions)
    axes = [positive(name, value) for name, value in (("x", x), ("y", y), ("z", z))]
    return TriSurface(vertices * axes, faces)


def blob(waves: float = 0.3, subdivisions: int = 4) -> TriSurface:
    """Return a closed wavy surface: a sphere of radius 1 + waves * (a cubic of the direction).

    Parameters
    ----------
    waves : float, optional
        How wavy, from 0, the unit sphere, to 0.6.
    subdivisions : int, optional
        As of `sphere`.

    Returns
    -------
    TriSurface
        Of 20 * 4^subdivisions triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import blob, sphere
    >>> round_, wavy = blob(waves=0.0, subdivisions=2), blob(waves=0.3, subdivisions=2)
    >>> bool((round_.vertices == sphere(subdivisions=2).vertices).all())
    True
    >>> radius = np.linalg.norm(wavy.vertices, axis=1)
    >>> bool(radius.min() < 0.8 < 1.2 < radius.max())
    True
    """
    if not isinstance(waves, (int, float)) or not 0 <= waves <= 0.6:
        raise SurfaceError(f"waves must be a number from 0 to 0.6, not {waves!r}")
    vertices, faces = _icosphere(subdivisions)
    x, y, z = vertices.T
    height = x**3 - 3 * x * y**2 + 1.5 * z * (x**2 - y**2) - 0.8 * y * z
    return TriSurface((1 + waves * height)[:, None] * vertices, faces)


def cylinder(radius: float = 1.0, height: float = 2.0, n: int = 64) -> TriSurface:
    """Return an open cylinder about the z axis, its middle at the origin.

    Parameters
    ----------
    radius, height : float, optional
        Of the cylinder.
    n : int, optional
        Vertices on each circle.

    Returns
    -------
    TriSurface
        Of nearly equilateral triangles, with two boundary loops.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import cylinder
    >>> surface = cylinder(radius=1.0, height=2.0, n=48)
    >>> surface.euler_characteristic, [len(loop) for loop in surface.boundary_loops]
    (0, [48, 48])
    >>> round(surface.area / (2 * np.pi * 1.0 * 2.0), 2)
    1.0
    """
    n = whole("n", n, 3)
    radius, height = positive("radius", radius), positive("height", height)
    wanted = height / (math.sqrt(0.75) * 2 * math.pi * radius) * n
    affordable(wanted * n)
    rows = max(round(wanted), 1) + 1
    faces, angle = rings(n, rows)
    z = np.repeat(height * (np.arange(rows) / (rows - 1) - 0.5), n)
    vertices = np.column_stack([radius * np.cos(angle.ravel()), radius * np.sin(angle.ravel()), z])
    return TriSurface(vertices, faces)


def torus(major: float = 1.0, minor: float = 0.4, n: int = 72) -> TriSurface:
    """Return a torus about the z axis.

    Its triangles are nearly equilateral and similar, larger on the outside: a regular pattern in
    conformal coordinates.

    Parameters
    ----------
    major, minor : float, optional
        Radius of the tube's centre line, and of the tube.
    n : int, optional
        Vertices around the axis.

    Returns
    -------
    TriSurface
        Closed, of genus 1.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, minor is not below major, or there would be too many
        vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import torus
    >>> surface = torus(major=1.0, minor=0.4)
    >>> surface.genus, surface.euler_characteristic
    (1, 0)
    >>> round(surface.area / (4 * np.pi**2 * 1.0 * 0.4), 2)
    1.0
    """
    plane, faces = _torus_pattern(major, minor, n)
    return TriSurface(_on_torus(plane, major, minor), faces)


def torus_with_hole(
    major: float = 1.0, minor: float = 0.4, n: int = 72, hole: float = 0.35
) -> TriSurface:
    """Return a torus with one boundary: a round hole of about the given radius on the outside.

    Parameters
    ----------
    major, minor, n : float, float and int, optional
        As of `torus`.
    hole : float, optional
        Radius of the hole, about.

    Returns
    -------
    TriSurface
        Of genus 1, with one boundary loop.

    Raises
    ------
    SurfaceError
        As of `torus`, and if the hole does not fit.

    Examples
    --------
    >>> from solvers.primitives import torus_with_hole
    >>> surface = torus_with_hole(n=36)
    >>> surface.genus, len(surface.boundary_loops), surface.euler_characteristic
    (1, 1, -1)
    """
    plane, faces = _torus_pattern(major, minor, n)
    step = 2 * math.pi / n
    radius = positive("hole", hole) / (major + minor)
    reach = radius + 2.5 * step
    if reach > min(math.pi, -plane[0, 1]) - 2 * step:
        raise SurfaceError(f"a hole of radius {hole:g} does not fit on the torus")
    away = np.hypot(plane[:, 0] - math.pi, plane[:, 1])
    kept = (away[faces] > reach).all(axis=1)
    (rim,) = TriSurface(np.insert(plane, 2, 0, axis=1), faces[~kept], trusted=True).boundary_loops
    around = max(round(2 * math.pi * radius / step), 12)
    angle = -np.arange(around) * (2 * math.pi / around)
    circle = [math.pi, 0.0] + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    between = np.setdiff1d(faces[~kept], rim)
    between = between[away[between] > radius + 0.7 * step]
    points, patch = fill([plane[rim], circle], plane[between])
    place = np.concatenate([rim, len(plane) + np.arange(around), between])
    plane = np.concatenate([plane, circle])
    plane[place] = points
    used, corner = np.unique(np.concatenate([faces[kept], place[patch]]), return_inverse=True)
    # the hole faces the usual point of view
    turned = plane[used] - [0.75 * math.pi, 0.0]
    return TriSurface(_on_torus(turned, major, minor), corner.reshape(-1, 3))


def _icosphere(subdivisions: int) -> tuple[FloatArray, IntArray]:
    subdivisions = whole("subdivisions", subdivisions, 0)
    affordable(10.0 * 4.0 ** min(subdivisions, 99))
    golden = 0.5 + math.sqrt(1.25)
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    rectangle = np.column_stack([np.zeros(4), signs * [1, golden]])
    vertices = np.concatenate([np.roll(rectangle, k, axis=1) for k in range(3)])
    faces = ConvexHull(vertices).simplices.astype(np.int64)
    inward = np.linalg.det(vertices[faces]) < 0
    faces[inward] = faces[inward][:, ::-1]
    for _ in range(subdivisions):
        vertices, faces = subdivide(vertices, faces)
        vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    return vertices / np.linalg.norm(vertices, axis=1)[:, None], faces


def _torus_pattern(major: float, minor: float, n: int) -> tuple[FloatArray, IntArray]:
    """Return a triangular lattice in the torus' conformal coordinates (n, 2), and its faces."""
    n = whole("n", n, 3)
    if positive("minor", minor) >= positive("major", major):
        raise SurfaceError(f"minor radius {minor:g} is not below the major radius {major:g}")
    period = 2 * math.pi * minor / math.sqrt((major - minor) * (major + minor))
    rows = max(2 * round(0.5 * period / (math.sqrt(0.75) * 2 * math.pi / n)), 4)
    affordable(rows * n)
    faces, angle = rings(n, rows, closed=True)
    tube = np.repeat(period * (np.arange(rows) / rows - 0.5), n)
    return np.column_stack([angle.reshape(-1), tube]), faces


def _on_torus(plane: FloatArray, major: float, minor: float) -> FloatArray:
    """Return places on the torus of conformal coordinates: angle about the axis, and tube.

    The tube's coordinate is the integral of minor d(phi) / (major + minor cos(phi)).
    """
    along = np.tan(0.5 * plane[:, 1] * math.sqrt((major - minor) * (major + minor)) / minor)
    phi = 2 * np.arctan(math.sqrt((major + minor) / (major - minor)) * along)
    r = major + minor * np.cos(phi)
    return np.column_stack([r * np.cos(plane[:, 0]), r * np.sin(plane[:, 0]), minor * np.sin(phi)])
