"""Built-in planar surfaces, in the plane z = 0 with the normal upwards."""

from __future__ import annotations

import math

import numpy as np

from solvers.errors import SurfaceError
from solvers.primitives.checks import affordable, positive, whole
from solvers.primitives.lattices import grid, hexagon, rings
from solvers.primitives.polygons import planar
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface


def square(n: int = 32, size: float = 1.0) -> TriSurface:
    """Return a square about the origin, n by n cells of two triangles.

    The pattern has the square's symmetry.

    Parameters
    ----------
    n : int, optional
        Cells along each side; even.
    size : float, optional
        Length of the sides.

    Returns
    -------
    TriSurface
        Of 2 n^2 triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=2.0)
    >>> surface.n_vertices, surface.n_faces, surface.area
    (25, 32, 4.0)
    """
    return rectangle(size, size, n, n)


def rectangle(
    width: float = 2.0, height: float = 1.0, columns: int = 64, rows: int = 32
) -> TriSurface:
    """Return a rectangle about the origin, columns by rows cells of two triangles.

    Parameters
    ----------
    width, height : float, optional
        Of the rectangle, along x and y.
    columns, rows : int, optional
        Number of cells along x and y; even.

    Returns
    -------
    TriSurface
        Of 2 columns rows triangles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> from solvers.primitives import rectangle
    >>> surface = rectangle(width=3.0, height=1.0, columns=6, rows=2)
    >>> surface.n_faces, surface.area, surface.loop_length(surface.boundary_loops[0])
    (24, 3.0, 8.0)
    """
    columns, rows = whole("columns", columns, 2, 2), whole("rows", rows, 2, 2)
    affordable(columns * rows)
    x = positive("width", width) * (np.arange(columns + 1) / columns - 0.5)
    y = positive("height", height) * (np.arange(rows + 1) / rows - 0.5)
    grid_x, grid_y = np.meshgrid(x, y)
    return TriSurface(_raised(grid_x, grid_y), grid(columns, rows))


def disk(radius: float = 1.0, edge_length: float = 0.05) -> TriSurface:
    """Return a disk about the origin with six-fold symmetry.

    Parameters
    ----------
    radius : float, optional
        Of the disk.
    edge_length : float, optional
        Wanted length of the triangles' edges: the vertices lie on round(radius / edge_length)
        circles.

    Returns
    -------
    TriSurface
        Of 6 k^2 triangles, k the number of circles.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import disk
    >>> surface = disk(radius=1.0, edge_length=0.1)
    >>> surface.n_faces, len(surface.boundary_loops[0])
    (600, 60)
    >>> bool(np.isclose(surface.area, 30 * np.sin(2 * np.pi / 60)))  # a regular polygon
    True
    """
    radius = positive("radius", radius)
    wanted = radius / positive("edge_length", edge_length)
    affordable(3.0 * wanted * wanted)
    n = max(round(wanted), 1)
    faces, ring, angle = hexagon(n)
    r = radius * (ring / n)
    return TriSurface(_raised(r * np.cos(angle), r * np.sin(angle)), faces)


def annulus(inner: float = 0.4, outer: float = 1.0, n: int = 96) -> TriSurface:
    """Return an annulus about the origin, its vertices on circles of n vertices each.

    The circles' radii are a geometric sequence, so all triangles are nearly equilateral and
    similar. The pattern is the same after a turn by 2 pi / n.

    Parameters
    ----------
    inner, outer : float, optional
        Radii of the boundary circles.
    n : int, optional
        Vertices on each circle.

    Returns
    -------
    TriSurface
        With two boundary loops, the outer one first.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, inner is not below outer, or there would be too many
        vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import annulus
    >>> surface = annulus(inner=0.5, outer=1.0, n=48)
    >>> surface.euler_characteristic, [len(loop) for loop in surface.boundary_loops]
    (0, [48, 48])
    >>> outer, inner = (surface.loop_length(loop) for loop in surface.boundary_loops)
    >>> bool(np.isclose(outer / inner, 2.0))
    True
    """
    n = whole("n", n, 3)
    inner, outer = positive("inner", inner), positive("outer", outer)
    if inner >= outer:
        raise SurfaceError(f"inner radius {inner:g} is not below the outer radius {outer:g}")
    height = math.log(outer) - math.log(inner)
    rows = max(round(height / (math.sqrt(0.75) * 2 * math.pi / n)), 1) + 1
    affordable(rows * n)
    faces, angle = rings(n, rows)
    # from the outer circle inwards, for the normal to point upwards
    r = np.geomspace(outer, inner, rows)[:, None]
    return TriSurface(_raised(r * np.cos(angle), r * np.sin(angle)), faces)


def l_shape(size: float = 2.0, edge_length: float = 0.06) -> TriSurface:
    """Return a square without its upper right quarter: five corners of 90 degrees, one of 270.

    Parameters
    ----------
    size : float, optional
        Length of the square's sides.
    edge_length : float, optional
        Wanted length of the triangles' edges.

    Returns
    -------
    TriSurface
        About the origin, which is the corner of 270 degrees.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, or there would be too many vertices.

    Examples
    --------
    >>> from solvers.primitives import l_shape
    >>> from solvers.singularities import default_corners
    >>> surface = l_shape(size=2.0, edge_length=0.25)
    >>> round(surface.area, 9), sorted(default_corners(surface).values())
    (3.0, [-1, 1, 1, 1, 1, 1])
    """
    a = 0.5 * positive("size", size)
    corners = np.array([[-a, -a], [a, -a], [a, 0], [0, 0], [0, a], [-a, a]])
    return planar(corners, (), edge_length)


def plate_with_holes(
    holes: int = 2, radius: float = 0.4, spacing: float = 2.0, edge_length: float = 0.08
) -> TriSurface:
    """Return a rectangle with a row of round holes, one in the middle of each square of it.

    Parameters
    ----------
    holes : int, optional
        Number of holes.
    radius : float, optional
        Of each hole.
    spacing : float, optional
        Distance of the holes' centres, which is also the plate's height.
    edge_length : float, optional
        Wanted length of the triangles' edges.

    Returns
    -------
    TriSurface
        About the origin, with a boundary loop for each hole and one around.

    Raises
    ------
    SurfaceError
        If a parameter is not such a number, the holes do not fit, or there would be too many
        vertices.

    Examples
    --------
    >>> from solvers.primitives import plate_with_holes
    >>> surface = plate_with_holes(holes=2, edge_length=0.25)
    >>> surface.euler_characteristic, len(surface.boundary_loops)
    (-1, 3)
    """
    holes = whole("holes", holes, 1)
    radius, spacing = positive("radius", radius), positive("spacing", spacing)
    if radius >= 0.45 * spacing:
        raise SurfaceError(f"holes of radius {radius:g} do not fit at a spacing of {spacing:g}")
    half = 0.5 * holes * spacing
    corners = np.array([[-half, -1], [half, -1], [half, 1], [-half, 1]])
    corners[:, 1] *= 0.5 * spacing
    sides = 2 * math.pi * radius / positive("edge_length", edge_length)
    affordable(sides * sides)
    around = max(round(sides), 12)
    angle = np.arange(around) * (2 * math.pi / around)
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    centres = spacing * (np.arange(holes) - 0.5 * (holes - 1))
    return planar(corners, [circle + np.array([x, 0.0]) for x in centres], edge_length)


def _raised(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.column_stack([x.reshape(-1), y.reshape(-1), np.zeros(x.size)])
