"""Real files: described, and solved with singularities that meet their budget."""

from __future__ import annotations

import json

import pytest

from crossview.case import Case
from crossview.problem import Problem
from solvers.placing import far_points
from solvers.progress import run

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


@pytest.mark.parametrize("name", REAL)
def test_a_real_surface_is_described_and_solved(crossview, real_surface, tmp_path, name):
    genus, loops, required = REAL[name]
    path = real_surface(name)
    found = crossview("info", path, "--json").json
    (piece,) = found["components"]
    assert found["problems"] == []
    assert (piece["genus"], piece["boundary_loops"]) == (genus, loops)
    missing = piece["index_budget"]["missing"]
    assert piece["index_budget"]["required"] == required

    problem = Problem.from_case(Case(str(path)))
    places = run(far_points(problem.surface, (), abs(missing)))
    case = {
        "surface": str(path),
        "singularities": [
            {
                "position": problem.surface.position(place).tolist(),
                "valence": 3 if missing > 0 else 5,
            }
            for place in places
        ],
    }
    (tmp_path / "case.json").write_text(json.dumps(case))
    ran = crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out", "--json")
    assert ran.status == 0, ran.err
    report = ran.json
    assert report["index_sum"] == required
    assert len(report["holonomy"]) == 2 * genus + max(loops - 1, 0)
    assert len(report["boundary_misalignment_degrees"]) == loops
    assert report["max_closing_error"] < 1e-9
    assert report["residual"] < 1e-9
