"""The binary sections of Gmsh's MSH files, versions 2 and 4."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from crossview.io.msh import Block, CutShort, Nodes
from crossview.io.msh_elements import NODES
from solvers.surface import IntArray


class Binary:
    """The bytes of a file, read one number after another.

    Parameters
    ----------
    data : bytes
        The file.
    order : str
        NumPy's sign for the order of bytes.
    size : int
        Bytes of the larger whole numbers.
    """

    def __init__(self, data: bytes, order: str, size: int) -> None:
        if size not in (4, 8):
            raise ValueError(f"its whole numbers have {size} bytes")
        self._data = data
        self._place = 0
        self.number = np.dtype(f"{order}i4")
        self.large = np.dtype(f"{order}i{size}")
        self.real = np.dtype(f"{order}f8")

    def open(self, *names: bytes) -> bytes:
        """Go to the first of some sections that is there, behind the line with its name."""
        pattern = rb"\n\$(" + b"|".join(names) + rb")[ \t\r]*\n"
        found = re.compile(pattern).search(self._data, self._place)
        if found is None:
            raise CutShort
        self._place = found.end()
        return found[1]

    def close(self, name: bytes) -> None:
        """Check that the section ends here."""
        if not re.compile(rb"\s*\$End" + name + rb"\b").match(self._data, self._place):
            raise CutShort

    def line(self) -> int:
        """Return the whole number that stands in a line of text."""
        end = self._data.find(b"\n", self._place)
        text, self._place = self._data[self._place : end], end + 1
        if end < 0 or len(text) > 20:
            raise CutShort
        return int(text)

    def take(self, dtype: npt.DTypeLike, count: int) -> npt.NDArray[Any]:
        """Return the next values of a type."""
        kind = np.dtype(dtype)
        if count < 0 or count * kind.itemsize > len(self._data) - self._place:
            raise CutShort
        found = np.frombuffer(self._data, kind, count, self._place)
        self._place += count * kind.itemsize
        return found

    def numbers(self, dtype: npt.DTypeLike, count: int) -> IntArray:
        """Return the next whole numbers."""
        return self.take(dtype, count).astype(np.int64)


def nodes_2(data: Binary) -> Nodes:
    """Read the nodes of version 2, perhaps with their parameters on curves and surfaces."""
    name = data.open(b"Nodes", b"ParametricNodes")
    count = data.line()
    if name == b"Nodes":
        rows = data.take([("number", data.number), ("at", data.real, 3)], count)
        data.close(name)
        return Nodes(rows["number"].astype(np.int64), rows["at"].astype(np.float64))
    numbers, points = [], []
    for _ in range(count):  # the length of each follows from its dimension
        row = data.take([("number", data.number), ("at", data.real, 3), ("on", data.number, 2)], 1)
        numbers.append(row["number"])
        points.append(row["at"])
        data.take(data.real, {1: 1, 2: 2}.get(int(row["on"][0, 0]), 0))
    data.close(name)
    return Nodes(
        np.concatenate([np.empty(0, np.int64), *numbers]).astype(np.int64),
        np.concatenate([np.empty((0, 3)), *points]).astype(np.float64),
    )


def elements_2(data: Binary) -> Iterator[Block]:
    """Read the elements of version 2: runs of one type and one number of tags."""
    data.open(b"Elements")
    left = data.line()
    while left > 0:
        kind, count, tags = data.numbers(data.number, 3).tolist()
        if count < 1 or tags < 0:
            raise ValueError("a run of elements is empty")
        width = 1 + tags + _nodes_of(kind)
        yield Block(
            kind, data.numbers(data.number, count * width).reshape(count, width)[:, 1 + tags :]
        )
        left -= count
    data.close(b"Elements")


def nodes_4(data: Binary, newer: bool) -> Nodes:
    """Read the nodes of version 4, in blocks; since 4.1 the numbers come before coordinates."""
    data.open(b"Nodes")
    blocks = int(data.numbers(data.large, 4 if newer else 2)[0])
    numbers, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
    for _ in range(blocks):
        head = data.numbers(data.number, 3).tolist()
        dimension = head[0] if newer else head[1]
        count = int(data.numbers(data.large, 1)[0])
        width = 3 + (min(max(dimension, 0), 3) if head[2] else 0)
        if newer:
            numbers.append(data.numbers(data.large, count))
            rows = data.take(data.real, count * width).reshape(count, width)
        else:
            found = data.take([("number", data.number), ("at", data.real, width)], count)
            numbers.append(found["number"].astype(np.int64))
            rows = found["at"]
        points.append(rows[:, :3].astype(np.float64))
    data.close(b"Nodes")
    return Nodes(np.concatenate(numbers), np.concatenate(points))


def elements_4(data: Binary, newer: bool) -> Iterator[Block]:
    """Read the elements of version 4, in blocks of one type."""
    data.open(b"Elements")
    blocks = int(data.numbers(data.large, 4 if newer else 2)[0])
    of_nodes = data.large if newer else data.number
    for _ in range(blocks):
        kind = int(data.numbers(data.number, 3)[2])
        count = int(data.numbers(data.large, 1)[0])
        width = 1 + _nodes_of(kind)
        yield Block(kind, data.numbers(of_nodes, count * width).reshape(count, width)[:, 1:])
    data.close(b"Elements")


def _nodes_of(kind: int) -> int:
    if kind not in NODES:
        raise ValueError(f"elements of the type {kind} are not known")
    return NODES[kind]
