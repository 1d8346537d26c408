"""OBJ and OFF files: read at once, by no call for each line, or the wrong line is named."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crossview.io.polygons import Polygons
from crossview.io.text import read_obj, read_off
from solvers.errors import CrossviewError

SIZES = st.lists(st.integers(3, 6), min_size=1, max_size=12)
POINTS = np.random.default_rng(0).normal(size=(20, 3))


def polygons(sizes: list[int]) -> list[list[int]]:
    return [[(7 * i + k) % 20 for k in range(size)] for i, size in enumerate(sizes)]


def obj(sizes: list[int], corner: Callable[[int], str], end: str = "\n") -> str:
    lines = ["# by hand: f 1 2 3", "mtllib a/b.mtl", ""]
    lines += [f"v {x!r} {y!r} {z!r} # and more" for x, y, z in POINTS.tolist()]
    lines += ["vn 0 0 1", " f " + " ".join(map(corner, range(3)))]
    lines += ["f " + " ".join(map(corner, face)) for face in polygons(sizes)]
    return end.join(lines)


def off(sizes: list[int], end: str = "\n") -> str:
    lines = ["OFF # by hand", f"{len(POINTS)} {len(sizes) + 1} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in POINTS.tolist()]
    lines += ["", "3 0 1 2  255 0 0"]
    lines += [" ".join(map(str, [len(face), *face])) for face in polygons(sizes)]
    return end.join(lines)


def same(found: Polygons, sizes: list[int]) -> None:
    assert (found.points == POINTS).all()
    assert found.sizes.tolist() == [3, *sizes]
    assert found.corners.tolist() == [0, 1, 2, *(v for face in polygons(sizes) for v in face)]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", " \t\n\n"], ids=["LF", "CRLF", "CR", "blank"])
@pytest.mark.parametrize(
    "corner",
    [
        lambda v: str(v + 1),
        lambda v: str(v - 20),
        lambda v: f"{v + 1}/{v + 7}/3",
        lambda v: f"{v + 1}//2",
    ],
    ids=["plain", "counted back", "with texture", "with normals"],
)
@given(sizes=SIZES)
def test_obj_files_come_as_they_stand(
    corner: Callable[[int], str], end: str, sizes: list[int], tmp_path_factory: Any
) -> None:
    path = tmp_path_factory.mktemp("obj") / "x.obj"
    path.write_bytes(obj(sizes, corner, end).encode())
    same(read_obj(path), sizes)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", " # end\n\n"])
@given(sizes=SIZES)
def test_off_files_come_as_they_stand(end: str, sizes: list[int], tmp_path_factory: Any) -> None:
    path = tmp_path_factory.mktemp("off") / "x.off"
    path.write_bytes(off(sizes, end).encode())
    same(read_off(path), sizes)


@pytest.mark.parametrize(
    ("wrong", "line"),
    [
        ("v 0 0", 1), ("v 0 0 zero", 1), ("v 1/2 0 0", 1), ("f 1 2", 1), ("f 1 2 0", 1),
        ("f 1 2 3.5", 1), ("f 1 2 x", 1), ("v 0 0 " + 200 * "x", 1), ("\n\nf 1 2", 3),
    ],
)  # fmt: skip
def test_a_wrong_line_of_an_obj_file_is_named(wrong: str, line: int, tmp_path: Path) -> None:
    path = tmp_path / "x.obj"
    path.write_text(f"{wrong}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(CrossviewError, match=f"malformed OBJ file.*line {line}\\b"):
        read_obj(path)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("OFF", "FFO", "line 1"),
        ("3 0 1 2", "3 0 1", "line 7"),
        ("3 0 1 2", "2 0 1", "line 7"),
        ("3 0 1 2", "3 0 1 2.5", "line 7"),
        ("3 0 1 2", "3/1 0 1 2", "line 7"),
        ("0 1 0", "0 one 0", "line 6"),
        ("4 2 0", "4 -2 0", "malformed"),
        ("4 2 0", "4 3 0", "too early"),
        ("4 2 0", "four", "line 2"),
    ],
)
def test_a_wrong_line_of_an_off_file_is_named(
    old: str, new: str, said: str, tmp_path: Path
) -> None:
    path = tmp_path / "x.off"
    text = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(CrossviewError, match=said):
        read_off(path)


@pytest.mark.parametrize(
    ("read", "text"), [(read_obj, lambda s: obj(s, lambda v: str(v + 1))), (read_off, off)]
)
def test_no_function_is_called_for_each_line(
    read: Callable[[Path], Polygons], text: Callable[[list[int]], str], tmp_path: Path
) -> None:
    path = tmp_path / "x"
    calls: list[str] = []

    def calls_for(sizes: list[int]) -> int:
        path.write_text(text(sizes))
        calls.clear()

        def count(frame: FrameType, event: str, _: Any) -> None:
            calls.append(event)

        sys.setprofile(count)
        try:
            read(path)
        finally:
            sys.setprofile(None)
        return len(calls)

    calls_for([3, 4])
    assert calls_for([3, 4] * 1000) <= calls_for([3, 4] * 10) + 10
