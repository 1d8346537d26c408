"""Reader for STL; VTK's ends the process on files that are cut short."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from crossview.io.polygons import Polygons
from crossview.io.regular_file import unmarked
from solvers.errors import CrossviewError, counted
from solvers.surface import FloatArray

HEADER = 84
"""Bytes before the triangles of a binary file: 80 of text, 4 of their number."""

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""A triangle of a binary file."""

VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
"""A corner in a text file."""


def read_stl(path: Path) -> Polygons:
    """Read triangles from a binary or text STL file, each with three vertices of its own.

    Many binary files begin with "solid" as those of text do: the size decides. Of a binary file
    with more bytes than its triangles need, or a wrong number of them, whole triangles are taken.
    """
    data = path.read_bytes()
    count = int.from_bytes(data[80:HEADER], "little") if len(data) >= HEADER else -1
    whole, over = divmod(max(len(data) - HEADER, 0), RECORD.itemsize)
    notes: tuple[str, ...] = ()
    exact = count == whole and not over
    if not exact and unmarked(data).lstrip()[:5].lower() == b"solid":
        corners = _text_corners(data, path)
    elif count < 0 or (over and count > whole) or not whole:
        raise CrossviewError("the STL file is cut short or no STL file", str(path), "write it anew")
    else:
        if over and count:  # something else follows the triangles
            after = len(data) - HEADER - count * RECORD.itemsize
            whole, notes = count, (f"left out {counted(after, 'byte')} at the end",)
        elif count != whole:
            notes = (f"took all {counted(whole, 'triangle')}, although {count} are announced",)
        corners = np.frombuffer(data, RECORD, whole, HEADER)["corners"].astype(np.float64)
    points = corners.reshape(-1, 3)
    return Polygons(points, np.full(len(corners), 3), np.arange(len(points)), notes)


def _text_corners(data: bytes, path: Path) -> FloatArray:
    found = VERTEX.findall(data)
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    whole = re.search(rb"\bendsolid\b", data, re.IGNORECASE) and len(found) == 3 * facets
    try:
        corners = np.array(found, dtype="S").astype(np.float64).reshape(-1, 3, 3)
    except ValueError:
        whole = None
    if not whole:
        raise CrossviewError("malformed STL file, or cut short", str(path), "write it anew")
    return corners
