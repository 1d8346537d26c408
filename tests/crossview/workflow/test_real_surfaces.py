"""Real files: described, and solved with singularities that meet their budget."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import pyvista as pv

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.progress import run
from solvers.singularities.placing import far_points
from tests.command_line import Crossview

# genus, boundary loops, required index sum
REAL = {
    "sphere.obj": (0, 0, 8),
    "spot_low_resolution.obj": (0, 0, 8),
    "goathead.obj": (0, 0, 8),
    "wingnut.obj": (0, 0, 8),
    "torus.obj": (1, 0, 0),
    "skull_low_resolution.obj": (2, 0, -8),
    "plate_holes.stl": (5, 0, -32),
    "hand_lowres.obj": (0, 1, 4),
    "demosthenes-low-res.obj": (0, 1, 4),
    "pointy.obj": (0, 1, 4),
    "gen_annulus.obj": (0, 2, 0),
}


# closed without handles, or with one boundary, any configuration that meets its budget is valid
ALWAYS_VALID = [name for name, (genus, loops, _) in REAL.items() if genus == 0 and loops < 2]


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
    crossview: Crossview, real_surface: Callable[[str], Path], tmp_path: Path, name: str
) -> None:
    genus, loops, required = REAL[name]
    path = real_surface(name)
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


@pytest.mark.parametrize(
    ("name", "method"),
    [
        *((name, "isotropic") for name in ALWAYS_VALID),
        ("gen_annulus.obj", "isotropic"),
        ("skull_low_resolution.obj", "anisotropic"),
    ],
)
def test_a_real_surface_has_quads(
    crossview: Crossview,
    real_surface: Callable[[str], Path],
    tmp_path: Path,
    name: str,
    method: str,
) -> None:
    case = far_case(real_surface(name), method)
    (tmp_path / "case.json").write_text(json.dumps(case))
    options = ["--quads", "--target-quads", "3000", "--json"]
    ran = crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out", *options)
    assert ran.status == 0, ran.err
    quads = ran.json["quads"]
    imposed = Counter(str(s["valence"]) for s in case["singularities"])
    assert quads["irregular"] == imposed
    genus, loops, _ = REAL[name]
    assert quads["euler_characteristic"] == 2 - 2 * genus - loops
    assert quads["inverted"] == 0
    assert quads["mean_scaled_jacobian"] > 0.9
    written = pv.read(tmp_path / "out" / "quads.vtk")
    assert written.n_cells == quads["quads"]
    assert quads["max_distance_to_surface"] < 1e-9 * written.length
