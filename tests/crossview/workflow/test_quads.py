"""crossview solve --quads: the mesh that was asked for, or one line that says why there is none."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import product
from math import sqrt
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista as pv
from numpy.typing import NDArray
from PIL import Image

from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError
from solvers.primitives import BUILTIN
from tests.command_line import CaseFile, Crossview, refused

CUBE = [(tuple(s / sqrt(3) for s in signs), 3) for signs in product((-1, 1), repeat=3)]
ALWAYS = {
    "report.json",
    "surface.vtp",
    "crosses.vtp",
    "cut_graph.vtp",
    "singularities.vtp",
    "separatrices.vtp",
}
QUADS = {"layout.vtp", "quads.vtk", "quads.obj"}


@pytest.fixture
def meshed(crossview: Crossview, tmp_path: Path, case_file: CaseFile) -> Callable[..., Any]:
    """Mesh a case by command; return its report."""

    def mesh(
        surface: object, singularities: object = (), *arguments: object, **more: object
    ) -> Any:
        path = case_file(surface, singularities, **more)
        ran = crossview("solve", path, "-o", tmp_path / "out", "--quads", *arguments)
        assert ran.status == 0, ran.err
        assert {p.name for p in (tmp_path / "out").iterdir()} == ALWAYS | QUADS
        return json.loads((tmp_path / "out" / "report.json").read_text())

    return mesh


def test_the_cubes_eight_give_the_cubes_six_patches(
    meshed: Callable[..., Any], tmp_path: Path
) -> None:
    report = meshed({"builtin": "cube_sphere", "n": 16}, CUBE, "--target-quads", 600)
    layout, quads = report["layout"], report["quads"]
    assert (layout["patches"], layout["separatrices"], layout["conforming"]) == (6, 12, True)
    assert (layout["t_junctions"], layout["flips"]) == (0, 0)
    assert quads["irregular"] == {"3": 8}
    assert (quads["non_quads"], quads["inverted"], quads["euler_characteristic"]) == (0, 0, 2)
    assert quads["quads"] == quads["vertices"] - 2 == 600
    assert quads["min_scaled_jacobian"] > 0.8
    assert quads["mean_scaled_jacobian"] > 0.95
    assert quads["max_distance_to_surface"] < 1e-9
    assert {"layout", "quads"} <= set(report["seconds"])

    patches = pv.read(tmp_path / "out" / "layout.vtp")
    assert sorted(set(patches.cell_data["patch"])) == list(range(6))
    surface = pv.read(tmp_path / "out" / "surface.vtp")
    assert patches.area == pytest.approx(surface.area, rel=1e-2)
    curves = pv.read(tmp_path / "out" / "separatrices.vtp")
    assert curves.n_lines == 12
    assert set(curves.cell_data["valence"]) == {3}
    assert set(curves.cell_data["end"]) == {0}
    # each is an edge of the cube seen from the centre
    assert np.allclose(curves.compute_cell_sizes()["Length"], np.arccos(1 / 3), rtol=0.02)
    for name in ("quads.vtk", "quads.obj"):
        written = meshio.read(tmp_path / "out" / name)
        assert written.cells_dict["quad"].shape == (600, 4)
        assert len(written.points) == 602


def test_a_square_is_a_grid(meshed: Callable[..., Any]) -> None:
    report = meshed("square", (), "--edge-length", 0.1)
    quads = report["quads"]
    assert (quads["quads"], quads["vertices"]) == (100, 121)
    assert quads["irregular"] == {}
    assert quads["irregular_on_boundary"] == {"1": 4}
    assert quads["min_scaled_jacobian"] == pytest.approx(1)


@pytest.mark.parametrize(("name", "chi"), [("torus", 0), ("annulus", 0), ("cylinder", 0)])
def test_surfaces_without_singularities_have_regular_meshes(
    meshed: Callable[..., Any], name: str, chi: int
) -> None:
    report = meshed(name, (), "--target-quads", 1500)
    assert report["layout"]["separatrices"] == 0
    assert report["layout"]["conforming"]
    quads = report["quads"]
    assert (quads["irregular"], quads["irregular_on_boundary"]) == ({}, {})
    assert quads["euler_characteristic"] == chi
    assert quads["mean_scaled_jacobian"] > 0.95
    assert abs(quads["quads"] - 1500) < 150


def test_the_formats_of_the_quads_may_be_chosen(crossview: Crossview, tmp_path: Path) -> None:
    asked = ["solve", "square", "-o", tmp_path, "--quads", "--target-quads", "9"]
    assert crossview(*asked, "--formats", "msh,GLB, ply").status == 0
    written = {p.suffix for p in tmp_path.iterdir() if p.stem == "quads"}
    assert written == {".msh", ".glb", ".ply"}
    assert meshio.gmsh.read(tmp_path / "quads.msh").field_data["boundary 1"].tolist() == [1, 1]


def test_the_edge_length_is_that_on_the_surface(meshed: Callable[..., Any]) -> None:
    surface = BUILTIN["annulus"]()
    report = meshed("annulus", (), "--edge-length", 0.05, "--quiet")
    assert report["quads"]["quads"] == pytest.approx(surface.area / 0.05**2, rel=0.1)


def test_a_coarse_mesh_of_fewer_patches_keeps_its_singularities(
    crossview: Crossview, tmp_path: Path
) -> None:
    asked = ["solve", "closed-H", "-o", tmp_path / "out", "--quads", "--target-quads", 200]
    report = crossview(*asked, "--json").json
    quads = report["quads"]
    assert report["layout"]["t_junctions"] > 0
    assert report["layout"]["patches"] > quads["patches"]
    assert quads["irregular"] == {"3": 10, "6": 1}
    assert quads["euler_characteristic"] == 2
    assert quads["inverted"] == 0
    assert quads["wanted"] == 200
    assert quads["least_possible"] is None
    assert abs(quads["quads"] - 200) <= 10


def test_a_number_that_is_too_small_is_told_with_the_least_possible(
    crossview: Crossview, tmp_path: Path
) -> None:
    asked = ["solve", "sphere-cube", "-o", tmp_path / "out", "--quads", "--target-quads", 2]
    ran = crossview(*asked)
    assert "6 quads (2 wanted, about 6 is the least possible) in 6 patches" in ran.out
    quads = json.loads((tmp_path / "out" / "report.json").read_text())["quads"]
    assert (quads["quads"], quads["wanted"], quads["least_possible"]) == (6, 2, 6)


@pytest.mark.parametrize("name", ["sphere-cube", "sphere-anticube"])
def test_crosses_and_separatrices_are_written_as_they_fit(
    crossview: Crossview, tmp_path: Path, name: str
) -> None:
    """Nothing fixes the crosses' direction on a closed surface but what joins singularities."""
    out = tmp_path / "out"
    assert crossview("solve", name, "-o", out).status == 0
    layout = json.loads((out / "report.json").read_text())["layout"]
    assert (layout["separatrices"], layout["t_junctions"]) == (12, 0)
    surface = pv.read(out / "surface.vtp")
    for curve in range(12):
        points = pv.read(out / "separatrices.vtp").get_cell(curve).points
        middle = len(points) // 2
        way = points[middle] - points[middle - 1]
        face = surface.find_closest_cell(points[middle - 1 : middle + 1].mean(axis=0))
        cross = [surface.cell_data[axis][face] for axis in "uv"]
        along = np.abs(cross @ way).max() / np.linalg.norm(way)
        assert np.degrees(np.arccos(min(along, 1.0))) < 2


def test_sharp_edges_are_edges_of_quads(crossview: Crossview, tmp_path: Path) -> None:
    """A box: vertices slide along its edges and never over them."""
    box = pv.Box(level=9).triangulate().clean()
    box.save(tmp_path / "box.ply")
    asked = ["natural", tmp_path / "box.ply", "--features", "40", "-o", tmp_path / "box.json"]
    assert crossview(*asked).status == 0
    asked = ["solve", tmp_path / "box.json", "-o", tmp_path / "out", "--quads", "--json"]
    quads = crossview(*asked, "--target-quads", 600).json["quads"]
    assert quads["irregular"] == {"3": 8}
    mesh = pv.read(tmp_path / "out" / "quads.vtk").extract_surface(algorithm="dataset_surface")
    assert mesh.area == pytest.approx(box.area)  # no corner is cut off


def test_quads_along_very_sharp_edges_are_not_taken_for_turned_over(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / sqrt(3)
    triangles = corners[[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]]
    for _ in range(3):
        a, b, c = np.moveaxis(triangles, 1, 0)
        d, e, f = (a + b) / 2, (b + c) / 2, (c + a) / 2
        quarters = [(a, d, f), (d, b, e), (f, e, c), (d, e, f)]
        triangles = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])
    faces = np.arange(len(triangles) * 3).reshape(-1, 3)
    cells = [("triangle", faces)]
    meshio.write_points_cells(tmp_path / "tetrahedron.stl", triangles.reshape(-1, 3), cells)
    eight = [(tuple(place), 3) for place in [*corners, *-corners / 3]]
    path = case_file("tetrahedron.stl", eight, method="anisotropic")
    arguments = "--quads", "--target-quads", 800, "--features", 40, "--json"
    ran = crossview("solve", path, "-o", tmp_path / "out", *arguments)
    quads = json.loads(ran.out)["quads"]
    assert quads["inverted"] == 0
    assert quads["min_scaled_jacobian"] > 0.7


def test_features_that_are_missed_are_told(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    diagonal = [[[-0.25, -0.25, 0], [0.25, 0.25, 0]]]
    path = case_file("square", features={"curves": diagonal})
    ran = crossview("solve", path, "-o", tmp_path / "out", "--quads")
    refused(ran, tmp_path, "misses a feature curve, by up to 45 degrees", "anisotropic")


def test_without_quads_the_separatrices_are_told_all_the_same(
    crossview: Crossview, tmp_path: Path
) -> None:
    assert crossview("solve", "suboptimal-a", "-o", tmp_path / "out").status == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    layout = report["layout"]
    assert layout["misaligned_boundaries"] == 2
    assert layout["patches"] is layout["conforming"] is layout["flips"] is None
    assert "quads" not in report
    curves = pv.read(tmp_path / "out" / "separatrices.vtp")
    assert curves.n_lines == layout["separatrices"]
    own = np.count_nonzero(curves.cell_data["valence"] == 5)
    ends = np.count_nonzero(curves.cell_data["end"] == 0)
    assert own > 0
    # five leave each of eight singularities, one each of the four corners' sides at most
    assert own + ends >= 40
    assert layout["t_junctions"] == np.count_nonzero(curves.cell_data["end"] == 2)
    assert {p.name for p in (tmp_path / "out").iterdir()} == ALWAYS


MENDED_BY = ("(crossview make-valid)", "(--method anisotropic)")


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("suboptimal-a", ["misses 2 boundaries", *MENDED_BY]),
        ("suboptimal-b", ["not integrable", *MENDED_BY]),
        ("torus-35", ["No quadrangulation of a torus"]),
    ],
)
def test_fields_that_have_no_quads_are_refused(
    crossview: Crossview, tmp_path: Path, case: str | Path, said: list[str]
) -> None:
    ran = crossview("solve", case, "-o", tmp_path / "out", "--quads")
    refused(ran, tmp_path, *said)


def test_an_isotropic_field_that_misses_a_handle_is_refused(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    path = case_file(
        "torus", [((1.4, 0, 0), 3), ((-1.4, 0, 0), 3), ((0, 1.4, 0), 5), ((0, 0.6, 0), 5)]
    )
    ran = crossview("solve", path, "-o", tmp_path / "out", "--quads")
    refused(ran, tmp_path, "holonomy defect", *MENDED_BY)


def test_no_quads_are_tried_around_a_valence_1(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    path = case_file({"builtin": "disk", "edge_length": 0.1}, [((0, 0, 0), 1), ((0.5, 0, 0), 3)])
    ran = crossview("solve", path, "-o", tmp_path / "out", "--quads")
    refused(ran, tmp_path, "no quad closes around a valence 1 (singularity 1)", "valence 2 or more")


def test_quads_at_a_valence_2_are_flat_not_too_few(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    two = [((-0.3, 0, 0), 2), ((0.4, 0, 0), 2)]
    path = case_file({"builtin": "disk", "edge_length": 0.1}, two)
    ran = crossview("solve", path, "-o", tmp_path / "out", "--quads", "--target-quads", 200)
    assert ran.status == 0
    assert "2 have a corner of 180 degrees or more, as those around a valence 2 do" in ran.out
    assert "try more quads" not in ran.out


def test_of_all_components_the_one_that_misses_its_budget_is_named(
    crossview: Crossview, tmp_path: Path
) -> None:
    square, pentagon = BUILTIN["square"](n=16), BUILTIN["planar"](edge_length=0.3)
    points = np.concatenate([square.vertices, pentagon.vertices + [5, 0, 0]])
    faces = np.concatenate([square.faces, pentagon.faces + square.n_vertices])
    meshio.write_points_cells(tmp_path / "two.obj", points, [("triangle", faces)])
    ran = crossview("solve", tmp_path / "two.obj", "-o", tmp_path / "out", "--component", "all")
    refused(ran, tmp_path, "3 of 4 (component 1)")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--edge-length", 0.1], "--edge-length is about quads: add --quads"),
        (["--target-quads", 9], "--target-quads is about quads: add --quads"),
        (["--formats", "msh"], "--formats is about quads: add --quads"),
        (["--quads", "--formats", "msh,stl"], '".stl" files (quads.stl): use one of obj vtk'),
        (["--quads", "--formats", ""], 'to "" files'),
        (
            ["--quads", "--edge-length", 0.1, "--target-quads", 9],
            "both an edge length and a number",
        ),
        (["--quads", "--edge-length", "0"], "the edge length must be a positive number"),
        (["--quads", "--edge-length", "-1"], "the edge length must be a positive number, not -1"),
        (["--quads", "--edge-length", "nan"], "the edge length must be a positive number, not nan"),
        (["--quads", "--edge-length", "fine"], "--edge-length"),
        (["--max-size-ratio", 3], "--max-size-ratio is about quads: add --quads"),
        (["--quads", "--max-size-ratio", "1"], "the size ratio must be"),
        (["--quads", "--max-chord", "2"], "the chord error must be"),
        (
            ["--quads", "--target-quads=-5"],
            "must be a whole number, at least 1, not -5",
        ),
        (["--quads", "--target-quads", "many"], "--target-quads"),
        (["--quads", "--edge-length", "5"], "larger than the surface (5 on a surface of 1.41)"),
        (["--quads", "--edge-length", "1e-5"], "1e+10 quads are too many (edge length 1e-05)"),
        (["--quads", "--target-quads", "3000000"], "3e+06 quads are too many: at most 2,000,000"),
    ],
)
def test_wrong_options_are_refused(
    crossview: Crossview, tmp_path: Path, arguments: list[str], said: str
) -> None:
    refused(crossview("solve", "square", "-o", tmp_path / "out", *arguments), tmp_path, said)


def test_options_are_checked_wherever_they_come_from() -> None:
    with pytest.raises(CrossviewError, match="give one of them"):
        MeshOptions(edge_length=0.1, target_quads=10)
    assert MeshOptions().number_on(BUILTIN["square"]()) == 5000
    assert MeshOptions(edge_length=0.25).number_on(BUILTIN["square"]()) == 16


def test_layouts_and_quads_are_drawn(crossview: Crossview, tmp_path: Path) -> None:
    small = ["--size", "300x225", "--camera", "xy"]

    def drawn(name: str, *arguments: object) -> NDArray[np.float64]:
        path = tmp_path / name
        ran = crossview("render", "disk-4", "-o", path, *small, *arguments)
        assert ran.status == 0, ran.err
        return np.asarray(Image.open(path).convert("RGB"), dtype=float)

    fine = drawn("a.png", "--layers", "quads", "--target-quads", "800")
    coarse = drawn("b.png", "--layers", "quads", "--edge-length", "0.25")
    patches = drawn("c.png", "--layers", "layout")
    # edges are dark on light; there are more of them where quads are smaller
    dark = [np.count_nonzero(picture.max(axis=2) < 128) for picture in (fine, coarse)]
    assert dark[0] > 1.5 * dark[1] > 0
    colours = {tuple(c) for c in (patches[patches.min(axis=2) < 250] // 16).astype(int).tolist()}
    assert len(colours) >= 5  # of five patches


def test_what_cannot_be_drawn_is_told(crossview: Crossview, tmp_path: Path) -> None:
    asked = ["render", "suboptimal-a", "-o", tmp_path / "out" / "a.png"]
    refused(crossview(*asked, "--layers", "quads"), tmp_path, "misses 2 boundaries")
    refused(crossview(*asked, "--layers", "layout"), tmp_path, "misses 2 boundaries")
    refused(crossview(*asked, "--edge-length", "0.1"), tmp_path, "draw --layers quads")
