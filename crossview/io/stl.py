"""Reader for STL; VTK's ends the process on files that are cut short."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from crossview.io.polygons import Polygons
from solvers.errors import CrossviewError
from solvers.surface import FloatArray

HEADER = 84
"""Bytes before the triangles of a binary file: 80 of text, 4 of their number."""

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""A triangle of a binary file."""

VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
"""A corner in a text file."""


def read_stl(path: Path) -> Polygons:
    """Read triangles from a binary or text STL file, each with three vertices of its own."""
    data = path.read_bytes()
    # many binary files begin with "solid" too: the size decides
    count = int.from_bytes(data[80:HEADER], "little") if len(data) >= HEADER else -1
    if count >= 0 and len(data) == HEADER + count * RECORD.itemsize:
        records = np.frombuffer(data, RECORD, count, HEADER)
        corners = records["corners"].astype(np.float64)
    elif data.lstrip()[:5].lower() == b"solid":
        corners = _text_corners(data, path)
    else:
        raise CrossviewError("the STL file is cut short or no STL file", str(path), "write it anew")
    return Polygons(corners.reshape(-1, 3), np.full(len(corners), 3), np.arange(3 * len(corners)))


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
