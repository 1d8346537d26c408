"""Surfaces made by functions: clean triangles, deterministic, with parameters."""

from __future__ import annotations

from collections.abc import Callable

from solvers.primitives.curved import (
    blob,
    cube_sphere,
    cylinder,
    ellipsoid,
    sphere,
    torus,
    torus_with_hole,
)
from solvers.primitives.flat import annulus, disk, l_shape, plate_with_holes, rectangle, square
from solvers.primitives.handles import genus
from solvers.primitives.polygons import planar
from solvers.surface.trisurface import TriSurface

BUILTIN: dict[str, Callable[..., TriSurface]] = {
    function.__name__: function
    for function in (
        square,
        rectangle,
        disk,
        annulus,
        l_shape,
        plate_with_holes,
        planar,
        sphere,
        cube_sphere,
        ellipsoid,
        blob,
        cylinder,
        torus,
        torus_with_hole,
        genus,
    )
}
"""The functions that make the built-in surfaces by name, as ``BUILTIN["torus"](n=36)`` does."""

__all__ = [
    "BUILTIN",
    "annulus",
    "blob",
    "cube_sphere",
    "cylinder",
    "disk",
    "ellipsoid",
    "genus",
    "l_shape",
    "planar",
    "plate_with_holes",
    "rectangle",
    "sphere",
    "square",
    "torus",
    "torus_with_hole",
]
