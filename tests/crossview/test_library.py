"""The library's face: from a file to a quad mesh, without opening a module's source."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
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
        crossview.Problem(surface, [(0.4, 0.4, 0.0)])  # type: ignore[list-item]
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


@pytest.fixture(scope="module")
def stages() -> dict[str, Any]:
    problem = crossview.read("disk-4")
    solution = crossview.solve(problem)
    layout = crossview.layout(solution)
    quads = crossview.quads(layout, 100)
    return {
        "a surface": problem.surface,
        "a problem": problem,
        "a solution": solution,
        "a layout": layout,
        "a mesh": quads,
        "a text": "disk-4",
        "nothing": None,
    }


WANTED: dict[str, tuple[str, str, Callable[[Any, Path], object]]] = {
    "natural": ("a problem", "crossview.read", lambda v, _: crossview.natural(v)),
    "complete": ("a problem", "crossview.read", lambda v, _: crossview.complete(v)),
    "make_valid": ("a problem", "crossview.read", lambda v, _: crossview.make_valid(v)),
    "improve": ("a problem", "crossview.read", lambda v, _: crossview.improve(v)),
    "solve": ("a problem", "crossview.read", lambda v, _: crossview.solve(v)),
    "write_case": ("a problem", "crossview.read", lambda v, to: crossview.write_case(v, to)),
    "layout": ("a solution", "crossview.solve", lambda v, _: crossview.layout(v)),
    "report": ("a solution", "crossview.solve", lambda v, _: crossview.report(v)),
    "write_solution": ("a solution", "crossview.solve", crossview.write_solution),
    "render": ("a solution", "crossview.solve", crossview.render),
    "quads": ("a layout", "crossview.layout", lambda v, _: crossview.quads(v, 100)),
    "write_mesh": ("a mesh", "crossview.quads", crossview.write_mesh),
}


@pytest.mark.parametrize("verb", WANTED)
def test_a_verb_given_something_else_names_the_verb_that_makes_it(
    verb: str, stages: dict[str, Any], tmp_path: Path
) -> None:
    wanted, maker, call = WANTED[verb]
    for what, value in stages.items():
        if what != wanted:
            with pytest.raises(crossview.CrossviewError, match=f"must be a .*{maker}") as refused:
                call(value, tmp_path / "made")
            assert "\n" not in str(refused.value)
    assert not list(tmp_path.iterdir())


def test_layout_and_quads_of_another_solution_are_refused(
    stages: dict[str, Any], tmp_path: Path
) -> None:
    other = crossview.solve(crossview.read("square"))
    layout, quads = stages["a layout"], stages["a mesh"]
    uses: list[Callable[..., object]] = [
        crossview.report,
        lambda s, **made: crossview.write_solution(s, tmp_path / "out", **made),
        lambda s, **made: crossview.render(s, tmp_path / "a.png", size=(64, 48), **made),
    ]
    for use in uses:
        with pytest.raises(crossview.CrossviewError, match="the layout is of another solution"):
            use(other, layout=layout)
        with pytest.raises(crossview.CrossviewError, match="the quads are of another solution"):
            use(other, quads=quads)
    assert not list(tmp_path.iterdir())
    again = crossview.solve(crossview.read("disk-4"))
    own = crossview.report(again, layout, quads)  # the same, solved once more
    assert own["layout"]["patches"] == 5


@pytest.mark.parametrize("path", ["", " ", "a\0b", 3, None, b"x", []])
def test_a_name_of_a_file_is_a_text_or_a_path(path: Any, stages: dict[str, Any]) -> None:
    calls: list[Callable[[], object]] = [
        lambda: crossview.read(path),
        lambda: crossview.read_surface(path),
        lambda: crossview.write_case(stages["a problem"], path),
        lambda: crossview.write_mesh(stages["a mesh"], path),
        lambda: crossview.write_solution(stages["a solution"], path),
        lambda: crossview.render(stages["a solution"], path),
    ]
    for call in calls:
        with pytest.raises(crossview.CrossviewError, match="the name of the"):
            call()


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"size": 3}, "the size must be 2 numbers, not a single one"),
        ({"size": (1,)}, "the size must be 2 numbers, not 1"),
        ({"size": None}, "the size must be numbers, not None"),
        ({"scale": "x"}, "the scale must be numbers, not 'x'"),
        ({"camera": 3}, "the camera must be a str, not an int"),
        ({"background": "pink"}, 'no background "pink".*choose white or dark'),
        ({"layers": 3}, "layers must be several str, not an int"),
        ({"layers": ["H", 3]}, "layers must each be a str, not an int"),
    ],
)
def test_what_cannot_be_drawn_is_told_in_one_line(
    how: dict[str, Any], said: str, stages: dict[str, Any], tmp_path: Path
) -> None:
    with pytest.raises(crossview.CrossviewError, match=said):
        crossview.render(stages["a solution"], tmp_path / "a.png", **how)
    assert not list(tmp_path.iterdir())


def test_formats_are_checked_before_anything_is_written(
    stages: dict[str, Any], tmp_path: Path
) -> None:
    for wrong in ("obj", ["nope"], None, [3]):
        with pytest.raises(crossview.CrossviewError, match=r"meshes cannot be|formats must"):
            crossview.write_solution(stages["a solution"], tmp_path / "out", formats=wrong)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("made", "said"),
    [
        ({"surface": None}, "the surface of a case must be the name of a file or a Builtin"),
        ({"method": 3}, 'unknown method "3"'),
        ({"options": {"refine": 1}}, "the options of a case must be an Options, not a dict"),
        ({"singularities": 3}, "singularities must be several PlacedSingularity, not an int"),
        ({"corners": [3]}, "corners must each be a PlacedCorner, not an int"),
        ({"features": 30}, "the features of a case must be a PlacedFeatures, not an int"),
        ({"title": 3}, "the title of a case must be a str, not an int"),
    ],
)
def test_a_case_made_in_python_is_checked(made: dict[str, Any], said: str) -> None:
    with pytest.raises(crossview.CrossviewError, match=said):
        crossview.Case(**{"surface": "disk", **made})


def test_a_case_of_a_surface_made_in_python_says_what_to_do() -> None:
    surface: Any = crossview.primitives.square(n=4)
    with pytest.raises(crossview.CrossviewError, match=r"by Problem\(surface, singularities\)"):
        crossview.Case(surface)


def test_the_smallest_edges_make_too_many_quads(stages: dict[str, Any]) -> None:
    for length in (1e-3, 1e-90, 1e-300):
        with pytest.raises(crossview.CrossviewError, match="quads are too many"):
            crossview.quads(stages["a layout"], edge_length=length)
