"""Built-in planar surfaces, in the plane z = 0 with the normal upwards."""

from __future__ import annotations

import math

import numpy as np

from solvers.errors import SurfaceError
from solvers.primitives.checks import affordable, positive, whole
from solvers.primitives.lattices import grid, hexagon, rings
from solvers.primitives.planar import planar
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface


def square(n: int = 32, size: float = 1.0) -> TriSurface:
    """Return a square about the origin, n (even) by n cells of two triangles.

    The pattern has the square's symmetry.
    """
    return rectangle(size, size, n, n)


def rectangle(
    width: float = 2.0, height: float = 1.0, columns: int = 64, rows: int = 32
) -> TriSurface:
    """Return a rectangle about the origin, columns by rows (both even) cells of two triangles."""
    columns, rows = whole("columns", columns, 2, 2), whole("rows", rows, 2, 2)
    affordable(columns * rows)
    x = positive("width", width) * (np.arange(columns + 1) / columns - 0.5)
    y = positive("height", height) * (np.arange(rows + 1) / rows - 0.5)
    grid_x, grid_y = np.meshgrid(x, y)
    return TriSurface(_raised(grid_x, grid_y), grid(columns, rows))


def disk(radius: float = 1.0, edge_length: float = 0.05) -> TriSurface:
    """Return a disk about the origin with six-fold symmetry.

    Its vertices lie on circles round(radius / edge_length) in number.
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
    """Return a square without its upper right quarter: five corners of 90 degrees, one of 270."""
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
