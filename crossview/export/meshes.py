"""Quad meshes as files: OBJ, VTK, PLY, GLTF and MSH."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable, Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pyvista as pv

from crossview.export.vtk_bytes import save_vtk
from crossview.io.staged_files import staged_file
from crossview.workflow.certification import inverted
from solvers.errors import CrossviewError
from solvers.quads import QuadMesh
from solvers.surface import FloatArray, IntArray

SINGLE, UNSIGNED, TRIANGLES = 5126, 5125, 4
"""Codes of glTF for 4-byte floats, 4-byte indices, and separate triangles."""
VERTEX_BUFFER, INDEX_BUFFER = 34962, 34963
"""From glTF 2.0: `ARRAY_BUFFER` and `ELEMENT_ARRAY_BUFFER` of WebGL."""


def check_kind(path: Path) -> None:
    """Refuse a file name that does not say which format is wanted.

    Raises
    ------
    CrossviewError
        It ends in none of `WRITERS`.
    """
    if path.suffix.lower() not in WRITERS:
        known = " ".join(suffix[1:] for suffix in WRITERS)
        raise CrossviewError(
            f'meshes cannot be written to "{path.suffix}" files', str(path), f"use one of {known}"
        )


def write_mesh(
    mesh: QuadMesh, path: str | Path, kept: Iterable[str] = (), *, allow_inverted: bool = False
) -> None:
    """Write a quad mesh whole or not at all; none with an inverted quad unless that is allowed.

    Parameters
    ----------
    mesh : QuadMesh
    path : path
        Its ending, one of `WRITERS`, says the format. OBJ and PLY hold vertices and quads. VTK and
        VTU add for each vertex its "valence" and the number of its "boundary" (0 inside), for each
        quad its "patch" and "scaled_jacobian". MSH 2.2 names the group of quads "surface" and the
        edges of each boundary "boundary 1", "boundary 2", ... GLTF and GLB know no quads: each is
        split along its shorter diagonal.
    kept : iterable of str
        Files that this one may not replace.
    allow_inverted : bool, optional
        Write the mesh although a quad is inverted.

    Raises
    ------
    CrossviewError
        The format is unknown, a quad is inverted, or the file cannot be written.
    """
    path = Path(path)
    check_kind(path)
    fault = None if allow_inverted else inverted(mesh)
    if fault is not None:
        raise CrossviewError(
            f"not written: {fault}", path.name, "try another number of quads, or allow inverted"
        )
    with staged_file(path, kept) as made:
        WRITERS[path.suffix.lower()](mesh, made)


def boundary_edges(mesh: QuadMesh) -> tuple[IntArray, IntArray]:
    """The edges (k, 2) with one quad, the mesh on their left, and the loop (k,) of each."""
    edges = np.stack([mesh.quads, np.roll(mesh.quads, -1, axis=1)], axis=2).reshape(-1, 2)
    _, where, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    alone = edges[np.sort(where[count == 1])]
    return alone, mesh.boundary_loop[alone[:, 0]]


def split(mesh: QuadMesh) -> IntArray:
    """Two triangles (2 q, 3) for each quad, along its shorter diagonal."""
    a, b, c, d = (mesh.vertices[mesh.quads[:, corner]] for corner in range(4))
    shorter = np.linalg.norm(c - a, axis=1) <= np.linalg.norm(d - b, axis=1)
    first = mesh.quads[:, [0, 1, 2, 0, 2, 3]]
    other = mesh.quads[:, [0, 1, 3, 1, 2, 3]]
    return np.where(shorter[:, None], first, other).reshape(-1, 3)


def _write_obj(mesh: QuadMesh, path: Path) -> None:
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write(f"# {_made(mesh)}\n")
        np.savetxt(file, mesh.vertices, "v %.17g %.17g %.17g")
        np.savetxt(file, mesh.quads + 1, "f %d %d %d %d")


def _write_vtk(mesh: QuadMesh, path: Path) -> None:
    grid = pv.UnstructuredGrid({pv.CellType.QUAD: mesh.quads}, mesh.vertices)
    # other readers of the format know no longer integers
    grid.point_data["valence"] = mesh.valence.astype(np.int32)
    grid.point_data["boundary"] = (mesh.boundary_loop + 1).astype(np.int32)
    grid.cell_data["patch"] = mesh.patch.astype(np.int32)
    grid.cell_data["scaled_jacobian"] = mesh.scaled_jacobian
    save_vtk(grid, path)


def _write_ply(mesh: QuadMesh, path: Path) -> None:
    header = (
        f"ply\nformat binary_little_endian 1.0\ncomment {_made(mesh)}\n"
        f"element vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.quads)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(mesh.quads), np.dtype([("n", "u1"), ("corners", "<i4", 4)]))
    faces["n"], faces["corners"] = 4, mesh.quads
    path.write_bytes(header.encode("ascii") + mesh.vertices.astype("<f8").tobytes() + bytes(faces))


def _write_msh(mesh: QuadMesh, path: Path) -> None:
    edges, loop = boundary_edges(mesh)
    loops = len(mesh.surface.boundary_loops)
    groups = [loop + 1, np.full(len(mesh.quads), loops + 1)]
    cells = [("line", edges), ("quad", mesh.quads)]
    if not len(edges):
        cells, groups = cells[1:], groups[1:]
    names = {f"boundary {i + 1}": np.array([i + 1, 1]) for i in range(loops)}
    tags = {"gmsh:physical": groups, "gmsh:geometrical": groups}
    written = meshio.Mesh(
        mesh.vertices,
        cells,
        cell_data=tags,
        field_data={**names, "surface": np.array([loops + 1, 2])},
    )
    # of Gmsh's formats the one that most simulations read, in text
    meshio.gmsh.write(path, written, "2.2", binary=False)


def _write_gltf(mesh: QuadMesh, path: Path) -> None:
    document, buffer = _gltf(mesh)
    data = base64.b64encode(buffer).decode("ascii")
    document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{data}"
    path.write_text(json.dumps(document), encoding="utf-8")


def _write_glb(mesh: QuadMesh, path: Path) -> None:
    document, buffer = _gltf(mesh)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def _gltf(mesh: QuadMesh) -> tuple[dict[str, Any], bytes]:
    """A glTF scene of one triangle mesh, and its buffer."""
    points: FloatArray = mesh.vertices.astype("<f4")
    corners = split(mesh).reshape(-1).astype("<u4")
    lowest, highest = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    place = {"bufferView": 0, "componentType": SINGLE, "count": len(points), "type": "VEC3"}
    index = {"bufferView": 1, "componentType": UNSIGNED, "count": len(corners), "type": "SCALAR"}
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "mode": TRIANGLES}
    document = {
        "asset": {"version": "2.0", "generator": f"crossview {version('crossview')}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [{**place, "min": lowest, "max": highest}, index],
        "bufferViews": [
            {"buffer": 0, "byteLength": points.nbytes, "target": VERTEX_BUFFER},
            {
                "buffer": 0,
                "byteOffset": points.nbytes,
                "byteLength": corners.nbytes,
                "target": INDEX_BUFFER,
            },
        ],
        "buffers": [{"byteLength": points.nbytes + corners.nbytes}],
    }
    return document, points.tobytes() + corners.tobytes()


def _made(mesh: QuadMesh) -> str:
    return (
        f"crossview {version('crossview')}: {len(mesh.vertices)} vertices, {len(mesh.quads)} quads"
    )


WRITERS: dict[str, Callable[[QuadMesh, Path], None]] = {
    ".obj": _write_obj,
    ".vtk": _write_vtk,
    ".vtu": _write_vtk,
    ".ply": _write_ply,
    ".gltf": _write_gltf,
    ".glb": _write_glb,
    ".msh": _write_msh,
}
"""Writer for each file name ending."""
