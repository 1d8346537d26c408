"""Features in cases, reports and on the command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crossview.cases.model import Builtin, Case, PlacedFeatures
from crossview.export.report import report, summary
from crossview.workflow.marking import Marking
from crossview.workflow.pipeline import Pipeline, solve_case
from crossview.workflow.problem import Problem
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from tests.command_line import CaseFile, Crossview
from tests.real_surfaces import PATHS

RING = tuple(
    (float(np.cos(a)), float(np.sin(a)), 0.0)
    for a in np.linspace(0.0, 2 * np.pi, 5)[[0, 1, 2, 3, 0]]
)


def cylinder(**features: Any) -> Case:
    return Case(Builtin("cylinder", {"n": 32}), features=PlacedFeatures(**features))


def test_a_case_keeps_its_features(tmp_path: Path) -> None:
    case = cylinder(dihedral_degrees=40.0, curves=(RING,), without=(RING[:2],))
    case.save(tmp_path / "case.json")
    assert Case.load(tmp_path / "case.json") == case


def test_a_curve_runs_along_edges_through_the_vertices_nearest_to_its_points() -> None:
    problem = Problem.from_case(cylinder(curves=(RING,)))
    (curve,) = problem.features.curves
    assert curve.closed
    assert len(curve.members) == 32
    assert problem.surface.vertices[curve.vertices][:, 2] == pytest.approx(np.zeros(33), abs=1e-9)


def test_what_was_marked_by_hand_is_saved_and_found_again(tmp_path: Path) -> None:
    surface = BUILTIN["cylinder"](n=32)
    some = frozenset(np.flatnonzero(surface.edge_faces[:, 1] >= 0)[3:40:4].tolist())
    problem = Problem(surface, marking=Marking(5.0, unmarked=some))
    assert len(problem.features) > 0
    case = problem.to_case(Builtin("cylinder", {"n": 32}))
    case.save(tmp_path / "case.json")
    again = Problem.from_case(Case.load(tmp_path / "case.json"))
    assert again.features.edges.tolist() == problem.features.edges.tolist()


def test_marking_twice_takes_the_mark_away() -> None:
    surface = BUILTIN["cylinder"](n=32)
    ring = np.array(sorted(Problem.from_case(cylinder(curves=(RING,))).marking.marked))
    for start in (Marking(), Marking(5.0)):
        once = start.toggled(surface, ring)
        assert not once.toggled(surface, ring).on(surface).edges.size or start.dihedral_degrees
        if not np.isin(ring, start.on(surface).edges).all():
            assert np.isin(ring, once.on(surface).edges).all()
            once = once.toggled(surface, ring)
        assert not np.isin(ring, once.on(surface).edges).any()


@pytest.mark.parametrize(
    ("features", "told"),
    [
        ({"dihedral_degrees": 0}, "features.dihedral_degrees"),
        ({"curves": [[[0, 0, 1]]]}, "features.curves[0]"),
        ({"sharp": 40}, 'unknown key "sharp"'),
    ],
)
def test_wrong_features_are_told_with_their_place(
    crossview: Crossview, case_file: CaseFile, features: dict[str, Any], told: str
) -> None:
    ran = crossview("solve", case_file("cylinder", features=features), "-o", "nowhere")
    assert ran.status == 2
    assert told in ran.err


def test_a_curve_far_away_is_refused(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    far = {"curves": [[[9, 0, 0], [0, 9, 0]]]}
    ran = crossview("solve", case_file("cylinder", features=far), "-o", tmp_path / "out")
    assert ran.status == 2
    assert "curve #1" in ran.err


OFF = [
    ([0.96, 0.30, 0.5], 3),
    ([-0.42, 0.91, 0.4], 5),
    ([0.45, 0.89, -0.5], 3),
    ([-1, 0.1, 0.6], 5),
]


@pytest.mark.parametrize("method", ["isotropic", "aligned", "anisotropic"])
def test_the_report_tells_the_misalignment_of_each_curve(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path, method: str
) -> None:
    surface = {"builtin": "cylinder", "n": 32}
    path = case_file(surface, OFF, features={"curves": [RING]})
    ran = crossview("solve", path, "-o", tmp_path / "out", "--method", method, "--json")
    assert ran.status == 0, ran.err
    (curve,) = ran.json["features"]
    assert curve["closed"]
    assert curve["length"] == pytest.approx(2 * np.pi, rel=0.01)
    off = abs(curve["misalignment_degrees"])
    if method == "isotropic":
        assert off > 1
        assert ran.json["verdict"] != "valid"
    else:
        assert off < 1e-6
        assert ran.json["max_closing_error"] < 1e-9
    if method == "anisotropic":
        assert ran.json["energy_final"] < 1e-10
    assert (tmp_path / "out" / "features.vtp").is_file()


def test_valid_but_off_a_curve_is_not_valid() -> None:
    # no singularity: the field runs around; an edge along a diagonal of the cells is not followed
    surface = BUILTIN["cylinder"](n=32)
    ends = surface.vertices[surface.edges]
    slanted = (np.abs(ends[:, 0, 2] - ends[:, 1, 2]) > 1e-9) & (
        np.linalg.norm(ends[:, 0, :2] - ends[:, 1, :2], axis=1) > 1e-9
    )
    line = tuple(tuple(point) for point in ends[np.flatnonzero(slanted)[20]].tolist())
    (solution,) = run(solve_case(cylinder(curves=(line,))))
    assert solution.valid
    assert solution.verdict.status == "not found"
    assert "feature" in solution.verdict.reason


def test_sharp_edges_can_be_asked_for_on_the_command_line(
    crossview: Crossview, tmp_path: Path
) -> None:
    new = tmp_path / "plate.json"
    ran = crossview("natural", PATHS["plate_holes.stl"], "-o", new, "--features", 40)
    assert ran.status == 0, ran.err
    assert json.loads(new.read_text())["features"] == {"dihedral_degrees": 40.0}
    ran = crossview("solve", new, "-o", tmp_path / "out", "--method", "anisotropic", "--json")
    assert ran.status == 0, ran.err
    assert len(ran.json["features"]) > 10
    assert max(abs(c["misalignment_degrees"]) for c in ran.json["features"]) < 1e-6
    assert ran.json["energy_final"] < 1e-10


def test_the_option_replaces_the_angle_of_the_case_and_keeps_its_curves(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    path = case_file("cylinder", features={"curves": [RING], "dihedral_degrees": 2})
    ran = crossview("solve", path, "-o", tmp_path / "out", "--features", 170, "--json")
    assert ran.status == 0, ran.err
    assert len(ran.json["features"]) == 1


def test_natural_by_curvature(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "case.json"
    arguments = ("natural", "ellipsoid", "-o", new, "--alignment", "curvature")
    assert crossview(*arguments).status == 0
    assert sum(4 - s["valence"] for s in json.loads(new.read_text())["singularities"]) == 8
    ran = crossview("natural", "ellipsoid", "-o", new, "--alignment", "x")
    assert ran.status == 2
    assert "smoothness, curvature" in ran.err


def test_the_torus_of_the_gallery_misses_its_marked_curve(
    crossview: Crossview, tmp_path: Path
) -> None:
    ran = crossview("solve", "torus-35", "-o", tmp_path / "out", "--json")
    (curve,) = ran.json["features"]
    assert curve["closed"]
    assert abs(curve["misalignment_degrees"]) > 10
    assert ran.json["index_sum"] == ran.json["index_required"] == 0
    assert ran.json["max_closing_error"] < 1e-9
    assert ran.json["verdict"] == "impossible"


def test_a_curve_without_room_is_released_and_named() -> None:
    """Five sharp rays cannot all run through a vertex of four quads."""
    surface = BUILTIN["disk"](edge_length=0.12)
    degree = np.bincount(surface.edges.reshape(-1))
    depth = np.linalg.norm(surface.vertices, axis=1)
    centre = int(np.argmin(np.where(degree == 6, depth, np.inf)))
    spokes = np.flatnonzero((surface.edges == centre).any(axis=1))
    at = [surface.closest_point([x, y, 0.0]) for x in (-0.6, 0.6) for y in (-0.6, 0.6)]
    threes = [Singularity(point, 3) for point in at]
    problem = Problem(
        surface, threes, method="aligned", marking=Marking(marked=frozenset(spokes[:5].tolist()))
    )
    solution = run(Pipeline().solve(problem))
    assert "released 1 of 5 feature curves: no room for a quad beside them (1)" in summary(solution)
    found = report(solution)
    assert len(found["features"]) == 4
    (released,) = found["released_features"]
    assert released["length"] == pytest.approx(
        np.linalg.norm(np.subtract(released["start"], released["end"]))
    )
    kept = [curve["length"] for curve in found["features"]]
    assert released["length"] <= min(kept) + 1e-9
    assert max(abs(curve["misalignment_degrees"]) for curve in found["features"]) < 1e-6
