"""Surface files: read what is in them, whoever wrote them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from crossview.io.gltf import read_gltf
from crossview.io.msh import read_msh
from crossview.io.ply import read_ply
from crossview.io.polygons import Polygons
from crossview.io.regular_file import require_regular
from crossview.io.stl import read_stl
from crossview.io.text import read_obj, read_off
from crossview.io.vtk_files import read_vtk
from solvers.errors import CrossviewError, SurfaceError
from solvers.surface import FloatArray, IntArray

READERS: dict[str, Callable[[Path], Polygons]] = {
    ".obj": read_obj,
    ".ply": read_ply,
    ".stl": read_stl,
    ".off": read_off,
    ".vtk": read_vtk,
    ".vtp": read_vtk,
    ".vtu": read_vtk,
    ".gltf": read_gltf,
    ".glb": read_gltf,
    ".msh": read_msh,
}
"""The reader of each format, by the ending of its files."""

SUFFIXES = tuple(READERS)
"""The file name endings that can be read."""
FAR = 1e30
"""Size of coordinates that are read in a larger unit.

From the range of single precision, 3e38, in which scenes are drawn and some formats written.
"""

UNSHARED = {".stl", ".gltf", ".glb"}
"""Formats that store a vertex again for each triangle, or along seams."""


@dataclass(frozen=True)
class RawSurface:
    """What a file holds, before any repair.

    Attributes
    ----------
    vertices : (n, 3) float array
    faces : (m, 3) int array
    notes : tuple of str
        What reading changed or left out, in plain words.
    merge : bool
        Whether vertices at the same place are to be merged, because the format repeats them.
    """

    vertices: FloatArray
    faces: IntArray
    notes: tuple[str, ...] = ()
    merge: bool = False


def read_surface(path: str | Path) -> RawSurface:
    """Read a surface file; polygons are split into triangles.

    Parameters
    ----------
    path : str or Path
        The format follows from its ending, one of `SUFFIXES`.

    Raises
    ------
    CrossviewError
        When there is no such file, or it is none of these formats, malformed, or without faces.
    """
    path = Path(path)
    with _told_of(path):
        polygons = _read(path)
        faces, notes = polygons.triangles()
    if not len(faces):
        raise CrossviewError("the file holds no faces", str(path), "a surface needs triangles")
    return RawSurface(polygons.points, faces, notes, path.suffix.lower() in UNSHARED)


def read_polygons(path: str | Path) -> Polygons:
    """Read a surface file; polygons stay whole, however many corners they have.

    Parameters
    ----------
    path : str or Path
        The format follows from its ending, one of `SUFFIXES`.

    Raises
    ------
    CrossviewError
        When there is no such file, or it is none of these formats or malformed.
    """
    path = Path(path)
    with _told_of(path):
        return _read(path)


def _read(path: Path) -> Polygons:
    """What the reader of its ending finds in a file."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise CrossviewError(
            f'surfaces cannot be read from "{path.suffix}" files',
            str(path),
            f"use one of {' '.join(suffix[1:] for suffix in SUFFIXES)}",
        )
    if not require_regular(path):
        raise CrossviewError("the file is empty", str(path))
    return _in_reach(reader(path))


def _in_reach(polygons: Polygons) -> Polygons:
    """Return polygons in a larger unit, a power of ten, where most corners are beyond `FAR`.

    One that alone is far is told by its number later.
    """
    known = (polygons.corners >= 0) & (polygons.corners < len(polygons.points))
    used = np.abs(polygons.points[np.unique(polygons.corners[known])]).max(axis=1, initial=0.0)
    size = float(np.median(used)) if len(used) else 0.0
    if not FAR <= size < np.inf:
        return polygons
    exponent = int(np.floor(np.log10(size)))
    note = f"coordinates are in units of 1e{exponent}"
    points = polygons.points / 10.0**exponent
    return replace(polygons, points=points, notes=(*polygons.notes, note))


@contextmanager
def _told_of(path: Path) -> Iterator[None]:
    """Tell in one line what goes wrong while a file is read."""
    try:
        with np.errstate(all="ignore"):  # what is no number is told of the surface
            yield
    except SurfaceError as error:
        error.locate(str(path))
        raise
    except CrossviewError:
        raise
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise CrossviewError(f"cannot open the file: {reason}", str(path)) from error
    except MemoryError as error:
        raise CrossviewError("the file needs more memory than there is", str(path)) from error
    except (ValueError, OverflowError) as error:
        raise CrossviewError("malformed file", str(path), str(error)) from error
