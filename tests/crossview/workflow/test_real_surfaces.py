"""Real files: described, and solved with singularities that meet their budget."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import pyvista as pv

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.progress import run
from solvers.singularities.farthest import far_points
from tests.command_line import Crossview
from tests.real_surfaces import PATHS, REAL

# closed without handles, or with one boundary, any configuration that meets its budget is valid
ALWAYS_VALID = [
    name for name, facts in REAL.items() if facts.genus == 0 and facts.boundary_loops < 2
]
OTHERS = {"gen_annulus.obj": "isotropic", "skull_low_resolution.obj": "anisotropic"}


def far_case(path: Path, method: str = "isotropic") -> dict[str, Any]:
    """A case whose index budget is met by singularities far apart."""
    problem = Problem.from_case(Case(str(path)))
    surface = problem.surface
    missing = 4 * surface.euler_characteristic - sum(problem.chosen_corners.values())
    places = run(far_points(surface, (), abs(missing)))
    return {
        "surface": str(path),
        "method": method,
        "singularities": [
            {"position": surface.position(place).tolist(), "valence": 3 if missing > 0 else 5}
            for place in places
        ],
    }


@pytest.mark.parametrize("name", REAL)
def test_a_real_surface_is_described_and_solved(
    crossview: Crossview, tmp_path: Path, name: str
) -> None:
    genus, loops = REAL[name].genus, REAL[name].boundary_loops
    required = 4 * REAL[name].euler_characteristic
    path = PATHS[name]
    found = crossview("info", path, "--json").json
    (piece,) = found["components"]
    assert found["problems"] == []
    assert (piece["genus"], piece["boundary_loops"]) == (genus, loops)
    assert piece["index_budget"]["required"] == required

    (tmp_path / "case.json").write_text(json.dumps(far_case(path)))
    ran = crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out", "--json")
    assert ran.status == 0, ran.err
    report = ran.json
    assert report["index_sum"] == required
    assert len(report["holonomy"]) == 2 * genus + max(loops - 1, 0)
    assert len(report["boundary_misalignment_degrees"]) == loops
    assert report["max_closing_error"] < 1e-9
    assert report["residual"] < 1e-9


# where about one quad of 3 000 has a corner that the certificate measures above 180 degrees
HARD = ("demosthenes-low-res.obj", "skull_low_resolution.obj")
RUNS = [
    *((name, "isotropic") for name in ALWAYS_VALID),
    *((name, method) for name, method in OTHERS.items() if name in REAL),
]


@pytest.mark.parametrize(("name", "method"), [run for run in RUNS if run[0] not in HARD])
def test_a_real_surface_has_quads(
    crossview: Crossview,
    tmp_path: Path,
    name: str,
    method: str,
) -> None:
    case = far_case(PATHS[name], method)
    (tmp_path / "case.json").write_text(json.dumps(case))
    options = ["--quads", "--target-quads", "3000", "--json"]
    ran = crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out", *options)
    assert ran.status == 0, ran.err
    quads = ran.json["quads"]
    imposed = Counter(str(s["valence"]) for s in case["singularities"])
    assert quads["irregular"] == imposed
    assert quads["euler_characteristic"] == REAL[name].euler_characteristic
    assert quads["inverted"] == 0
    assert quads["mean_scaled_jacobian"] > 0.9
    written = pv.read(tmp_path / "out" / "quads.vtk")
    assert written.n_cells == quads["quads"]
    assert quads["max_distance_to_surface"] < 1e-9 * written.length


@pytest.mark.parametrize(("name", "method"), [run for run in RUNS if run[0] in HARD])
def test_on_a_hard_surface_an_inverted_quad_is_told_and_none_is_written(
    crossview: Crossview, tmp_path: Path, name: str, method: str
) -> None:
    case = far_case(PATHS[name], method)
    (tmp_path / "case.json").write_text(json.dumps(case))
    options = ["--quads", "--target-quads", "3000", "--json"]
    ran = crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out", *options)
    quads = ran.json["quads"]
    assert quads["irregular"] == Counter(str(s["valence"]) for s in case["singularities"])
    assert quads["euler_characteristic"] == REAL[name].euler_characteristic
    assert quads["inverted"] < 0.001 * quads["quads"]
    spoilt = quads["inverted"] > 0
    assert ran.status == int(spoilt)
    assert ("inverted face" in ran.err) == spoilt
    assert (tmp_path / "out" / "quads.vtk").exists() != spoilt
    assert (tmp_path / "out" / "report.json").exists()
