"""A case that is saved, opened and saved again is the same file."""

from pathlib import Path

import numpy as np
import pytest

import crossview
from crossview.cases.gallery import find_case, names
from crossview.workflow.problem import Problem
from solvers.primitives import torus
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint


def saved_again(path: Path) -> bytes:
    again = path.with_name("again.json")
    crossview.write_case(crossview.read(path), again)
    return again.read_bytes()


@pytest.mark.parametrize("seed", range(3))
def test_positions_on_a_curved_surface_keep_every_digit(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    surface = torus(n=24)
    faces = rng.choice(surface.n_faces, 40, replace=False).tolist()
    weights = rng.dirichlet([1, 1, 1], 40).tolist()
    placed = [
        Singularity(SurfacePoint(face, (a, b, c)), 3 + 2 * (number % 2))
        for number, (face, (a, b, c)) in enumerate(zip(faces, weights, strict=True))
    ]
    source = crossview.Case.from_json({"surface": {"builtin": "torus", "n": 24}}).surface
    path = tmp_path / "case.json"
    crossview.write_case(Problem(surface, placed, source=source), path)
    assert saved_again(path) == path.read_bytes()


@pytest.mark.parametrize("name", names()[:6])
def test_cases_of_the_gallery_keep_every_digit(name: str, tmp_path: Path) -> None:
    path = tmp_path / "case.json"
    problem = crossview.read(name)
    crossview.write_case(problem, path)
    assert saved_again(path) == path.read_bytes()
    given = find_case(name).singularities
    written = crossview.Case.load(path).singularities
    assert [s.position for s in written] == [s.position for s in given]


def test_what_is_moved_is_written_where_it_is() -> None:
    problem = crossview.read("disk-4")
    point = problem.surface.closest_point([0.1, 0.05, 0.0])
    moved = crossview.Problem(
        problem.surface,
        [Singularity(point, 3), *problem.singularities[1:]],
        source=problem.source,
        places=problem.places,
    )
    case = moved.to_case(problem.source or "")
    assert case.singularities[0].position == pytest.approx((0.1, 0.05, 0.0))
