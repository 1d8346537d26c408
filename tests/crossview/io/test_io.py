"""Reading surfaces: every format, its variants, and files that are not what they claim."""

import json
import os
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista as pv

from crossview.io import SUFFIXES, RawSurface, read_surface
from solvers.errors import CrossviewError
from solvers.primitives import sphere, torus
from solvers.repair.soup import repair
from solvers.surface.trisurface import TriSurface
from tests.real_surfaces import PATHS, REAL, Facts


@pytest.fixture
def ball() -> TriSurface:
    return sphere(1)


def mesh_of(surface: TriSurface) -> pv.PolyData:
    return pv.PolyData.from_regular_faces(surface.vertices, surface.faces)


def gltf(nodes: list[dict[str, Any]], surfaces: list[TriSurface]) -> tuple[dict[str, Any], bytes]:
    """A minimal glTF scene of triangle meshes in single precision."""
    buffer, views, accessors, meshes = b"", [], [], []
    for surface in surfaces:
        for array, kind, component in (
            (surface.vertices.astype("<f4"), "VEC3", 5126),
            (surface.faces.reshape(-1).astype("<u4"), "SCALAR", 5125),
        ):
            views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": array.nbytes})
            accessor = {"bufferView": len(views) - 1, "componentType": component, "type": kind}
            accessor["count"] = len(array)
            if kind == "VEC3":
                accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
            accessors.append(accessor)
            buffer += array.tobytes()
        primitive = {"attributes": {"POSITION": len(views) - 2}, "indices": len(views) - 1}
        meshes.append({"primitives": [primitive]})
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(buffer)}],
    }
    return document, buffer


def write_glb(path: Path, nodes: list[dict[str, Any]], surfaces: list[TriSurface]) -> None:
    document, buffer = gltf(nodes, surfaces)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def write_gltf(path: Path, nodes: list[dict[str, Any]], surfaces: list[TriSurface]) -> None:
    document, buffer = gltf(nodes, surfaces)
    document["buffers"][0]["uri"] = path.stem + ".bin"
    path.with_suffix(".bin").write_bytes(buffer)
    path.write_text(json.dumps(document))


def write_obj(path: Path, surface: TriSurface) -> None:
    lines = [f"v {x} {y} {z}" for x, y, z in surface.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (surface.faces + 1).tolist()]
    path.write_text("\n".join(lines))


def write_off(path: Path, surface: TriSurface) -> None:
    lines = ["OFF", f"{surface.n_vertices} {surface.n_faces} 0"]
    lines += [f"{x} {y} {z}" for x, y, z in surface.vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in surface.faces.tolist()]
    path.write_text("\n".join(lines))


def write_msh(version: str, *, binary: bool) -> Callable[[Path, TriSurface], None]:
    def write(path: Path, surface: TriSurface) -> None:
        mesh = meshio.Mesh(surface.vertices, [("triangle", surface.faces)])
        meshio.gmsh.write(path, mesh, version, binary=binary)

    return write


def save(**options: Any) -> Callable[[Path, TriSurface], None]:
    return lambda path, surface: mesh_of(surface).save(path, **options)


def save_grid(path: Path, surface: TriSurface) -> None:
    pv.UnstructuredGrid({pv.CellType.TRIANGLE: surface.faces}, surface.vertices).save(path)


FORMATS = {
    "obj": (".obj", write_obj),
    "off": (".off", write_off),
    "ply text": (".ply", save(binary=False)),
    "ply binary": (".ply", save(binary=True)),
    "stl text": (".stl", save(binary=False)),
    "stl binary": (".stl", save(binary=True)),
    "vtk text": (".vtk", save(binary=False)),
    "vtk binary": (".vtk", save(binary=True)),
    "vtp text": (".vtp", save(binary=False)),
    "vtp binary": (".vtp", save(binary=True)),
    "vtu": (".vtu", save_grid),
    "gltf": (".gltf", lambda path, surface: write_gltf(path, [{"mesh": 0}], [surface])),
    "glb": (".glb", lambda path, surface: write_glb(path, [{"mesh": 0}], [surface])),
    "msh 2.2 text": (".msh", write_msh("2.2", binary=False)),
    "msh 2.2 binary": (".msh", write_msh("2.2", binary=True)),
    "msh 4.0 text": (".msh", write_msh("4.0", binary=False)),
    "msh 4.0 binary": (".msh", write_msh("4.0", binary=True)),
    "msh 4.1 text": (".msh", write_msh("4.1", binary=False)),
    "msh 4.1 binary": (".msh", write_msh("4.1", binary=True)),
}


def test_every_format_is_written_here() -> None:
    assert {suffix for suffix, _ in FORMATS.values()} == set(SUFFIXES)


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_written_is_read_back(name: str, ball: TriSurface, tmp_path: Path) -> None:
    suffix, write = FORMATS[name]
    path = tmp_path / f"ball{suffix}"
    write(path, ball)
    raw = read_surface(path.rename(path.with_suffix(suffix.upper())))
    surface = repair(raw.vertices, raw.faces, merge=raw.merge).surface
    assert surface.n_vertices == ball.n_vertices
    corners = ball.vertices[ball.faces]
    assert surface.vertices[surface.faces] == pytest.approx(corners, abs=1e-6)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("damage", ["half", "quarter", "noise", "other"])
def test_damaged_files_are_refused_in_one_line(
    name: str, damage: str, ball: TriSurface, tmp_path: Path
) -> None:
    suffix, write = FORMATS[name]
    path = tmp_path / f"ball{suffix}"
    write(path, ball)
    data = path.read_bytes()
    noise = np.random.default_rng(0).integers(0, 256, 3000, dtype=np.uint8).tobytes()
    path.write_bytes(
        {
            "half": data[: len(data) // 2],
            "quarter": data[: len(data) // 4],
            "noise": noise,
            "other": b"hello world\n" * 30,
        }[damage]
    )
    if suffix == ".obj" and damage == "half":
        # an OBJ file has no end mark: what is there counts
        path.write_bytes(data[: data.index(b"f ")] + b"f 1 2 x\n")
    with pytest.raises(CrossviewError) as caught:
        read_surface(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_reading_damaged_files_is_silent(
    ball: TriSurface, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    for name in ("vtk text", "vtk binary", "vtp binary", "gltf", "msh 4.1 text"):
        suffix, write = FORMATS[name]
        path = tmp_path / f"ball{suffix}"
        write(path, ball)
        path.write_bytes(path.read_bytes()[:200])
        capfd.readouterr()
        with pytest.raises(CrossviewError):
            read_surface(path)
        assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", [name for name in FORMATS if name.startswith("msh")])
def test_msh_cut_short_by_a_byte_is_refused(
    name: str, ball: TriSurface, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "ball.msh"
    FORMATS[name][1](path, ball)
    path.write_bytes(path.read_bytes().rstrip()[:-1])
    capfd.readouterr()
    with pytest.raises(CrossviewError, match="cut short"):
        read_surface(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_missing_and_empty_files(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"x{suffix}"
    with pytest.raises(CrossviewError, match="no such file"):
        read_surface(path)
    path.touch()
    with pytest.raises(CrossviewError, match="the file is empty"):
        read_surface(path)


def test_a_folder_is_no_surface(tmp_path: Path) -> None:
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(CrossviewError, match="directory"):
        read_surface(tmp_path / "folder.obj")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_pipes_and_devices_are_no_surfaces(suffix: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / f"pipe{suffix}")
    (tmp_path / f"zero{suffix}").symlink_to("/dev/zero")
    for name in ("pipe", "zero"):
        with pytest.raises(CrossviewError, match="a pipe or a device"):
            read_surface(tmp_path / f"{name}{suffix}")


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply", ".gltf", ".msh"])
@pytest.mark.parametrize("coding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_changes_nothing(
    suffix: str, coding: str, ball: TriSurface, tmp_path: Path
) -> None:
    path = tmp_path / f"ball{suffix}"
    name = next(name for name, (ending, _) in FORMATS.items() if ending == suffix)
    FORMATS[name][1](path, ball)
    plain = read_surface(path)
    path.write_bytes(path.read_bytes().decode().encode(coding))
    marked = read_surface(path)
    assert np.array_equal(marked.vertices, plain.vertices)
    assert np.array_equal(marked.faces, plain.faces)


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply", ".msh"])
def test_numbers_of_400_digits_are_refused(suffix: str, ball: TriSurface, tmp_path: Path) -> None:
    path = tmp_path / f"ball{suffix}"
    name = next(name for name, (ending, _) in FORMATS.items() if ending == suffix)
    FORMATS[name][1](path, ball)
    words = path.read_bytes().rstrip().split(b"\n")
    at = -1 if not words[-1].startswith(b"$") else -2
    words[at] = words[at].rstrip().rpartition(b" ")[0] + b" " + b"1" * 400
    path.write_bytes(b"\n".join(words) + b"\n")
    with pytest.raises(CrossviewError, match="malformed") as caught:
        read_surface(path)
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize("name", ["x.step", "x"])
def test_unknown_endings_name_the_known_ones(name: str, tmp_path: Path) -> None:
    with pytest.raises(CrossviewError, match="obj ply stl"):
        read_surface(tmp_path / name)


class TestObj:
    def read(self, tmp_path: Path, text: str) -> RawSurface:
        path = tmp_path / "x.obj"
        path.write_text(text)
        return read_surface(path)

    def test_texture_and_normal_seams_do_not_split_vertices(self, tmp_path: Path) -> None:
        raw = self.read(
            tmp_path,
            """
            mtllib a.mtl
            v 0 0 0 1 0 0
            v 1 0 0
            v 1 1 0 # a comment
            v 0 1 0
            vt 0 0
            vt 1 1
            vn 0 0 1
            usemtl red
            s off
            f 1/1/1 2/2/1 3/1
            f 1//1 3/2/1 4
            """,
        )
        assert raw.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert raw.vertices.shape == (4, 3)
        assert not raw.merge

    def test_negative_numbers_count_back(self, tmp_path: Path) -> None:
        raw = self.read(
            tmp_path,
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 1 1 0\nf -3/1 -1/2 -2/1\n",
        )
        assert raw.faces.tolist() == [[0, 1, 2], [1, 3, 2]]

    def test_faces_may_come_before_the_vertices(self, tmp_path: Path) -> None:
        raw = self.read(tmp_path, "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n")
        assert repair(raw.vertices, raw.faces).surface.n_faces == 1

    def test_lines_may_be_continued(self, tmp_path: Path) -> None:
        assert len(self.read(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nf 1 2 \\\n3\n").faces) == 1

    def test_polygons_are_split_even_those_not_convex(self, tmp_path: Path) -> None:
        raw = self.read(
            tmp_path,
            "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nv 2 -3 0\nf 1 2 3 4 5\nf 1 6 2\n",
        )
        assert raw.notes == ("split 1 polygon of more than three corners into triangles",)
        surface = repair(raw.vertices, raw.faces).surface
        assert surface.n_faces == 4
        assert np.all(surface.face_normals[:, 2] == 1)
        assert surface.area == pytest.approx(16 - 6 + 6)

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("v 0 0\nf 1 1 1\n", "line 1"),
            ("v 0 0 0\nv 1 zero 0\n", "line 2"),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "line 4"),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4"),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 9\n", "polygons 0"),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"),
        ],
    )
    def test_bad_lines_are_named(self, tmp_path: Path, text: str, words: str) -> None:
        with pytest.raises(CrossviewError, match=words):
            self.read(tmp_path, text)


def test_off_variants_and_polygons(tmp_path: Path) -> None:
    path = tmp_path / "x.off"
    path.write_text(
        "COFF 4 1 0 # square\n\n0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 0 0 0\n0 1 0 9 9 9\n"
        "4 0 1 2 3 0.5 0.5 0.5\n"
    )
    raw = read_surface(path)
    assert repair(raw.vertices, raw.faces).surface.area == pytest.approx(1)


def test_binary_stl_with_more_bytes_than_triangles_or_a_wrong_count(
    tmp_path: Path, ball: TriSurface
) -> None:
    path = tmp_path / "x.stl"
    mesh_of(ball).save(path)
    data = path.read_bytes()
    path.write_bytes(data + b"and more")
    raw = read_surface(path)
    assert (len(raw.faces), raw.notes) == (ball.n_faces, ("left out 8 bytes at the end",))
    path.write_bytes(data[:80] + struct.pack("<I", 7) + data[84:])
    raw = read_surface(path)
    assert len(raw.faces) == ball.n_faces
    assert raw.notes == (f"took all {ball.n_faces} triangles, although 7 are announced",)


def test_binary_stl_that_begins_with_solid(tmp_path: Path, ball: TriSurface) -> None:
    path = tmp_path / "x.stl"
    mesh_of(ball).save(path)
    data = path.read_bytes()
    path.write_bytes(b"solid x".ljust(80) + data[80:])
    assert len(read_surface(path).faces) == ball.n_faces


PLY_SQUARE = """ply
format ascii 1.0
comment made by hand
element material 1
property list uchar float colours
element vertex 4
property double x
property double y
property uchar red
property double z
element face 2
property uchar flags
property list uchar int vertex_index
property list uchar float texcoord
end_header
3 0.1 0.2 0.3
0 0 255 0
1.0000000001 0 255 0
1 1 255 0
0 1 255 0
7 3 0 1 2 2 0.5 0.5
7 4 0 1 2 3 0
"""


def test_ply_with_other_elements_and_lists_of_mixed_length(tmp_path: Path) -> None:
    path = tmp_path / "x.ply"
    path.write_text(PLY_SQUARE)
    raw = read_surface(path)
    assert raw.vertices[1].tolist() == [1.0000000001, 0, 0]
    assert raw.faces[0].tolist() == [0, 1, 2]
    assert len(raw.faces) == 3


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_ply_of_both_byte_orders_with_mixed_polygons(order: str, tmp_path: Path) -> None:
    kind = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = (
        f"ply\nformat {kind} 1.0\nelement vertex 5\nproperty double x\nproperty double y\n"
        "property double z\nelement face 2\nproperty list uchar ushort vertex_indices\nend_header\n"
    )
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], order + "f8")
    faces = struct.pack(order + "B4HB3H", 4, 0, 1, 2, 3, 3, 1, 4, 2)
    path = tmp_path / "x.ply"
    path.write_bytes(header.encode() + points.tobytes() + faces)
    raw = read_surface(path)
    assert repair(raw.vertices, raw.faces).surface.area == pytest.approx(1.5)


def test_vtk_strips_lines_and_points(tmp_path: Path) -> None:
    path = tmp_path / "x.vtk"
    path.write_text(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
        "0 0 0 1 0 0 0 1 0 1 1 0\nLINES 1 3\n2 0 1\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n"
    )
    raw = read_surface(path)
    assert raw.notes == ("left out 1 line or point",)
    assert repair(raw.vertices, raw.faces).surface.area == pytest.approx(1)


def test_vtk_structured_grids_are_surfaces(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 2, 3))
    pv.StructuredGrid(x, y, 0 * x).save(tmp_path / "x.vtk")
    raw = read_surface(tmp_path / "x.vtk")
    assert repair(raw.vertices, raw.faces).surface.area == pytest.approx(2)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("vtk text", b"POLYGONS 81", b"POLYGONS 900000001"),
        ("vtk text", b"POINTS 42", b"POINTS 900000000000"),
        ("vtp text", b'NumberOfPoints="42"', b'NumberOfPoints="1000000000000"'),
        ("vtp text", b'NumberOfComponents="3"', b'NumberOfComponents="1000000000"'),
        ("vtu", b'NumberOfCells="80"', b'NumberOfCells="1000000000000"'),
    ],
)
def test_vtk_files_that_announce_too_much_end_nothing(
    name: str, old: bytes, new: bytes, ball: TriSurface, tmp_path: Path
) -> None:
    suffix, write = FORMATS[name]
    path = tmp_path / f"ball{suffix}"
    write(path, ball)
    data = path.read_bytes()
    assert old in data
    path.write_bytes(data.replace(old, new))
    with pytest.raises(CrossviewError, match="cannot read this file"):
        read_surface(path)


def test_vtk_volumes_give_their_outer_surface(tmp_path: Path) -> None:
    path = tmp_path / "x.vtk"
    pv.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid().save(path)
    raw = read_surface(path)
    assert raw.notes[0] == "took the outer surface of 27 cells"
    surface = repair(raw.vertices, raw.faces).surface
    assert surface.euler_characteristic == 2
    assert surface.area == pytest.approx(54)


def test_vtk_cells_that_name_missing_points_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.vtk"
    path.write_text(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
        "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 99\n"
    )
    with pytest.raises(CrossviewError, match=r"outside 0\.\.2"):
        read_surface(path)


def test_gltf_scenes_are_joined_as_placed(tmp_path: Path, ball: TriSurface) -> None:
    path = tmp_path / "x.glb"
    placed = {"mesh": 1, "translation": [5, 0, 0], "scale": [2, 2, 2]}
    write_glb(path, [{"mesh": 0}, placed], [ball, torus(n=12)])
    raw = read_surface(path)
    assert raw.notes == ("joined 2 meshes of the scene",)
    part = repair(raw.vertices, raw.faces, merge=raw.merge, component=0).surface
    assert part.n_faces == max(ball.n_faces, torus(n=12).n_faces)
    right = 5 + 2 * torus(n=12).vertices[:, 0].max()
    assert raw.vertices[:, 0].max() == pytest.approx(right, rel=1e-6)


def test_msh_with_quads_curved_triangles_and_volumes(tmp_path: Path) -> None:
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [0, 0, 1]]
    middles = [[1.5, 0, 0.1], [1.5, 0.5, 0], [1, 0.5, 0]]
    cells = [
        ("line", [[0, 1]]),
        ("quad", [[0, 1, 2, 3]]),
        ("triangle6", [[1, 4, 2, 6, 7, 8]]),
        ("tetra", [[0, 1, 2, 5]]),
    ]
    path = tmp_path / "x.msh"
    meshio.gmsh.write(path, meshio.Mesh(np.array(corners + middles), cells), "2.2", binary=False)
    raw = read_surface(path)
    assert "took 1 curved element as straight" in raw.notes
    assert "left out 1 volume element" in raw.notes
    assert repair(raw.vertices, raw.faces).surface.area == pytest.approx(1.5)


@pytest.mark.parametrize("name", REAL)
def test_real_surfaces(name: str) -> None:
    raw = read_surface(PATHS[name])
    surface = repair(raw.vertices, raw.faces, merge=raw.merge).surface
    counts = Facts(surface.n_vertices, surface.n_faces, surface.genus, len(surface.boundary_loops))
    assert counts == REAL[name]


@pytest.mark.parametrize("suffix", [".obj", ".off", ".vtk"])
def test_a_surface_beyond_all_scales_is_read_in_a_larger_unit(
    ball: TriSurface, tmp_path: Path, suffix: str
) -> None:
    large = 2e90 * ball.vertices
    path = tmp_path / f"ball{suffix}"
    meshio.write(path, meshio.Mesh(large, [("triangle", ball.faces)]))
    raw = read_surface(path)
    assert raw.notes == ("coordinates are in units of 1e90",)
    corners = 2.0 * ball.vertices[ball.faces]
    assert np.abs(raw.vertices[raw.faces] - corners).max() < 1e-12
    # one vertex astray is a mistake of the file and stays one
    astray = ball.vertices.copy()
    astray[3] *= 1e90
    meshio.write(path, meshio.Mesh(astray, [("triangle", ball.faces)]))
    raw = read_surface(path)
    assert raw.notes == ()
    assert (np.abs(raw.vertices).max(axis=1) > 10.0).sum() == 1
