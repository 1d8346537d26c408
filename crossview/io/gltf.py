"""Reader for glTF 2.0 and GLB: the triangles of a scene, placed as the scene places them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from crossview.io.gltf_buffers import Buffers, item, whole
from crossview.io.polygons import Polygons
from crossview.io.regular_file import unmarked
from solvers.errors import CrossviewError, counted
from solvers.surface import FloatArray, IntArray

TRIANGLES, STRIP, FAN = 4, 5, 6
"""Modes of primitives that make triangles; the lower ones are points and lines."""

HARMLESS = (
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "KHR_mesh_quantization",
)
"""How the names of extensions begin that leave the triangles as they are."""

MOST_PLACED = 20_000_000
"""Corners of a scene, which may place a mesh many times. Chosen: they take 1 GB."""


def read_gltf(path: Path) -> Polygons:
    """Read all triangles of the meshes of a glTF scene.

    Buffers are read from data URIs, from the chunk of a GLB file, and from files below the folder
    of the scene.

    Raises
    ------
    CrossviewError
        The file is malformed, needs an extension that changes the triangles, or names a file
        elsewhere.
    """
    try:
        document, chunk = _parts(path.read_bytes())
        version = str(document["asset"]["version"])
        if version.partition(".")[0] != "2":
            raise CrossviewError(f"glTF {version[:8]} is not read", str(path), "export as glTF 2.0")
        notes = _extensions(document, path)
        return _joined(document, Buffers(document, chunk, path), notes, path)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError) as error:
        reason = error.args[0] if type(error) is ValueError and error.args else "write it anew"
        raise CrossviewError("malformed glTF file", str(path), str(reason)) from error
    except RecursionError as error:
        raise CrossviewError("malformed glTF file", str(path), "nested too deeply") from error


def _parts(data: bytes) -> tuple[dict[str, Any], bytes | None]:
    """Return the JSON document and the binary chunk, if there is one."""
    text, chunk = data, None
    if data[:4] == b"glTF":
        length = int.from_bytes(data[8:12], "little")
        if int.from_bytes(data[4:8], "little") != 2 or length > len(data):
            raise ValueError("the GLB file is cut short or of another version")
        text, place = b"", 12
        while place + 8 <= length:
            size, kind = (
                int.from_bytes(data[place : place + 4], "little"),
                data[place + 4 : place + 8],
            )
            place += 8
            if size > length - place:
                raise ValueError("a chunk is cut short")
            if kind == b"JSON":
                text = data[place : place + size]
            elif kind == b"BIN\0" and chunk is None:
                chunk = data[place : place + size]
            place += size
    try:
        document = json.loads(unmarked(text).decode())
    except ValueError as error:
        raise ValueError("its JSON is damaged or cut short") from error
    if not isinstance(document, dict):
        raise ValueError("it is no JSON object")
    return document, chunk


def _extensions(document: dict[str, Any], path: Path) -> list[str]:
    """Refuse required extensions that change triangles; return notes on optional ones."""
    names: dict[str, list[str]] = {}
    for key in ("extensionsRequired", "extensionsUsed"):
        found = [str(name) for name in document.get(key, [])]
        names[key] = [name for name in found if not name.startswith(HARMLESS)]
    if names["extensionsRequired"]:
        raise CrossviewError(
            f"the scene needs the extension {names['extensionsRequired'][0]}",
            str(path),
            "export it without compression",
        )
    ignored = names["extensionsUsed"]
    return [f"left aside the extension {name}" for name in ignored[:3]]


def _joined(document: dict[str, Any], buffers: Buffers, notes: list[str], path: Path) -> Polygons:
    """All triangles of the scene as one list."""
    points, triangles, others, placed, skins, n_points = [], [], 0, 0, 0, 0
    made: dict[int, list[tuple[FloatArray, IntArray]]] = {}
    for mesh, matrix, skinned in _placed(document):
        if mesh not in made:
            made[mesh], left_out = _mesh(item(document["meshes"], mesh), buffers)
            others += left_out
        skins += skinned
        placed += len(made[mesh])
        for at, corners in made[mesh]:
            mirrored = np.linalg.det(matrix[:3, :3]) < 0
            triangles.append(n_points + (corners[:, ::-1] if mirrored else corners))
            points.append(at @ matrix[:3, :3].T + matrix[:3, 3])
            n_points += len(at)
            if max(n_points, placed) > MOST_PLACED:
                raise CrossviewError("the scene is too large", str(path), "export a part of it")
    if not points:
        raise CrossviewError("the file holds no mesh of triangles", str(path))
    if placed > 1:
        notes.append(f"joined {placed} meshes of the scene")
    if skins:
        notes.append(f"left aside {counted(skins, 'skin')}: meshes are taken at rest")
    if others:
        notes.append(f"left out {counted(others, 'primitive')} of lines or points")
    return Polygons.of_blocks(np.concatenate(points), [np.concatenate(triangles)], notes)


def _placed(document: dict[str, Any]) -> Iterator[tuple[int, FloatArray, bool]]:
    """Yield the meshes of the scene, the matrix that places each, and whether it has a skin."""
    nodes, scenes = document.get("nodes", []), document.get("scenes", [])
    if scenes:
        roots = item(scenes, document.get("scene", 0)).get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [number for number in range(len(nodes)) if number not in children]
    if not nodes:
        for number in range(len(document.get("meshes", []))):
            yield number, np.eye(4), False
    waiting = [(number, np.eye(4)) for number in reversed(roots)]
    seen = set()
    while waiting:
        number, above = waiting.pop()
        node = item(nodes, number)
        if number in seen:
            raise ValueError("a node is its own ancestor, or has two parents")
        seen.add(number)
        matrix = above @ _matrix(node)
        if "mesh" in node:
            yield whole(node["mesh"]), matrix, "skin" in node
        waiting += [(child, matrix) for child in reversed(node.get("children", []))]


def _matrix(node: dict[str, Any]) -> FloatArray:
    """The (4, 4) matrix of a node, given as such or by translation, rotation and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = (float(number) for number in node.get("rotation", (0, 0, 0, 1)))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), dtype=np.float64).reshape(3)
    matrix[:3, 3] = np.array(node.get("translation", (0, 0, 0)), dtype=np.float64).reshape(3)
    return matrix


def _mesh(mesh: dict[str, Any], buffers: Buffers) -> tuple[list[tuple[FloatArray, IntArray]], int]:
    """The points and triangles of each primitive of a mesh, and how many have no triangles."""
    parts, others = [], 0
    for primitive in mesh["primitives"]:
        mode = whole(primitive.get("mode", TRIANGLES))
        if mode > FAN:
            raise ValueError(f"a primitive has the unknown mode {mode}")
        if mode < TRIANGLES or "POSITION" not in primitive["attributes"]:
            others += 1
            continue
        points = buffers.points(primitive["attributes"]["POSITION"])
        if "indices" in primitive:
            corners = buffers.indices(primitive["indices"])
        else:
            corners = np.arange(len(points))
        if corners.size and corners.max() >= len(points):
            raise ValueError(f"triangles name vertices outside 0..{len(points) - 1}")
        parts.append((points, _triangles(corners, mode)))
    return parts, others


def _triangles(corners: IntArray, mode: int) -> IntArray:
    """The (k, 3) triangles of a list, a strip or a fan; those that join strips are left out."""
    if mode == TRIANGLES:
        if len(corners) % 3:
            raise ValueError("the corners of triangles are no multiple of 3")
        return corners.reshape(-1, 3)
    first = np.arange(max(len(corners) - 2, 0))
    if mode == FAN:
        return np.stack([corners[0 * first], corners[first + 1], corners[first + 2]], axis=1)
    odd = first % 2
    found = np.stack([corners[first], corners[first + 1 + odd], corners[first + 2 - odd]], axis=1)
    a, b, c = found.T
    return np.asarray(found[(a != b) & (b != c) & (c != a)])
