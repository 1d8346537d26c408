"""Reader for Gmsh's MSH, formats 1.0 to 4.1: nodes and surface elements, nothing else."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from crossview.io.msh_elements import CORNERS, NODES, VOLUMES
from crossview.io.polygons import Polygons
from crossview.io.regular_file import unmarked
from crossview.io.words import Words
from solvers.errors import CrossviewError, counted
from solvers.surface import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Nodes:
    """Nodes by their numbers (n,), with coordinates (n, 3)."""

    numbers: IntArray
    points: FloatArray


@dataclass(frozen=True, eq=False)
class Block:
    """Elements of one type: the numbers of their nodes (m, k), corners first."""

    kind: int
    nodes: IntArray


class CutShort(ValueError):
    """A section ends before what it announces."""


def read_msh(path: Path) -> Polygons:
    """Read the nodes and the surface elements of a Gmsh file, in text or binary.

    Curved elements are taken as straight. An element that is listed again, as for each physical
    group it belongs to, is taken once.

    Raises
    ------
    CrossviewError
        The file is malformed, cut short, or of a version that is not known.
    """
    try:
        nodes, blocks = _sections(unmarked(path.read_bytes()))
        return _polygons(nodes, list(blocks))
    except CutShort:
        raise CrossviewError("the MSH file is cut short", str(path), "write it anew") from None
    except (ValueError, IndexError, KeyError, OverflowError) as error:
        reason = error.args[0] if type(error) is ValueError and error.args else "write it anew"
        raise CrossviewError("malformed MSH file", str(path), str(reason)) from error


def _sections(data: bytes) -> tuple[Nodes, Iterator[Block]]:
    """Return what a file of any version holds."""
    from crossview.io.msh_binary import Binary, elements_2, elements_4, nodes_2, nodes_4

    if re.search(rb"^\s*\$NOD\s*$", data[:4096], re.MULTILINE):
        return _nodes_by_line(_text(data, b"NOD", b"ENDNOD"), 1), _elements_1(
            _text(data, b"ELM", b"ENDELM")
        )
    head = re.search(rb"^\s*\$MeshFormat\s+(\d+(?:\.\d+)?)\s+([01])\s+(\d+)[ \t\r]*\n", data)
    if head is None:
        raise ValueError("it does not begin with $MeshFormat")
    version, binary, size = head[1].decode(), head[2] == b"1", int(head[3])
    major = version.partition(".")[0]
    if major not in ("2", "4"):
        raise ValueError(f"version {version} is not known")
    newer = major == "4" and version not in ("4", "4.0")
    if binary:
        order = "<" if data[head.end() : head.end() + 4] == b"\1\0\0\0" else ">"
        numbers = Binary(data, order, size if newer else 8)
        if major == "2":
            return nodes_2(numbers), elements_2(numbers)
        return nodes_4(numbers, newer), elements_4(numbers, newer)
    if major == "2":
        name = b"ParametricNodes" if b"$ParametricNodes" in data else b"Nodes"
        nodes = _nodes_by_line(_text(data, name), 1)
        return nodes, _elements_2(_text(data, b"Elements"))
    return _nodes_4(_text(data, b"Nodes"), newer), _elements_4(_text(data, b"Elements"))


def _text(data: bytes, name: bytes, end: bytes = b"") -> Words:
    """The words of a section in text."""
    end = end or b"End" + name
    found = re.search(rb"^\s*\$" + name + rb"\s*$(.*?)^\s*\$" + end + rb"\b", data, re.M | re.S)
    if found is None:
        raise CutShort
    words = Words.of(found[1])
    if not len(words.first):
        raise CutShort
    return words


def _announced(words: Words, line: int, count: int) -> IntArray:
    """The first numbers of a line that announces others."""
    return words.whole_numbers(np.array([line]), 0, np.array([count]))


def _lines(words: Words, first: int, count: int) -> IntArray:
    """The numbers of lines that must be there."""
    if count < 0 or first + count > len(words.first):
        raise CutShort
    return first + np.arange(count)


def _nodes_by_line(words: Words, first: int) -> Nodes:
    """Nodes of the versions 1 and 2: number, x, y, z in each line, perhaps parameters."""
    lines = _lines(words, first, int(_announced(words, 0, 1)[0]))
    ones = np.ones(len(lines), dtype=np.int64)
    return Nodes(words.whole_numbers(lines, 0, ones), words.numbers(lines, 1, 3))


def _elements_1(words: Words) -> Iterator[Block]:
    """Elements of version 1: number, type, two groups, count of nodes, nodes."""
    lines = _lines(words, 1, int(_announced(words, 0, 1)[0]))
    kinds = words.whole_numbers(lines, 1, np.ones(len(lines), dtype=np.int64))
    for kind in np.unique(kinds).tolist():
        yield _block(words, lines[kinds == kind], kind, 5)


def _elements_2(words: Words) -> Iterator[Block]:
    """Elements of version 2: number, type, count of tags, tags, nodes."""
    lines = _lines(words, 1, int(_announced(words, 0, 1)[0]))
    ones = np.ones(len(lines), dtype=np.int64)
    kinds, tags = words.whole_numbers(lines, 1, ones), words.whole_numbers(lines, 2, ones)
    for kind, count in np.unique(np.stack([kinds, tags]), axis=1).T.tolist():
        if count < 0:
            raise ValueError("an element has a negative number of tags")
        yield _block(words, lines[(kinds == kind) & (tags == count)], kind, 3 + count)


def _block(words: Words, lines: IntArray, kind: int, skipped: int) -> Block:
    """Elements of one type, the nodes after some other words of their lines."""
    count = CORNERS.get(kind, 0)  # nothing is read of others
    found = words.whole_numbers(lines, skipped, np.full(len(lines), count))
    return Block(kind, found.reshape(len(lines), count))


def _nodes_4(words: Words, newer: bool) -> Nodes:
    """Nodes of version 4, in blocks; since 4.1 the numbers come before the coordinates."""
    blocks = int(_announced(words, 0, 1)[0])
    numbers, points, line = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))], 1
    for _ in range(blocks):
        count = int(_announced(words, line, 4)[3])
        lines = _lines(words, line + 1, 2 * count if newer else count)
        ones = np.ones(count, dtype=np.int64)
        numbers.append(words.whole_numbers(lines[:count], 0, ones))
        points.append(words.numbers(lines[-count:], 0 if newer else 1, 3) if count else points[0])
        line += 1 + len(lines)
    return Nodes(np.concatenate(numbers), np.concatenate(points))


def _elements_4(words: Words) -> Iterator[Block]:
    """Elements of version 4, in blocks: number and nodes in each line."""
    line = 1
    for _ in range(int(_announced(words, 0, 1)[0])):
        kind, count = _announced(words, line, 4)[2:].tolist()
        yield _block(words, _lines(words, line + 1, count), kind, 1)
        line += 1 + count


def _polygons(nodes: Nodes, blocks: list[Block]) -> Polygons:
    """Corners of surface elements, numbered by the places of their nodes."""
    order = np.argsort(nodes.numbers, kind="stable")
    ranked = nodes.numbers[order]
    found, curved, again = [], 0, 0
    for size in (3, 4):
        these = [block for block in blocks if CORNERS.get(block.kind) == size]
        curved += sum(len(b.nodes) for b in these if NODES[b.kind] > size)
        names = np.concatenate([np.empty((0, size), np.int64), *(b.nodes[:, :size] for b in these)])
        first = np.sort(np.unique(names, axis=0, return_index=True)[1])
        again += len(names) - len(first)
        names = names[first]
        place = np.searchsorted(ranked, names)
        known = place < len(ranked)
        known[known] = ranked[place[known]] == names[known]
        if not known.all():
            raise ValueError(f"elements name the node {names[~known][0]}, which is not there")
        found.append(order[place])
    volumes = sum(len(block.nodes) for block in blocks if block.kind in VOLUMES)
    notes = [f"took {counted(curved, 'curved element')} as straight"] if curved else []
    notes += [f"left out {counted(again, 'element')} listed again"] if again else []
    notes += [f"left out {counted(volumes, 'volume element')}"] if volumes else []
    return Polygons.of_blocks(nodes.points, found, notes)
