"""Solution, layout and quads are values: to ask for one never changes another."""

from __future__ import annotations

import dataclasses
import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from crossview.cases.model import Builtin, Case, PlacedSingularity
from crossview.export.report import report, write_solution
from crossview.export.vtp import cross_lines, field_surface
from crossview.session.meshes import NO_MESHES, lay_out, make_quads, trace
from crossview.workflow.layout import layout, separatrices
from crossview.workflow.pipeline import Solution, solve_case
from crossview.workflow.quads import MeshOptions, quads
from solvers.layouts.separatrices import SINGULARITY
from solvers.progress import run

CORNERS = [tuple(c / np.sqrt(3) for c in signs) for signs in product((-1.0, 1.0), repeat=3)]


@pytest.fixture
def cube() -> Solution:
    singularities = tuple(PlacedSingularity((x, y, z), 3) for x, y, z in CORNERS)
    (solution,) = run(solve_case(Case(Builtin("cube_sphere", {"n": 16}), singularities)))
    return solution


def contents(solution: Solution, folder: Path) -> dict[str, bytes]:
    write_solution(solution, folder)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_files_are_the_same_before_and_after_further_stages(cube: Solution, tmp_path: Path) -> None:
    before, told = contents(cube, tmp_path / "before"), json.dumps(report(cube))
    made = run(layout(cube))
    run(quads(made, MeshOptions(target_quads=300)))
    separatrices(cube, made)
    for ask in (trace, lay_out):
        run(ask(cube, NO_MESHES))
    run(make_quads(cube, NO_MESHES, MeshOptions(target_quads=300)))
    assert contents(cube, tmp_path / "after") == before
    assert json.dumps(report(cube)) == told


def test_every_picture_has_the_crosses_that_were_solved(cube: Solution) -> None:
    shown = run(lay_out(cube, NO_MESHES))
    assert shown.of is cube.field
    np.testing.assert_array_equal(field_surface(cube).cell_data["u"], cube.field.u)
    lines = cross_lines(cube)
    ends = lines.points[lines.lines.reshape(-1, 3)[:, 1:]]
    along = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
    np.testing.assert_allclose(along[::2], cube.field.u, atol=1e-9)


def test_the_layout_follows_the_crosses_as_they_were_solved(cube: Solution) -> None:
    """Each of the cube's edges is a separatrix, along the crosses to a tenth of a degree."""
    curves = run(layout(cube)).separatrices
    joining = curves.ends == SINGULARITY
    assert joining.sum() == 12
    for start, end in zip(curves.offsets[:-1][joining], curves.offsets[1:][joining], strict=True):
        middle = curves.points[start:end].mean(axis=0)
        face = cube.surface.closest_point(middle).face
        way = curves.points[end - 1] - curves.points[start]
        way /= np.linalg.norm(way)
        u, v = cube.field.u[face], cube.field.v[face]
        assert min(abs(u @ way), abs(v @ way)) < np.sin(np.radians(0.1))


def test_stages_are_frozen(cube: Solution) -> None:
    made = run(layout(cube))
    for value, name in ((cube, "field"), (made, "arrangement")):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(value, name, None)
    field = cube.field
    for array in (
        *(field.theta, field.H, field.H1, field.u, field.log_aspect, cube.holonomy_defects),
        *(cube.refinement.parent_face, cube.features.degrees, cube.separatrices.points),
        *(made.separatrices.points, made.tmesh.lengths),
    ):
        before = array.copy()
        with pytest.raises(ValueError, match="read-only"):
            array += 1
        np.testing.assert_array_equal(array, before)
