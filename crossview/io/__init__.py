"""Surface files: read what is in them, whoever wrote them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from crossview.io.ply import read_ply
from crossview.io.polygons import Polygons
from crossview.io.stl import read_stl
from crossview.io.text import read_obj, read_off
from solvers.errors import CrossviewError
from solvers.surface import FloatArray, IntArray


def _from_libraries(name: str) -> Callable[[Path], Polygons]:
    """A function of `libraries`, imported when it is wanted: that takes a quarter of a second."""

    def read(path: Path) -> Polygons:
        from crossview.io import libraries

        reader: Callable[[Path], Polygons] = getattr(libraries, name)
        return reader(path)

    return read


READERS: dict[str, Callable[[Path], Polygons]] = {
    ".obj": read_obj,
    ".ply": read_ply,
    ".stl": read_stl,
    ".off": read_off,
    ".vtk": _from_libraries("read_vtk"),
    ".vtp": _from_libraries("read_vtp"),
    ".vtu": _from_libraries("read_vtu"),
    ".gltf": _from_libraries("read_gltf"),
    ".glb": _from_libraries("read_gltf"),
    ".msh": _from_libraries("read_msh"),
}
"""The reader of each format, by the ending of its files."""

SUFFIXES = tuple(READERS)
"""The file name endings that can be read."""
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
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise CrossviewError(
            f'surfaces cannot be read from "{path.suffix}" files',
            str(path),
            f"use one of {' '.join(suffix[1:] for suffix in SUFFIXES)}",
        )
    try:
        if path.stat().st_size == 0:
            raise CrossviewError("the file is empty", str(path))
        polygons = reader(path)
        faces, notes = polygons.triangles()
    except CrossviewError:
        raise
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise CrossviewError(f"cannot open the file: {reason}", str(path)) from error
    # a malformed file shows in the libraries as almost any exception
    except Exception as error:
        reason = str(error).strip().partition("\n")[0] or type(error).__name__
        raise CrossviewError("cannot read this file", str(path), reason) from error
    if not len(faces):
        raise CrossviewError("the file holds no faces", str(path), "a surface needs triangles")
    return RawSurface(polygons.points, faces, notes, path.suffix.lower() in UNSHARED)
