"""The pipeline keeps what the next solve can use, and never what it cannot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crossview.cases.json_values import CaseError
from crossview.cases.model import Builtin, Case, Options, PlacedCorner, PlacedSingularity
from crossview.export.report import report, summary
from crossview.workflow.layout import layout
from crossview.workflow.pipeline import Pipeline, solve_case
from crossview.workflow.problem import Problem
from solvers.errors import SingularityError
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity


def annulus(*valences: int, refine: int = 1) -> Case:
    """An annulus with singularities of these valences, evenly around."""
    angles = np.arange(len(valences)) * 2 * np.pi / len(valences)
    placed = [
        PlacedSingularity((0.7 * np.cos(a), 0.7 * np.sin(a), 0.0), valence)
        for a, valence in zip(angles, valences, strict=True)
    ]
    return Case(Builtin("annulus"), tuple(placed), options=Options(refine=refine))


def with_valences(problem: Problem, *valences: int) -> Problem:
    changed = zip(problem.singularities, valences, strict=True)
    return replace(problem, singularities=tuple(replace(s, valence=v) for s, v in changed))


def test_changing_a_valence_keeps_the_factor_and_gives_the_fresh_answer() -> None:
    problem = Problem.from_case(annulus(3, 5, 3, 5))
    other = with_valences(problem, 2, 5, 5, 4)
    pipeline = Pipeline()
    first = run(pipeline.solve(problem))
    second = run(pipeline.solve(other))
    assert second.solver is first.solver
    assert second.refinement is first.refinement
    fresh = run(Pipeline().solve(other))
    assert fresh.solver is not first.solver
    assert np.abs(second.field.H - fresh.field.H).max() < 1e-12
    assert np.abs(second.holonomy_defects - fresh.holonomy_defects).max() < 1e-12


@pytest.mark.parametrize("change", ["place", "refine", "corners", "surface"])
def test_other_changes_start_afresh(change: str) -> None:
    problem = Problem.from_case(annulus(3, 5))
    moved = problem.surface.point_at_vertex(int(problem.surface.faces[2000, 0]))
    assert not problem.surface.boundary_vertices[problem.surface.faces[2000, 0]]
    ends = [int(loop[0]) for loop in problem.surface.boundary_loops]
    changed = {
        "place": replace(problem, singularities=(problem.singularities[0], Singularity(moved, 5))),
        "refine": replace(problem, options=Options(refine=2)),
        "corners": replace(problem, corners=dict(zip(ends, (1, -1), strict=True))),
        "surface": Problem.from_case(annulus(3, 5)),
    }[change]
    pipeline = Pipeline()
    first = run(pipeline.solve(problem))
    second = run(pipeline.solve(changed))
    assert second.solver is not first.solver
    fresh = run(Pipeline().solve(changed))
    assert np.abs(second.field.H - fresh.field.H).max() < 1e-12


def test_turns_whose_map_is_folded_give_way_and_no_other_method_takes_them_over() -> None:
    places = [
        (-0.35, -0.53, -0.23),
        (0.96, -0.65, -0.4),
        (0.42, -1.36, 0.04),
        (-0.98, -0.36, -0.43),
    ]
    placed = tuple(map(PlacedSingularity, places, (3, 3, 5, 5)))
    surface = Builtin("torus", {"minor": 0.433, "n": 48})
    problem = Problem.from_case(Case(surface, placed, method="anisotropic"))
    pipeline = Pipeline()
    solution = run(pipeline.solve(problem))
    assert solution.verdict.status == "valid"
    assert any(solution.turns)
    told = [condition["turns"] for condition in report(solution)["holonomy"]]
    assert told == list(solution.turns)
    assert f"turns {', '.join(map(str, told))}" in summary(solution)
    aligned = run(pipeline.solve(replace(problem, method="aligned")))
    assert aligned.turns == (0, 0)


def test_singularities_become_vertices_where_they_were_placed() -> None:
    solution = run(Pipeline().solve(Problem.from_case(annulus(3, 5, 3, 5))))
    before = solution.problem.surface.positions([s.point for s in solution.problem.singularities])
    after = solution.surface.positions([s.point for s in solution.singularities])
    assert np.allclose(before, after, atol=1e-12)
    assert all(max(s.point.barycentric) == 1 for s in solution.singularities)


def test_a_missed_budget_is_told_before_anything_is_computed() -> None:
    problem = Problem.from_case(annulus(3, 3))
    steps: list[Progress] = []
    with pytest.raises(SingularityError, match=r"2 of 0: add 2 valence 5 or .* or make #2"):
        run(Pipeline().solve(problem), steps.append)
    assert steps == []


def test_progress_grows_and_names_its_stages() -> None:
    steps: list[Progress] = []
    (solution,) = run(solve_case(annulus(3, 5)), steps.append)
    fractions = [step.fraction for step in steps]
    assert fractions == sorted(fractions)
    assert steps[0].stage == "reading the surface"
    stages = ["read", "refine", "factor", "solve", "map", "holonomy", "verdict"]
    assert list(solution.seconds) == stages


def test_a_problem_becomes_the_case_it_came_from() -> None:
    corner = PlacedCorner((1.0, 0.0, 0.0), 1)
    case = replace(annulus(3, 5, 6), corners=(corner,), title="three")
    locked = tuple(replace(s, locked=True) for s in case.singularities)
    case = replace(case, singularities=locked)
    again = Problem.from_case(case).to_case(case.surface, case.title)
    assert replace(again, singularities=(), corners=None) == replace(
        case, singularities=(), corners=None
    )
    for one, other in zip(case.singularities, again.singularities, strict=True):
        assert (one.valence, one.locked) == (other.valence, other.locked)
        # the annulus is a polygon: places move to it
        assert np.allclose(one.position, other.position, atol=1e-12)
    assert again.corners is not None
    assert again.corners[0].index == 1
    assert np.allclose(again.corners[0].position, corner.position)


def test_all_components_are_no_single_problem() -> None:
    case = replace(annulus(), options=Options(component="all"))
    with pytest.raises(CaseError, match="one is wanted"):
        Problem.from_case(case)


@pytest.mark.parametrize("valence", [10, 12])
def test_what_is_called_valid_has_a_map_and_its_layout(valence: int) -> None:
    """On a sphere any budget has its field; a high valence among few triangles is hard to map."""
    threes = np.random.default_rng(1).normal(size=(valence + 4, 3))
    placed = [PlacedSingularity((0.0, 0.0, 1.0), valence)]
    placed += [PlacedSingularity(tuple(p / np.linalg.norm(p)), 3) for p in threes]
    surface = Builtin("sphere", {"subdivisions": 2})
    case = Case(surface, tuple(placed), options=Options(refine=0))
    solution = run(Pipeline().solve(Problem.from_case(case)))
    told = report(solution)
    assert (told["verdict"], told["flips"], told["wrong_windings"]) == ("valid", 0, 0)
    assert run(layout(solution)).inverted == 0


def test_a_field_that_is_refused_gets_no_map() -> None:
    solution = run(Pipeline().solve(Problem.from_case(annulus(3, 5))))
    assert solution.verdict.refused
    assert solution.mapped is None
