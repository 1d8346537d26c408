"""Quad meshes in files: every format read back by the libraries that others read it with."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv

import crossview
from crossview.export.meshes import WRITERS, boundary_edges, write_mesh
from crossview.io import read_surface
from solvers.errors import CrossviewError
from solvers.quads.quadmesh import QuadMesh
from tests.solvers.quads.quad_grids import GRIDS


@pytest.fixture(params=["annulus", "sphere", "square"])
def mesh(request: pytest.FixtureRequest) -> QuadMesh:
    return GRIDS[request.param]()


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".vtk", ".vtu", ".msh"])
def test_quads_come_back_as_they_are(mesh: QuadMesh, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"quads{suffix}"
    write_mesh(mesh, path)
    back = meshio.gmsh.read(path) if suffix == ".msh" else meshio.read(path)
    assert np.array_equal(back.points, mesh.vertices)
    assert np.array_equal(back.cells_dict["quad"], mesh.quads)
    assert {cells.type for cells in back.cells} <= {"quad", "line"}
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_a_mesh_with_an_inverted_quad_is_written_only_when_that_is_allowed(tmp_path: Path) -> None:
    mesh = GRIDS["square"]()
    vertices = mesh.vertices.copy()
    inner = np.flatnonzero(~mesh.on_boundary)[0]
    vertices[inner] = 1.5 * vertices.max(axis=0) - 0.5 * vertices.min(axis=0)
    spoiled, path = replace(mesh, vertices=vertices), tmp_path / "quads.obj"
    with pytest.raises(CrossviewError, match=r"not written: \d inverted faces? .*allow inverted"):
        crossview.write_mesh(spoiled, path)
    assert not path.exists()
    crossview.write_mesh(spoiled, path, allow_inverted=True)
    assert path.exists()


@pytest.mark.parametrize("suffix", WRITERS)
def test_written_meshes_are_surfaces_that_can_be_read(
    mesh: QuadMesh, tmp_path: Path, suffix: str
) -> None:
    path = tmp_path / f"quads{suffix}"
    write_mesh(mesh, path)
    raw = read_surface(path)
    assert raw.faces.shape == (2 * mesh.n_quads, 3)
    corners = raw.vertices[raw.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    first, second = (
        mesh.vertices[mesh.quads[:, i + 2]] - mesh.vertices[mesh.quads[:, i]] for i in (0, 1)
    )
    whole = np.cross(first, second)
    assert np.linalg.norm(normals, axis=1).sum() == pytest.approx(
        np.linalg.norm(whole, axis=1).sum(), rel=1e-2
    )


def test_vtk_says_what_is_at_vertices_and_quads(tmp_path: Path) -> None:
    mesh = GRIDS["annulus"]()
    write_mesh(mesh, tmp_path / "quads.vtk")
    grid = pv.read(tmp_path / "quads.vtk")
    assert grid.celltypes.tolist() == [pv.CellType.QUAD] * mesh.n_quads
    rim = grid.point_data["boundary"]
    assert sorted(set(rim)) == [0, 1, 2]
    radius = np.linalg.norm(grid.points, axis=1)
    assert radius[rim == 1] == pytest.approx(1.0, abs=1e-2)  # the longest boundary is the first
    assert radius[rim == 2] == pytest.approx(0.4, abs=1e-2)
    assert set(grid.point_data["valence"][rim == 0]) == {4}
    assert np.array_equal(grid.cell_data["scaled_jacobian"], mesh.scaled_jacobian)
    assert grid.cell_data["patch"].tolist() == mesh.patch.tolist()


def test_msh_names_each_boundary(tmp_path: Path) -> None:
    mesh = GRIDS["annulus"]()
    write_mesh(mesh, tmp_path / "quads.msh")
    back = meshio.gmsh.read(tmp_path / "quads.msh")
    dimension = {name: int(d) for name, (_, d) in back.field_data.items()}
    assert dimension == {"surface": 2, "boundary 1": 1, "boundary 2": 1}
    tagged = {
        block.type: tags
        for block, tags in zip(back.cells, back.cell_data["gmsh:physical"], strict=True)
    }
    assert set(tagged["quad"]) == {back.field_data["surface"][0]}
    for name, radius in (("boundary 1", 1.0), ("boundary 2", 0.4)):
        edges = back.cells_dict["line"][tagged["line"] == back.field_data[name][0]]
        # a closed polygon round the circle, the mesh on its left
        assert sorted(edges[:, 0]) == sorted(edges[:, 1])
        ends = back.points[edges]
        assert np.linalg.norm(ends, axis=2) == pytest.approx(radius, abs=1e-2)
        turned = np.cross(ends[:, 0], ends[:, 1])[:, 2]
        assert (np.sign(turned) == (1 if radius == 1.0 else -1)).all()


def test_a_closed_mesh_has_no_boundary(tmp_path: Path) -> None:
    mesh = GRIDS["sphere"]()
    assert len(boundary_edges(mesh)[0]) == 0
    write_mesh(mesh, tmp_path / "quads.msh")
    back = meshio.gmsh.read(tmp_path / "quads.msh")
    assert list(back.field_data) == ["surface"]
    assert [cells.type for cells in back.cells] == ["quad"]


@pytest.mark.parametrize("suffix", [".gltf", ".glb"])
def test_gltf_splits_quads_along_the_shorter_diagonal(tmp_path: Path, suffix: str) -> None:
    mesh = GRIDS["annulus"]()
    write_mesh(mesh, tmp_path / f"quads{suffix}")
    raw = read_surface(tmp_path / f"quads{suffix}")
    assert np.allclose(raw.vertices, mesh.vertices, atol=1e-6)  # single precision
    drawn = {
        frozenset(edge) for f in raw.faces.tolist() for edge in zip(f, [*f[1:], f[0]], strict=True)
    }
    q = mesh.quads
    lengths = [
        np.linalg.norm(mesh.vertices[q[:, i + 2]] - mesh.vertices[q[:, i]], axis=1) for i in (0, 1)
    ]
    clear = np.abs(lengths[0] - lengths[1]) > 1e-6
    for quad, first in zip(q[clear].tolist(), (lengths[0] < lengths[1])[clear], strict=True):
        assert (frozenset(quad[::2]) in drawn) == first
        assert (frozenset(quad[1::2]) in drawn) != first


def test_what_cannot_be_written_is_told_and_leaves_the_old_file(tmp_path: Path) -> None:
    mesh = GRIDS["square"]()
    with pytest.raises(CrossviewError, match=r'to "\.stl" files .*: use one of obj vtk vtu ply'):
        write_mesh(mesh, tmp_path / "quads.stl")
    (tmp_path / "file").write_text("mine")
    with pytest.raises(CrossviewError, match="cannot write, Not a directory"):
        write_mesh(mesh, tmp_path / "file" / "quads.obj")
    assert (tmp_path / "file").read_text() == "mine"


def test_gltf_is_what_its_specification_says(tmp_path: Path) -> None:
    mesh = GRIDS["square"]()
    write_mesh(mesh, tmp_path / "quads.gltf")
    document = json.loads((tmp_path / "quads.gltf").read_text())
    place = document["accessors"][0]
    assert np.allclose(place["min"], mesh.vertices.min(axis=0), atol=1e-6)
    assert np.allclose(place["max"], mesh.vertices.max(axis=0), atol=1e-6)
    views = document["bufferViews"]
    assert sum(view["byteLength"] for view in views) == document["buffers"][0]["byteLength"]
    assert views[1]["byteOffset"] % 4 == 0
