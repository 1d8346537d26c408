"""The library's face: from a file to a quad mesh, without opening a module's source."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossview
from crossview.cases.model import Builtin
from solvers import Progress


def test_importing_it_loads_neither_qt_nor_vtk() -> None:
    program = "import sys, crossview; print(*{name.partition('.')[0] for name in sys.modules})"
    command = [sys.executable, "-c", program]
    loaded = set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())
    assert "solvers" in loaded
    heavy = {"PySide6", "vtk", "vtkmodules", "pyvista", "pyvistaqt", "matplotlib", "meshio"}
    assert not loaded & heavy


def sphere_file(folder: Path) -> Path:
    surface = crossview.primitives.sphere(subdivisions=3)
    lines = [f"v {x} {y} {z}" for x, y, z in surface.vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in surface.faces + 1]
    (folder / "sphere.obj").write_text("\n".join(lines))
    return folder / "sphere.obj"


def test_from_a_file_to_a_quad_mesh(tmp_path: Path) -> None:
    problem = crossview.natural(crossview.read(sphere_file(tmp_path)))
    solution = crossview.solve(problem)
    layout = crossview.layout(solution)
    mesh = crossview.quads(layout, 400)
    crossview.write_mesh(mesh, tmp_path / "quads.obj")
    crossview.write_case(problem, tmp_path / "case.json")
    assert mesh.irregular == {3: 8}
    assert mesh.scaled_jacobian.min() > 0
    again = crossview.read(tmp_path / "case.json")
    one, other = (p.surface.positions([s.point for s in p.singularities]) for p in (problem, again))
    np.testing.assert_allclose(one, other, atol=1e-9)
    assert crossview.read_surface(tmp_path / "quads.obj").euler_characteristic == 2


def test_choices_are_those_of_the_command_line() -> None:
    problem = crossview.read("annulus-far", method="anisotropic", features=40, repair=True)
    assert (problem.method, problem.marking.dihedral_degrees) == ("anisotropic", 40)
    assert problem.options.repair


@pytest.mark.parametrize(
    ("choices", "said"),
    [
        ({"method": "newton"}, "newton"),
        ({"features": 200}, "200"),
        ({"component": "biggest"}, "biggest"),
        ({"component": "all"}, "one is wanted"),
    ],
)
def test_wrong_choices_are_told_in_one_line(choices: dict[str, object], said: str) -> None:
    with pytest.raises(crossview.CrossviewError, match=said) as refused:
        crossview.read("disk-4", **choices)  # type: ignore[arg-type]
    assert "\n" not in str(refused.value)


def test_long_computations_report_their_progress() -> None:
    steps: list[Progress] = []
    crossview.solve(crossview.read("annulus-far"), "anisotropic", progress=steps.append)
    fractions = [step.fraction for step in steps]
    assert len(fractions) > 4
    assert fractions == sorted(fractions)


def test_a_problem_takes_any_iterable_of_singularities() -> None:
    surface = crossview.primitives.disk(edge_length=0.2)

    def singularities() -> Iterator[crossview.Singularity]:
        for x, y in ((0.4, 0.4), (-0.4, 0.4), (-0.4, -0.4), (0.4, -0.4)):
            yield crossview.Singularity(surface.closest_point([x, y, 0]), 3)

    problem = crossview.Problem(surface, singularities())  # type: ignore[arg-type]
    assert crossview.solve(problem).field.index_sum == 4


def test_a_problem_of_something_else_is_refused() -> None:
    surface = crossview.primitives.disk(edge_length=0.2)
    with pytest.raises(crossview.CrossviewError, match="Singularity"):
        crossview.Problem(surface, [(0.4, 0.4, 0.0)])  # type: ignore[arg-type]
    with pytest.raises(crossview.CrossviewError, match="newton"):
        crossview.Problem(surface, method="newton")


def test_a_surface_made_in_python_is_named_in_its_case(tmp_path: Path) -> None:
    problem = crossview.Problem(crossview.primitives.disk(edge_length=0.2))
    with pytest.raises(crossview.CrossviewError, match="surface="):
        crossview.write_case(problem, tmp_path / "case.json")
    assert not (tmp_path / "case.json").exists()
    made_by = Builtin("disk", {"edge_length": 0.2})
    crossview.write_case(problem, tmp_path / "case.json", surface=made_by)
    again = crossview.read(tmp_path / "case.json").surface
    np.testing.assert_array_equal(again.vertices, problem.surface.vertices)


@pytest.mark.parametrize(
    ("corners", "said"),
    [
        ({0: 0.5}, "the index of corner 0 must be a whole number, at most 1, not 0.5"),
        ({10**6: 1}, "the vertex of a corner must be a whole number from 0 to"),
    ],
)
def test_corners_of_a_problem_are_checked(corners: Any, said: str) -> None:
    with pytest.raises(crossview.CrossviewError, match=said):
        crossview.Problem(crossview.primitives.square(n=4), corners=corners)
