"""Iterates ready to be drawn, and jobs that place singularities anew."""

from dataclasses import replace

import numpy as np
import pytest

from crossview.cases.gallery import path_of
from crossview.cases.model import METHODS, Case, PlacedCorner
from crossview.session.commands import METHOD_LABELS, ChooseMethod
from crossview.session.document import Document
from crossview.session.history import History
from crossview.session.live import LiveBase
from crossview.session.method_solver import MethodSolver, MethodStep
from crossview.session.waypoints import NATURAL_LABELS, Waypoint, move_to_validity, place_natural
from solvers.fields import NATURAL_METHODS
from solvers.progress import Progress, run


@pytest.fixture(scope="module")
def near() -> Document:
    case = replace(Case.load(path_of("annulus-near")), method="anisotropic")
    return Document.from_case("near", case)


def test_iterates_are_drawn_on_what_they_are_solved_on(near: Document) -> None:
    seen: list[Progress] = []
    solved = run(MethodSolver().solve(near.problem), seen.append)
    iterates = [step for step in seen if isinstance(step, MethodStep)]
    assert [len(i.step.energies) for i in iterates] == list(range(2, len(iterates) + 2))
    first = iterates[0]
    assert first.field is not None  # later ones only if enough time has passed
    assert first.base.surface is first.field.surface is first.start.surface
    assert first.step.energies[0] == pytest.approx(first.start.energy)
    assert solved.solution.field.convergence.energies[0] == first.step.energies[0]
    assert solved.start is first.start
    for given, placed in zip(near.singularities, solved.solution.singularities, strict=True):
        assert first.base.refinement.locate(given.point) == placed.point


def test_what_is_stopped_is_kept_and_said_to_be_no_more(near: Document) -> None:
    solver = MethodSolver()
    solving = solver.solve(near.problem)
    iterate = next(step for step in solving if isinstance(step, MethodStep))
    solving.close()
    kept = run(solver.keep(iterate.step)).solution
    assert not kept.field.convergence.converged
    assert kept.field.energy == pytest.approx(iterate.step.energies[-1])
    assert kept.verdict.status != "valid"
    again = run(solver.solve(near.problem)).solution
    assert again.field.convergence.converged


def test_the_way_to_validity_can_be_drawn(near: Document) -> None:
    isotropic = ChooseMethod("isotropic").apply(near)
    base = LiveBase.from_solution(run(MethodSolver().solve(isotropic.problem)).solution)
    seen: list[Progress] = []
    command = run(move_to_validity(isotropic, base), seen.append)
    way = [step for step in seen if isinstance(step, Waypoint)]
    assert all(step.field is not None and step.field.surface is base.surface for step in way)
    assert len(way[0].singularities) == len(near.singularities)
    moved = command.apply(isotropic)
    assert command.name == "make valid"
    assert run(MethodSolver().solve(moved.problem)).solution.valid
    defects = way[-1].defects
    assert defects is not None
    assert np.abs(defects).max() < 1e-6


def test_natural_singularities_bring_the_corners_they_belong_to() -> None:
    corners = (PlacedCorner((1.0, 0.0, 0.0), 1),)
    case = replace(Case.from_json({"surface": {"builtin": "disk"}}), corners=corners)
    document = Document.from_case("disk", case)
    placed = run(place_natural(document, "globally-optimal")).apply(document)
    assert placed.budget.satisfied
    assert placed.problem.corners is None
    assert document.corners != placed.corners == {}


def test_the_method_is_a_named_step(near: Document) -> None:
    history = History()
    history.open(near)
    history.do(ChooseMethod("alternating"))
    assert history.undo_name == "choose method alternating (paper)"
    assert history.document.problem.method == "alternating"
    assert history.document.problem.same_but_method(near.problem)
    history.undo()
    assert history.document is near


def test_every_method_has_a_label() -> None:
    assert tuple(METHOD_LABELS) == METHODS
    assert tuple(NATURAL_LABELS) == NATURAL_METHODS
