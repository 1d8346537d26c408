"""Reader for PLY; VTK's ends the process on files that are cut short."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order

from crossview.io.polygons import Polygons
from crossview.io.regular_file import unmarked
from solvers.errors import CrossviewError
from solvers.number_checks import real_numbers, whole_numbers
from solvers.surface import IntArray

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
"""NumPy's type for the names that PLY has for each."""

TYPES = {name: code for names, code in CODES.items() for name in names.split()}
"""The same by single names."""

ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
"""NumPy's sign for the order of bytes; none in text."""


@dataclass
class _Element:
    """A table of the file; a list property has a type for its length before that of its items."""

    name: str
    count: int
    properties: list[tuple[str, list[str]]] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class _Column:
    """A property of all rows: how many items each has, and the items row after row."""

    lengths: IntArray
    items: npt.NDArray[Any]


def read_ply(path: Path) -> Polygons:
    """Read vertices and faces of a PLY file, text or binary."""
    content = unmarked(path.read_bytes())
    none = np.empty(0, dtype=np.int64)
    points, faces = np.empty((0, 3)), _Column(none, none)
    try:
        order, elements, start = _header(content)
        data = _Binary(content[start:], order) if order else _as_binary(content[start:])
        place = 0
        for element in elements:
            starts, place = data.rows(element, place)
            columns = data.columns(element, starts)
            if element.name == "vertex":
                points = np.column_stack([columns[axis].items for axis in "xyz"])
            elif element.name == "face":
                faces = columns["vertex_index" if "vertex_index" in columns else "vertex_indices"]
        corners = whole_numbers("corners of faces", faces.items)
        points = real_numbers("coordinates", points)
    except (ValueError, KeyError, IndexError, CrossviewError):
        raise CrossviewError(
            "malformed PLY file, or cut short", str(path), "write it anew"
        ) from None
    return Polygons(points, faces.lengths, corners)


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


class _Binary:
    """The rows of the elements of a file, one after the other.

    Parameters
    ----------
    data : bytes
        What follows the header.
    order : str
        The byte order of numbers.
    kind : str, optional
        The type that all numbers have, whatever the header says.
    """

    def __init__(self, data: bytes, order: str, kind: str = "") -> None:
        self._data = data
        self._order = order
        self._kind = kind

    def rows(self, element: _Element, place: int) -> tuple[IntArray, int]:
        """Return where each row of an element starts, and where the next element does.

        Raises
        ------
        ValueError
            When the data end before.
        """
        count = element.count
        if not count:
            return np.empty(0, dtype=np.int64), place
        if count > len(self._data):
            raise ValueError
        row = int(self._ends(element, np.array([place]))[0]) - place
        starts = place + row * np.arange(count)
        ends = self._ends(element, starts)
        if (ends[:-1] != starts[1:]).any():  # not all rows are as long as the first
            starts = self._chain(element, place)[:count]
            ends = self._ends(element, starts)
        if len(starts) < count or ends[-1] > len(self._data):
            raise ValueError
        return starts, int(ends[-1])

    def columns(self, element: _Element, starts: IntArray) -> dict[str, _Column]:
        """Return the properties of rows that start at given places."""
        columns, at = {}, starts
        for name, types in element.properties:
            lengths, at = self._lengths(types, at)
            width = self._type(types[-1]).itemsize
            first = np.repeat(at - width * (np.cumsum(lengths) - lengths), lengths)
            items = self._numbers(types[-1])[first + width * np.arange(len(first))]
            columns[name] = _Column(lengths, items)
            at = at + width * lengths
        return columns

    def _chain(self, element: _Element, place: int) -> IntArray:
        """Return where rows start that may differ in length, as far as the data go.

        Each place is joined with the one where a row from it would end; the rows' own starts are
        what can be reached from the first.
        """
        unit = self._type(self._kind).itemsize if self._kind else 1
        places = np.arange(place, len(self._data) + 1, unit)
        last = len(places) - 1
        following = np.minimum((self._ends(element, places) - place) // unit, last)
        graph = csr_array(
            (np.ones(len(places), dtype=np.int8), following, np.arange(len(places) + 1)),
            shape=(len(places), len(places)),
        )
        reached = breadth_first_order(graph, 0, return_predecessors=False)
        return np.asarray(places[reached[reached < last]])

    def _ends(self, element: _Element, at: IntArray) -> IntArray:
        """Return where rows from given places end; beyond the data if they are cut short."""
        for _, types in element.properties:
            lengths, at = self._lengths(types, at)
            at = at + self._type(types[-1]).itemsize * lengths
        return at

    def _lengths(self, types: list[str], at: IntArray) -> tuple[IntArray, IntArray]:
        """Return how many items properties at given places have, and where those begin."""
        if len(types) == 1:
            return np.ones(len(at), dtype=np.int64), at
        numbers = self._numbers(types[0])
        inside = at < len(numbers)
        found = np.where(inside, numbers[np.where(inside, at, 0)], 0)
        whole = (found >= 0) & (found <= len(self._data)) & (found == np.rint(found))
        # What is no length makes a row that is cut short.
        lengths = np.where(whole, found, len(self._data)).astype(np.int64)
        return lengths, at + self._type(types[0]).itemsize

    def _type(self, kind: str) -> np.dtype[Any]:
        return np.dtype(self._order + (self._kind or kind))

    def _numbers(self, kind: str) -> npt.NDArray[Any]:
        """Return the numbers of a type that begin at each byte."""
        dtype = self._type(kind)
        count = max(len(self._data) - dtype.itemsize + 1, 0)
        return np.ndarray((count,), dtype, self._data, strides=(1,))


def _as_binary(text: bytes) -> _Binary:
    """Return the numbers of a text file as those of a binary one."""
    numbers = np.array(text.split(), dtype="S").astype("<f8")
    return _Binary(numbers.tobytes(), "<", "f8")
