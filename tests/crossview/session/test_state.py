"""What is shown follows from what happens, and its parts agree: no window, no thread."""

from dataclasses import replace

import numpy as np
import pytest

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.session.commands import (
    AddSingularities,
    ChooseMethod,
    LockSingularity,
    MoveSingularity,
    RemoveSingularities,
)
from crossview.session.document import Document
from crossview.session.hand import AddTool, Focus, MarkTool, SelectTool
from crossview.session.live import LiveEdit, cut, prepare
from crossview.session.live_tracer import Traced
from crossview.session.meshes import Meshes, trace
from crossview.session.message import Message
from crossview.session.method_solver import MethodSolver, MethodStep
from crossview.session.shown import Iterating, Moving, Nothing, Provisional, Solved
from crossview.session.state import SessionState
from crossview.session.waypoints import Waypoint
from solvers.progress import Progress, run
from tests.crossview.session.headless import known


@pytest.fixture(scope="module")
def document() -> Document:
    case = replace(Case.load(path_of("annulus-near")), method="isotropic")
    return Document.from_case("near", case)


@pytest.fixture(scope="module")
def found(document: Document) -> Solved:
    return run(MethodSolver().solve(document.problem))


@pytest.fixture(scope="module")
def iterates(document: Document) -> list[MethodStep]:
    anisotropic = ChooseMethod("anisotropic").apply(document)
    seen: list[Progress] = []
    run(MethodSolver().solve(anisotropic.problem), seen.append)
    return [step for step in seen if isinstance(step, MethodStep)]


@pytest.fixture
def solved(document: Document, found: Solved) -> SessionState:
    """The state after a case was opened and solved."""
    opened = SessionState().document_changed(document, "open near", None)
    assert isinstance(opened.shown, Nothing)
    assert not opened.solved
    return agreeing(opened.solution_found(found))


def agreeing(state: SessionState) -> SessionState:
    """What is drawn is on one surface, and what is made of a field is of the one drawn."""
    if state.field is not None:
        assert state.field.surface is state.shown_surface
    if state.cut_graph is not None:
        assert state.field is state.solution.field
    assert state.made.of in (None, state.field)
    return state


def test_a_solution_is_shown_with_what_is_made_of_it(
    solved: SessionState, found: Solved, document: Document
) -> None:
    assert solved.solved
    assert solved.field is found.solution.field
    assert solved.shown_problem is document.problem
    np.testing.assert_allclose(known(solved.defects), known(found.solution.holonomy_defects))
    edges = run(cut(found.solution))
    made = run(trace(found.solution, Meshes(solved.field)))
    whole = agreeing(solved.cut_along(found.solution, edges).meshes_made(made))
    assert whole.cut_graph is edges
    assert whole.separatrices is made.separatrices
    assert solved.cut_graph is None  # the state before is as it was
    # solved again, the same solution keeps what was made of it
    assert whole.solution_found(found).meshes is made
    # what was made of another is not taken
    other = run(MethodSolver().solve(document.problem)).solution
    assert whole.cut_along(other, edges[:1]) is whole
    assert whole.meshes_made(Meshes(other.field)) is whole


def test_dragging(solved: SessionState, document: Document) -> None:
    held = solved.taken_hold(0)
    assert held.focus.selected == 0
    target = held.base.surface.closest_point((0.75, 0.15, 0.0))
    dragged = agreeing(held.dragged_to(target))
    position = document.surface.position(dragged.singularities[0].point)
    np.testing.assert_allclose(position, (0.75, 0.15, 0.0), atol=1e-12)
    assert dragged.singularities[1:] == document.singularities[1:]
    assert dragged.document is document
    live = run(dragged.trial.edit.solve())
    np.testing.assert_allclose(known(dragged.defects), live.defects, atol=1e-9)

    tried = agreeing(dragged.field_tried(Traced(live, None)))
    assert isinstance(tried.shown, Provisional)
    assert tried.field is live
    assert tried.solution is solved.solution
    assert tried.shown_problem is None
    assert tried.cut_graph is None
    assert tried.made.separatrices is None

    # dropped: one step of the document, the field stays until there is a better one
    moved = MoveSingularity(0, tried.trial.held.point).apply(document)
    dropped = agreeing(tried.let_go().document_changed(moved, "move singularity 1", None))
    assert dropped.trial is None
    assert dropped.field is live
    assert not dropped.solved
    assert dropped.focus.selected == 0


def test_a_drag_put_back_leaves_no_trace(solved: SessionState, found: Solved) -> None:
    edges = run(cut(found.solution))
    before = solved.cut_along(found.solution, edges)
    held = before.taken_hold(2)
    dragged = held.dragged_to(held.base.surface.closest_point((0.0, -0.5, 0.0)))
    tried = dragged.field_tried(Traced(run(dragged.trial.edit.solve()), None))
    back = agreeing(tried.let_go().put_back())
    assert back.shown is before.shown
    assert back.singularities is before.singularities


def test_what_is_locked_is_not_taken_hold_of(solved: SessionState, document: Document) -> None:
    locked = LockSingularity(1, True).apply(document)
    state = solved.document_changed(locked, "lock singularity 2", None)
    assert state.taken_hold(1) is state
    assert state.dragged_to(document.singularities[0].point) is state
    assert state.taken_hold(0).trial.drag


def test_iterating_and_what_is_left_of_it(
    solved: SessionState, document: Document, iterates: list[MethodStep]
) -> None:
    anisotropic = ChooseMethod("anisotropic").apply(document)
    chosen = agreeing(solved.document_changed(anisotropic, "choose method", None))
    assert chosen.field is solved.field  # until there is an iterate
    assert not chosen.solved
    first, last = iterates[0], replace(iterates[-1], field=None)
    running = agreeing(chosen.progressed(first))
    assert isinstance(running.shown, Iterating)
    assert running.field is first.field
    assert running.start is first.start
    assert running.shown_problem is anisotropic.problem
    assert running.solution is solved.solution
    # an iterate that is not to be drawn changes what is known, not what is seen
    later = agreeing(running.progressed(last))
    assert later.drawn is running.drawn
    assert later.iterating.step is last.step
    # the background at rest, it is still there to be kept; other work ends it
    assert later.progressed(None).iterating is later.iterating
    ended = agreeing(later.progressed(None).work_ended())
    assert ended.iterating is None
    assert ended.field is first.field
    kept = run(MethodSolver().solve(anisotropic.problem))
    assert agreeing(ended.solution_found(kept)).solved


def test_singularities_on_their_way(solved: SessionState, document: Document) -> None:
    target = solved.base.surface.closest_point((0.75, 0.15, 0.0))
    edit = LiveEdit.start(document, known(solved.base)).moved(0, target)
    field = run(edit.solve())
    places = (replace(document.singularities[0], point=target), *document.singularities[1:])
    way = Waypoint("moving", 0.5, places, edit.defects(), field)
    moving = agreeing(solved.progressed(way))
    assert isinstance(moving.shown, Moving)
    assert moving.singularities is places
    assert moving.field is field
    np.testing.assert_allclose(known(moving.defects), field.defects, atol=1e-9)
    # with no field of their own the one before stays
    assert moving.progressed(replace(way, field=None)).field is field
    rested = moving.progressed(None)
    assert rested.singularities is document.singularities
    assert agreeing(rested.put_back()).shown is solved.shown
    # a field on the surface before refinement takes the refined one away
    plain = run(LiveEdit.start(document, run(prepare(document))).solve())
    assert plain.surface is document.surface is not solved.base.surface
    agreeing(solved.progressed(replace(way, field=plain)))


def test_indices_that_do_not_add_up_have_no_field(solved: SessionState, document: Document) -> None:
    fewer = RemoveSingularities(frozenset({7})).apply(document)
    selected = solved.focused(Focus(selected=7, others=frozenset({2}), pinned=0))
    refused = agreeing(selected.document_changed(fewer, "delete singularity 8", None))
    assert refused.field is None
    assert refused.solution is None
    assert refused.defects is None
    assert not refused.valid
    assert refused.focus == Focus(pinned=0)  # what was selected is gone
    assert refused.base is solved.base  # what would mend it can be tried
    mended = replace(refused, tool=AddTool(document.singularities[7].valence))
    tried = mended.previewed(refused.base.refinement.locate(document.singularities[7].point))
    assert tried.budget.satisfied
    np.testing.assert_allclose(known(tried.defects), known(solved.defects), atol=1e-6)
    assert tried.previewed(None).trial is None


def test_a_failed_solve_leaves_nothing_but_the_surface(solved: SessionState) -> None:
    failed = agreeing(solved.no_solution())
    assert isinstance(failed.shown, Nothing)
    assert failed.base is solved.base
    assert failed.solution is None


def test_another_surface_takes_all_that_was_of_this_one(solved: SessionState) -> None:
    other = Document.from_case("disk", Case.load(path_of("disk-4")))
    focused = solved.focused(Focus(selected=0, hovered=1, condition=0, pinned=0))
    for tool, kept in ((MarkTool(3), SelectTool()), (AddTool(5), AddTool(5))):
        state = focused.tool_taken(tool).document_changed(other, "open disk", None)
        assert isinstance(state.shown, Nothing)
        assert state.base is None
        assert state.focus == Focus()
        assert state.tool == kept


def test_a_message_goes_with_its_cause(solved: SessionState, document: Document) -> None:
    said = solved.said(Message("no", "edit"))
    assert said.unsaid("open", "save") is said
    assert said.unsaid("edit").message is None
    more = AddSingularities(document.singularities[:1]).apply(document)
    assert said.document_changed(more, "add", None).message is None


def test_the_tool_of_any_valence_carries_another_at_once_when_in_hand() -> None:
    state = SessionState()
    assert state.any_valence_chosen(9).tool == SelectTool()
    assert state.tool_taken(AddTool(3)).any_valence_chosen(9).added_valence == 3
    assert state.tool_taken(AddTool(7)).any_valence_chosen(9).added_valence == 9


def test_two_are_selected_with_the_second_held() -> None:
    focus = Focus().on(2).on(4, both=True)
    assert focus.pair == (2, 4)
    assert focus.on(4, both=True).pair is None  # the same one twice
    assert focus.on(1).pair is None
    assert focus.among(5, 3) == Focus()
    assert focus.among(6, 5) == Focus(selected=4)
