"""Reader for PLY; VTK's ends the process on files that are cut short."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from crossview.io.polygons import Polygons
from solvers.errors import CrossviewError
from solvers.surface import FloatArray

CODES = {
    "char int8": "i1",
    "uchar uint8": "u1",
    "short int16": "i2",
    "ushort uint16": "u2",
    "int int32": "i4",
    "uint uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float float32": "f4",
    "double float64": "f8",
}
TYPES = {name: code for names, code in CODES.items() for name in names.split()}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


Fields = list[tuple[str, int]]
"""Type and length of each array that makes up a row."""


@dataclass
class _Element:
    """A table of the file; a list property has a type for its length before that of its items."""

    name: str
    count: int
    properties: list[tuple[str, list[str]]] = field(default_factory=list)


def read_ply(path: Path) -> Polygons:
    """Read vertices and faces of a PLY file, text or binary."""
    data = path.read_bytes()
    points, faces = np.empty((0, 3)), [np.empty((0, 3))]
    try:
        order, elements, start = _header(data)
        source = _Binary(data, start, order) if order else _Text(data[start:].split())
        for element in elements:
            blocks = _read(source, element)
            names = [name for name, _ in element.properties]
            if element.name == "vertex":
                points = np.column_stack([blocks[0][names.index(axis)] for axis in "xyz"])
            elif element.name == "face":
                column = names.index(
                    "vertex_index" if "vertex_index" in names else "vertex_indices"
                )
                faces = [block[column] for block in blocks]
    except (ValueError, KeyError, IndexError):
        raise CrossviewError(
            "malformed PLY file, or cut short", str(path), "write it anew"
        ) from None
    return Polygons.of_blocks(points.astype(np.float64), [face.astype(np.int64) for face in faces])


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """Return the byte order ("" for text), the elements and where the data begin."""
    end = data.index(b"end_header")
    lines = [line.split() for line in data[:end].decode("latin-1").splitlines()]
    elements: list[_Element] = []
    order = ""
    if lines[0] != ["ply"]:
        raise ValueError
    for words in lines[1:]:
        if words[:1] == ["format"]:
            order = ORDERS[words[1]]
        elif words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2])))
        elif words[:1] == ["property"]:
            types = words[2:4] if words[1] == "list" else words[1:2]
            elements[-1].properties.append((words[-1], [TYPES[name] for name in types]))
    return order, elements, data.index(b"\n", end) + 1


class _Text:
    """Words of a text file, read row by row."""

    def __init__(self, words: list[bytes]) -> None:
        self.words = words
        self.place = 0

    def rows(self, fields: Fields, count: int) -> list[FloatArray]:
        """Return the arrays (count, length) of the next rows."""
        ends = np.cumsum([length for _, length in fields])
        words = self.words[self.place : self.place + count * int(ends[-1])]
        self.place += len(words)
        table = np.array(words, dtype="S").astype(np.float64).reshape(count, ends[-1])
        return np.split(table, ends[:-1], axis=1)


class _Binary:
    """Bytes of a binary file, read row by row."""

    def __init__(self, data: bytes, place: int, order: str) -> None:
        self.data = data
        self.place = place
        self.order = order

    def rows(self, fields: Fields, count: int) -> list[npt.NDArray[Any]]:
        """Return the arrays (count, length) of the next rows."""
        row = np.dtype([(str(i), self.order + kind, (n,)) for i, (kind, n) in enumerate(fields)])
        table = np.frombuffer(self.data, row, count, self.place)
        self.place += count * row.itemsize
        return [table[str(i)] for i in range(len(fields))]


def _read(source: _Text | _Binary, element: _Element) -> list[list[npt.NDArray[Any]]]:
    """Return the columns of an element in blocks of rows whose lists are equally long."""
    if element.count == 0:
        return [[np.empty((0, 3)) for _ in element.properties]]
    start = source.place
    try:
        return [_columns(source, element, element.count)]
    except ValueError:  # not all rows are as long as the first
        source.place = start
        return [_columns(source, element, 1) for _ in range(element.count)]


def _columns(source: _Text | _Binary, element: _Element, count: int) -> list[npt.NDArray[Any]]:
    """Return the columns of the next rows.

    Raises
    ------
    ValueError
        When their lists differ in length, or the data end before.
    """
    start = source.place
    fields: Fields = []
    for _, types in element.properties:
        length = 1
        if len(types) == 2:
            length = int(source.rows([(types[0], 1)], 1)[0][0, 0])
            fields.append((types[0], 1))
        fields.append((types[-1], length))
        source.rows(fields[-1:], 1)
    source.place = start
    arrays = iter(source.rows(fields, count))
    columns = []
    for _, types in element.properties:
        if len(types) == 2:
            lengths = next(arrays)
            if (lengths != lengths[0]).any():
                raise ValueError
        columns.append(next(arrays))
    return columns
