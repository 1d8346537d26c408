"""Readers for OBJ and OFF: the libraries split vertices at seams, or take triangles only.

Files are read at once; those that cannot be are read line by line, which names the line that is
wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from crossview.io.polygons import Polygons
from crossview.io.regular_file import unmarked
from crossview.io.words import Words
from solvers.errors import CrossviewError
from solvers.number_checks import EXACT

KINDS = (b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF")
"""First words of OFF files in text form."""


def read_obj(path: Path) -> Polygons:
    """Read vertices and faces of a Wavefront OBJ file; texture and normals play no part."""
    data = unmarked(path.read_bytes())
    try:
        words = Words.of(data, slashed=b"f")
        vertices, faces = words.starting(b"v"), words.starting(b"f")
        sizes = words.count[faces] - 1
        points = words.numbers(vertices, 1, 3)
        corners = words.whole_numbers(faces, 1, sizes)
        if (sizes < 3).any() or not corners.all():
            raise ValueError
    except ValueError:
        return _read_obj_by_line(data, path)
    # negative numbers count back from the latest vertex
    known = np.repeat(np.searchsorted(vertices, faces), sizes)
    return Polygons(points, sizes, np.where(corners > 0, corners - 1, known + corners))


def read_off(path: Path) -> Polygons:
    """Read an OFF file in text form, also with colours, normals or texture (COFF, NOFF, STOFF)."""
    data = unmarked(path.read_bytes())
    try:
        words = Words.of(data)
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
        return _read_off_by_line(data, path)
    return Polygons(points, sizes, corners)


def _read_obj_by_line(data: bytes, path: Path) -> Polygons:
    points: list[list[float]] = []
    sizes: list[int] = []
    corners: list[int] = []
    for number, words in _lines(data):
        try:
            if words[0] == "v":
                x, y, z = words[1:4]
                points.append([float(x), float(y), float(z)])
            elif words[0] == "f":
                face = [_number(word.partition("/")[0]) for word in words[1:]]
                if len(face) < 3 or 0 in face:
                    raise ValueError
                # negative numbers count back from the latest vertex
                corners += [i - 1 if i > 0 else len(points) + i for i in face]
                sizes.append(len(face))
        except ValueError:
            raise _malformed("OBJ", path, number) from None
    return _polygons(points, sizes, corners)


def _read_off_by_line(data: bytes, path: Path) -> Polygons:
    lines = _lines(data)
    number, words = next(lines, (1, []))
    try:
        if words[0].upper().encode("latin-1") not in KINDS:
            raise ValueError
        if len(words) == 1:
            number, words = next(lines)
        else:
            words = words[1:]
        n_points, n_faces = _number(words[0]), _number(words[1])
        if min(n_points, n_faces) < 0:
            raise ValueError
        points: list[list[float]] = []
        for _ in range(n_points):
            number, words = next(lines)
            x, y, z = words[:3]
            points.append([float(x), float(y), float(z)])
        sizes: list[int] = []
        corners: list[int] = []
        for _ in range(n_faces):
            number, words = next(lines)
            size = _number(words[0])
            face = [_number(word) for word in words[1 : 1 + size]]
            if len(face) != size or size < 3:
                raise ValueError
            sizes.append(size)
            corners += face
    except (ValueError, IndexError):
        raise _malformed("OFF", path, number) from None
    except StopIteration:
        raise CrossviewError("the OFF file ends too early", str(path), "write it anew") from None
    return _polygons(points, sizes, corners)


def _polygons(points: list[list[float]], sizes: list[int], corners: list[int]) -> Polygons:
    return Polygons(
        np.array(points, dtype=np.float64).reshape(-1, 3),
        np.array(sizes, dtype=np.int64),
        np.array(corners, dtype=np.int64),
    )


def _number(word: str) -> int:
    """Return a whole number that an array holds, or raise ValueError."""
    number = int(word)
    if abs(number) > EXACT:
        raise ValueError
    return number


def _lines(data: bytes) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that is not empty, comments left out."""
    continued: list[str] = []
    for number, line in enumerate(data.splitlines(), 1):
        words = continued + line.decode("latin-1").partition("#")[0].split()
        if words and words[-1] == "\\":
            continued = words[:-1]
            continue
        continued = []
        if words:
            yield number, words


def _malformed(kind: str, path: Path, number: int) -> CrossviewError:
    return CrossviewError(f"malformed {kind} file", f"{path}, line {number}", "mend that line")
