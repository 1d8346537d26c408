"""PLY files whose rows differ in length: read whole, by no call for each row, or refused."""

import struct
import sys
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crossview.io.ply import read_ply
from solvers.errors import CrossviewError
from solvers.surface.triangulation import IntArray

KINDS = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}


def polygons(sizes: list[int]) -> list[list[int]]:
    return [[(7 * i + k) % 50 for k in range(size)] for i, size in enumerate(sizes)]


def content(sizes: list[int], order: str) -> bytes:
    """Fifty vertices and polygons, each between a flag and texture coordinates."""
    points = np.random.default_rng(0).normal(size=(50, 3)).astype("f4")
    header = (
        f"ply\nformat {KINDS[order]} 1.0\nelement vertex 50\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(sizes)}\nproperty uchar flag\n"
        "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    ).encode()
    rows: list[tuple[Any, ...]] = [
        (9, len(face), *face, 2 * (i % 3), *[0.5] * (2 * (i % 3)))
        for i, face in enumerate(polygons(sizes))
    ]
    if not order:
        lines = [*points.tolist(), *rows]
        return header + "\n".join(" ".join(map(repr, line)) for line in lines).encode() + b"\n"
    packed = [struct.pack(f"{order}BB{row[1]}iB{row[2 + row[1]]}f", *row) for row in rows]
    return header + points.astype(order + "f4").tobytes() + b"".join(packed)


def corners(sizes: list[int]) -> IntArray:
    return np.concatenate([np.array(face, dtype=np.int64) for face in polygons(sizes)])


@pytest.mark.parametrize("order", KINDS)
@given(sizes=st.lists(st.integers(3, 9), min_size=1, max_size=40))
def test_polygons_of_any_sizes_come_in_the_order_of_the_file(
    order: str, sizes: list[int], tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("ply") / "x.ply"
    path.write_bytes(content(sizes, order))
    found = read_ply(path)
    assert found.points.shape == (50, 3)
    assert found.sizes.tolist() == sizes
    assert found.corners.tolist() == corners(sizes).tolist()


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("sizes", [[3, 4, 3, 5], [3, 3, 3, 3]])
def test_a_file_cut_short_anywhere_is_refused(order: str, sizes: list[int], tmp_path: Path) -> None:
    whole = content(sizes, order)
    path = tmp_path / "x.ply"
    for end in range(len(whole) - 1, 0, -7):
        path.write_bytes(whole[:end])
        with pytest.raises(CrossviewError, match="malformed PLY file, or cut short"):
            read_ply(path)


@pytest.mark.parametrize("change", ["face 4000000000", "face -1", "face 1.5", "face"])
def test_a_wrong_number_of_rows_is_refused(change: str, tmp_path: Path) -> None:
    path = tmp_path / "x.ply"
    path.write_bytes(content([3, 4], "<").replace(b"face 2", change.encode()))
    with pytest.raises(CrossviewError, match="malformed"):
        read_ply(path)


def test_corners_that_are_no_whole_numbers_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.ply"
    path.write_bytes(content([3, 4], "").replace(b"9 3 0 1 2", b"9 3 0 1 2.7"))
    with pytest.raises(CrossviewError, match="malformed"):
        read_ply(path)


@pytest.mark.parametrize("order", KINDS)
def test_no_function_is_called_for_each_row(order: str, tmp_path: Path) -> None:
    path = tmp_path / "x.ply"
    calls: list[str] = []
    read_ply(_written(path, [3, 4], order))  # imports once

    def calls_for(sizes: list[int]) -> int:
        _written(path, sizes, order)
        calls.clear()

        def count(frame: FrameType, event: str, _: Any) -> None:
            calls.append(event)

        sys.setprofile(count)
        try:
            read_ply(path)
        finally:
            sys.setprofile(None)
        return len(calls)

    assert calls_for([3, 4] * 1000) <= calls_for([3, 4] * 10) + 10


def _written(path: Path, sizes: list[int], order: str) -> Path:
    path.write_bytes(content(sizes, order))
    return path
