"""crossview solve: the report tells what theory says, and ParaView's reader finds the fields."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import product
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from tests.command_line import CaseFile, Crossview

FILES = {
    "report.json",
    "surface.vtp",
    "crosses.vtp",
    "cut_graph.vtp",
    "singularities.vtp",
    "separatrices.vtp",
}
CUBE = [(tuple(s / sqrt(3) for s in signs), 3) for signs in product((-1, 1), repeat=3)]


def around(degrees: float, radius: float = 0.7) -> tuple[float, float, float]:
    """A point in the plane by its polar angle."""
    return (radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), 0.0)


@pytest.fixture
def solved(crossview: Crossview, tmp_path: Path, case_file: CaseFile) -> Callable[..., Any]:
    """Solve a case by command; return its report."""

    def solve(surface: object, singularities: object = (), **more: object) -> Any:
        path = case_file(surface, singularities, **more)
        ran = crossview("solve", path, "-o", tmp_path / "out")
        assert ran.status == 0, ran.err
        assert {p.name for p in (tmp_path / "out").iterdir()} == FILES
        return json.loads((tmp_path / "out" / "report.json").read_text())

    return solve


def test_sphere_with_the_cubes_eight(solved: Callable[..., Any], tmp_path: Path) -> None:
    report = solved({"builtin": "cube_sphere", "n": 12}, CUBE)
    assert report["index_sum"] == report["index_required"] == 8
    assert report["isotropically_valid"]
    assert report["holonomy"] == []
    assert report["max_closing_error"] < 1e-9
    assert report["residual"] < 1e-9
    surface = report["surface"]
    assert surface["vertices"] == 6 * 12**2 + 2
    assert (surface["euler_characteristic"], surface["genus"]) == (2, 0)
    assert surface["boundary_loops"] == 0
    assert report["solved_on"]["faces"] > surface["faces"]
    assert 0 < report["solved_on"]["min_triangle_quality"] < 1
    assert [(s["valence"], s["index"]) for s in report["singularities"]] == [(3, 1)] * 8
    given = np.array([position for position, _ in CUBE])
    assert np.allclose([s["position"] for s in report["singularities"]], given)
    assert report["method"] == "isotropic"
    assert report["notes"] == []
    assert {"read", "refine", "factor", "solve", "holonomy"} <= set(report["seconds"])


@pytest.mark.parametrize("degrees", [15.0, 90.0, 165.0])
def test_annulus_defect_is_the_closed_form(solved: Callable[..., Any], degrees: float) -> None:
    # r = wrap(sum of k_j phi_j / 4); phi_j the polar angles
    report = solved(
        {"builtin": "annulus", "n": 96},
        [(around(0), 3), (around(degrees), 5)],
        options={"refine": 0},
    )
    (condition,) = report["holonomy"]
    assert condition["kind"] == "boundary"
    assert abs(condition["defect_degrees"]) == pytest.approx(degrees / 4, abs=1e-3)
    assert not report["isotropically_valid"]
    # the one boundary is aligned, the other off by the defect
    misaligned = np.sort(np.abs(report["boundary_misalignment_degrees"]))
    assert misaligned == pytest.approx([0, degrees / 4], abs=1e-3)


def test_annulus_with_opposite_pairs_on_rays_is_valid(solved: Callable[..., Any]) -> None:
    placed = [(around(45 * i, r), v) for i in range(4) for r, v in ((0.6, 3), (0.8, 5))]
    report = solved("annulus", placed, options={"refine": 0})
    assert report["isotropically_valid"]
    assert np.abs(report["boundary_misalignment_degrees"]).max() < 0.01


def test_the_tolerance_decides(solved: Callable[..., Any]) -> None:
    placed = [(around(0), 3), (around(15), 5)]
    options = {"refine": 0, "tolerance_degrees": 4}
    report = solved("annulus", placed, options=options)
    assert report["tolerance_degrees"] == 4
    assert report["isotropically_valid"]


def test_torus_with_one_3_and_one_5_is_never_valid(solved: Callable[..., Any]) -> None:
    report = solved("torus", [((1.4, 0, 0), 3), ((-0.3, 1.1, 0.35), 5)])
    assert (report["index_sum"], report["index_required"]) == (0, 0)
    assert [c["kind"] for c in report["holonomy"]] == ["loop", "loop"]
    assert max(abs(c["defect_degrees"]) for c in report["holonomy"]) > 0.01
    assert all(-45 < c["defect_degrees"] <= 45 for c in report["holonomy"])
    assert not report["isotropically_valid"]
    # the field itself is consistent across every edge
    assert report["max_closing_error"] < 1e-9


def test_paraview_reads_the_fields(solved: Callable[..., Any], tmp_path: Path) -> None:
    report = solved("disk", [(around(90 * i, 0.5), 3) for i in range(4)])
    out = tmp_path / "out"
    surface = pv.read(out / "surface.vtp")
    solved_on = report["solved_on"]
    assert (surface.n_points, surface.n_cells) == (solved_on["vertices"], solved_on["faces"])
    assert np.isfinite(surface.point_data["H"]).all()
    u, v = surface.cell_data["u"], surface.cell_data["v"]
    assert np.allclose(np.linalg.norm(u, axis=1), 1)
    assert np.allclose(np.cross(u, v), [0, 0, 1])
    assert surface.cell_data["theta"].shape == (solved_on["faces"],)

    crosses = pv.read(out / "crosses.vtp")
    ends = crosses.points[crosses.lines.reshape(-1, 3)[:, 1:]]
    along = np.diff(ends, axis=1)[:, 0]
    face, axis = crosses.cell_data["face"], crosses.cell_data["axis"]
    directions = np.where(axis[:, None] == 0, u[face], v[face])
    length = np.linalg.norm(along, axis=1)
    assert np.allclose(along, length[:, None] * directions)
    assert np.allclose(
        length / length[0], np.exp(crosses.cell_data["H"] - crosses.cell_data["H"][0])
    )
    assert np.allclose(ends.mean(axis=1), surface.cell_centers().points[face])

    singularities = pv.read(out / "singularities.vtp")
    assert singularities.point_data["valence"].tolist() == [3] * 4
    assert singularities.point_data["index"].tolist() == [1] * 4
    positions = [s["position"] for s in report["singularities"]]
    assert np.allclose(singularities.points, positions)

    # the cut graph meets every singularity and joins it to the boundary
    cut = pv.read(out / "cut_graph.vtp")
    to_cut = np.linalg.norm(cut.points[:, None] - np.array(positions), axis=2).min(axis=0)
    assert np.allclose(to_cut, 0)
    pieces = cut.split_bodies()
    assert len(pieces) > 0
    for piece in pieces:
        assert np.linalg.norm(piece.points, axis=1).max() == pytest.approx(1)


def test_a_surface_without_singularities_has_a_field_too(
    solved: Callable[..., Any], tmp_path: Path
) -> None:
    report = solved("square")
    assert report["index_sum"] == report["index_required"] == 4
    assert sorted(c["index"] for c in report["corners"]) == [1, 1, 1, 1]
    assert np.allclose(pv.read(tmp_path / "out" / "surface.vtp").point_data["H"], 0, atol=1e-9)
    assert pv.read(tmp_path / "out" / "singularities.vtp").n_points == 0


def test_corners_may_be_given(solved: Callable[..., Any]) -> None:
    # a disk drawn as a square with round sides: four corners instead of four singularities
    corners = [{"position": around(90 * i, 1.0), "index": 1} for i in range(4)]
    report = solved("disk", corners=corners)
    assert (report["index_sum"], report["singularities"]) == (4, [])
    found = np.array([c["position"] for c in report["corners"]])
    assert np.abs(found - [c["position"] for c in corners]).max() < 0.03


def test_singularities_on_vertices_edges_and_in_triangles(solved: Callable[..., Any]) -> None:
    # the square's vertices are at multiples of 1/8: a vertex, an edge, inside
    placed = [((0, 0, 0), 3), ((0.0625, 0.25, 0), 5)]
    placed += [((-0.27, -0.13, 0), 3), ((0.21, -0.3, 0), 5)]
    report = solved({"builtin": "square", "n": 8}, placed)
    assert np.allclose([s["position"] for s in report["singularities"]], [p for p, _ in placed])
    assert report["max_closing_error"] < 1e-9


def test_positions_beside_the_surface_are_projected(solved: Callable[..., Any]) -> None:
    report = solved("sphere", [(np.multiply(p, 1.1).tolist(), v) for p, v in CUBE])
    found = np.array([s["position"] for s in report["singularities"]])
    assert np.abs(np.linalg.norm(found, axis=1) - 1).max() < 0.01


def test_json_prints_the_report_and_nothing_else(crossview: Crossview, tmp_path: Path) -> None:
    ran = crossview("solve", "square", "-o", tmp_path / "out", "--json")
    written = json.loads((tmp_path / "out" / "report.json").read_text())
    assert ran.json == written
    assert ran.err == ""
    assert crossview("solve", "square", "-o", tmp_path / "out", "--quiet").out == ""


def test_solving_again_replaces_the_results_and_leaves_other_files(
    crossview: Crossview, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("kept")
    (out / "report.json").write_text("old")
    assert crossview("solve", "square", "-o", out).status == 0
    assert {p.name for p in out.iterdir()} == FILES | {"mine.txt"}
    assert json.loads((out / "report.json").read_text())["isotropically_valid"]


def test_impossible_quads_are_refused_before_any_solve(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    """The corners of an annulus to and fro: the theorem is named, and nothing written."""
    corners = [{"position": [x, 0, 0], "index": k} for x, k in ((1, 1), (-1, -1))]
    path = case_file({"builtin": "annulus", "n": 24}, corners=corners)
    ran = crossview("solve", path, "-o", tmp_path / "out", "--quads")
    assert ran.status == 2
    assert "to and fro" in ran.err
    assert "add a pair" in ran.err
    assert not (tmp_path / "out").exists()
    told = crossview("info", path)
    assert "impossible: Corners that turn to and fro" in told.out
    found = crossview("info", path, "--json").json["components"][0]["existence"]
    assert found["answer"] == "impossible"
    assert found["remedies"] == ["add a pair of valences 3 and 5", "take the 2 corners away"]
    ran = crossview("solve", path, "-o", tmp_path / "out", "--json")
    assert ran.json["verdict"] == "impossible"
