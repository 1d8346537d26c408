"""Readers for OBJ and OFF: the libraries split vertices at seams, or take triangles only.

Files are read at once; those that cannot be are read line by line, which names the line that is
wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from crossview.io.polygons import Polygons
from crossview.io.words import Words
from solvers.errors import CrossviewError

KINDS = (b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF")
"""First words of OFF files in text form."""


def read_obj(path: Path) -> Polygons:
    """Read vertices and faces of a Wavefront OBJ file; texture and normals play no part."""
    try:
        words = Words.of(path.read_bytes(), slashed=b"f")
        vertices, faces = words.starting(b"v"), words.starting(b"f")
        sizes = words.count[faces] - 1
        points = words.numbers(vertices, 1, 3)
        corners = words.whole_numbers(faces, 1, sizes)
        if (sizes < 3).any() or not corners.all():
            raise ValueError
    except ValueError:
        return _read_obj_by_line(path)
    # negative numbers count back from the latest vertex
    known = np.repeat(np.searchsorted(vertices, faces), sizes)
    return Polygons(points, sizes, np.where(corners > 0, corners - 1, known + corners))


def read_off(path: Path) -> Polygons:
    """Read an OFF file in text form, also with colours, normals or texture (COFF, NOFF, STOFF)."""
    try:
        words = Words.of(path.read_bytes())
        line = 1 if words.count[:1].tolist() == [1] else 0
        head = words.whole_numbers(np.array([line]), 1 - line, np.array([2]))
        n_points, n_faces = head.tolist()
        first = line + 1
        whole = min(n_points, n_faces) >= 0 and len(words.first) >= first + n_points + n_faces
        if words.text[0].upper() not in KINDS or not whole:
            raise ValueError
        points = words.numbers(first + np.arange(n_points), 0, 3)
        faces = first + n_points + np.arange(n_faces)
        sizes = words.whole_numbers(faces, 0, np.ones(n_faces, dtype=np.int64))
        corners = words.whole_numbers(faces, 1, sizes)
        if (sizes < 3).any():
            raise ValueError
    except (ValueError, IndexError):
        return _read_off_by_line(path)
    return Polygons(points, sizes, corners)


def _read_obj_by_line(path: Path) -> Polygons:
    points: list[list[float]] = []
    sizes: list[int] = []
    corners: list[int] = []
    for number, words in _lines(path):
        try:
            if words[0] == "v":
                x, y, z = words[1:4]
                points.append([float(x), float(y), float(z)])
            elif words[0] == "f":
                face = [int(word.partition("/")[0]) for word in words[1:]]
                if len(face) < 3 or 0 in face:
                    raise ValueError
                # negative numbers count back from the latest vertex
                corners += [i - 1 if i > 0 else len(points) + i for i in face]
                sizes.append(len(face))
        except ValueError:
            raise _malformed("OBJ", path, number) from None
    return Polygons(
        np.array(points, dtype=np.float64).reshape(-1, 3), np.array(sizes), np.array(corners)
    )


def _read_off_by_line(path: Path) -> Polygons:
    lines = _lines(path)
    number, words = next(lines, (1, []))
    try:
        if words[0].upper().encode("latin-1") not in KINDS:
            raise ValueError
        if len(words) == 1:
            number, words = next(lines)
        else:
            words = words[1:]
        n_points, n_faces = int(words[0]), int(words[1])
        points = np.empty((n_points, 3))
        for i in range(n_points):
            number, words = next(lines)
            points[i] = [float(word) for word in words[:3]]
        sizes = np.empty(n_faces, dtype=np.int64)
        corners: list[int] = []
        for i in range(n_faces):
            number, words = next(lines)
            sizes[i] = int(words[0])
            face = [int(word) for word in words[1 : 1 + sizes[i]]]
            if len(face) != sizes[i] or len(face) < 3:
                raise ValueError
            corners += face
    except (ValueError, IndexError):
        raise _malformed("OFF", path, number) from None
    except StopIteration:
        raise CrossviewError("the OFF file ends too early", str(path), "write it anew") from None
    return Polygons(points, sizes, np.array(corners, dtype=np.int64))


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that is not empty, comments left out."""
    with path.open(encoding="latin-1") as file:
        continued: list[str] = []
        for number, line in enumerate(file, 1):
            words = continued + line.partition("#")[0].split()
            if words and words[-1] == "\\":
                continued = words[:-1]
                continue
            continued = []
            if words:
                yield number, words


def _malformed(kind: str, path: Path, number: int) -> CrossviewError:
    return CrossviewError(f"malformed {kind} file", f"{path}, line {number}", "mend that line")
