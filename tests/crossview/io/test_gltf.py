"""glTF: what it may read, what it places, which triangles its primitives make."""

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from crossview.io import RawSurface, read_surface
from solvers.errors import CrossviewError

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], "<f4")


def scene(arrays: list[npt.NDArray[Any]], primitive: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A scene of one primitive; each array is a buffer, a view and an accessor."""
    codes = {"u1": 5121, "u2": 5123, "u4": 5125, "f4": 5126}
    uris = [base64.b64encode(array.tobytes()).decode() for array in arrays]
    return {
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [primitive]}],
        "nodes": [{"mesh": 0}],
        "buffers": [
            {"byteLength": array.nbytes, "uri": f"data:application/octet-stream;base64,{uri}"}
            for array, uri in zip(arrays, uris, strict=True)
        ],
        "bufferViews": [{"buffer": i, "byteLength": a.nbytes} for i, a in enumerate(arrays)],
        "accessors": [
            {
                "bufferView": i,
                "componentType": codes[array.dtype.str[1:]],
                "count": len(array),
                "type": "VEC3" if array.ndim == 2 else "SCALAR",
            }
            for i, array in enumerate(arrays)
        ],
        **more,
    }


def read(folder: Path, document: dict[str, Any]) -> RawSurface:
    path = folder / "scene.gltf"
    path.write_text(json.dumps(document))
    return read_surface(path)


def areas(raw: RawSurface) -> npt.NDArray[np.float64]:
    a, b, c = (raw.vertices[raw.faces[:, i]] for i in range(3))
    return np.asarray(np.cross(b - a, c - a)[:, 2] / 2)


@pytest.mark.parametrize(
    ("mode", "corners"), [(4, [0, 1, 2, 2, 1, 3]), (5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])]
)
def test_lists_strips_and_fans_make_the_same_square(
    mode: int, corners: list[int], tmp_path: Path
) -> None:
    indices = np.array(corners, "<u2")
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}
    assert areas(read(tmp_path, scene([SQUARE, indices], primitive))) == pytest.approx([0.5, 0.5])


def test_sparse_accessors_replace_positions(tmp_path: Path) -> None:
    arrays = [SQUARE, np.array([3], "u1"), np.array([(3, 3, 0)], "<f4")]
    document = scene(arrays, {"attributes": {"POSITION": 0}, "mode": 5})
    document["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 1, "componentType": 5121},
        "values": {"bufferView": 2},
    }
    assert areas(read(tmp_path, document)).sum() == pytest.approx(0.5 + 2.5)


def test_a_mirrored_mesh_keeps_its_outside(tmp_path: Path) -> None:
    document = scene([SQUARE], {"attributes": {"POSITION": 0}, "mode": 5})
    document["nodes"] = [{"mesh": 0, "scale": [-2, 1, 1]}]
    assert areas(read(tmp_path, document)) == pytest.approx([1, 1])


def test_nodes_are_placed_by_those_above_them(tmp_path: Path) -> None:
    turn = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    document = scene([SQUARE], {"attributes": {"POSITION": 0}, "mode": 5})
    document["nodes"] = [
        {"children": [1], "translation": [10, 0, 0]},
        {"mesh": 0, "rotation": turn},
    ]
    assert read(tmp_path, document).vertices[1] == pytest.approx([10, 1, 0])


@pytest.mark.parametrize(
    "uri", ["../other/x.bin", "%2e%2e/other/x.bin", "{absolute}", "file://{absolute}", "link/x.bin"]
)
def test_no_file_outside_the_folder_is_read(uri: str, tmp_path: Path) -> None:
    folder, other = tmp_path / "scene", tmp_path / "other"
    folder.mkdir()
    other.mkdir()
    (other / "x.bin").write_bytes(SQUARE.tobytes())
    (folder / "link").symlink_to(other)
    document = scene([SQUARE], {"attributes": {"POSITION": 0}, "mode": 5})
    document["buffers"][0]["uri"] = uri.format(absolute=other / "x.bin")
    with pytest.raises(CrossviewError, match="outside its folder"):
        read(folder, document)
    below = folder / "parts"
    below.mkdir()
    (below / "x.bin").write_bytes(SQUARE.tobytes())
    document["buffers"][0]["uri"] = "parts/x.bin"
    assert len(read(folder, document).faces) == 2


def test_extensions_are_notes_unless_triangles_need_them(tmp_path: Path) -> None:
    primitive = {"attributes": {"POSITION": 0}, "mode": 5}
    used = scene([SQUARE], primitive, extensionsUsed=["KHR_materials_specular", "ACME_fur"])
    assert read(tmp_path, used).notes == ("left aside the extension ACME_fur",)
    required = scene([SQUARE], primitive, extensionsRequired=["KHR_draco_mesh_compression"])
    with pytest.raises(CrossviewError, match="needs the extension KHR_draco"):
        read(tmp_path, required)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("bufferViews", 0, "buffer"), -1),
        (("bufferViews", 0, "byteLength"), 10**9),
        (("bufferViews", 0, "byteOffset"), 4),
        (("bufferViews", 0, "byteStride"), 4),
        (("accessors", 0, "bufferView"), -1),
        (("accessors", 0, "count"), 10**12),
        (("accessors", 0, "count"), "many"),
        (("accessors", 0, "componentType"), 7),
        (("buffers", 0, "byteLength"), -1),
        (("buffers", 0, "uri"), "data:text/plain,abc"),
        (("nodes", 0, "children"), [0]),
        (("nodes", 0, "mesh"), 5),
        (("nodes", 0, "matrix"), [1, 2]),
        (("meshes", 0, "primitives"), [{"attributes": {"POSITION": 0}, "mode": 99}]),
        (("meshes", 0, "primitives"), "none"),
        (("asset", "version"), "1.0"),
    ],
)
def test_a_wrong_number_is_refused(place: tuple[Any, ...], value: Any, tmp_path: Path) -> None:
    document: Any = scene([SQUARE], {"attributes": {"POSITION": 0}, "mode": 5})
    parent = document
    for key in place[:-1]:
        parent = parent[key]
    parent[place[-1]] = value
    with pytest.raises(CrossviewError, match=r"scene\.gltf"):
        read(tmp_path, document)
