"""Whatever happens in whatever order: what is shown together belongs together."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.session.commands import ChooseMethod, RemoveSingularities
from crossview.session.document import Document
from crossview.session.live import LiveBase, LiveEdit, cut, prepare
from crossview.session.live_tracer import Traced
from crossview.session.meshes import Meshes
from crossview.session.method_solver import MethodSolver, MethodStep
from crossview.session.shown import Solved
from crossview.session.state import SessionState
from crossview.session.waypoints import Waypoint
from solvers.progress import Progress, run
from tests.crossview.session.headless import known


@dataclass(frozen=True)
class Happenings:
    """What may happen around one annulus, computed once; none but the first need be in time."""

    documents: tuple[Document, ...]
    solved: tuple[Solved, ...]
    steps: tuple[MethodStep, ...]
    plain: LiveBase
    edges: np.ndarray


@cache
def happenings() -> Happenings:
    case = replace(Case.load(path_of("annulus-near")), method="isotropic")
    document = Document.from_case("near", case)
    anisotropic = ChooseMethod("anisotropic").apply(document)
    fewer = RemoveSingularities(frozenset({0})).apply(document)
    seen: list[Progress] = []
    solved = (
        run(MethodSolver().solve(document.problem)),
        run(MethodSolver().solve(anisotropic.problem), seen.append),
    )
    steps = [step for step in seen if isinstance(step, MethodStep)]
    return Happenings(
        (document, anisotropic, fewer),
        solved,
        (steps[0], replace(steps[-1], field=None)),
        run(prepare(document)),
        run(cut(solved[0].solution)),
    )


def waypoint(state: SessionState, on_plain: bool, drawn: bool) -> SessionState:
    """Singularities on their way, their field on the kept surface or that before refinement."""
    document, base = state.document, happenings().plain if on_plain else state.base
    if document is None or not document.budget.satisfied:
        return state
    field = None
    if drawn and base is not None:
        field = run(LiveEdit.start(document, base).solve())
    return state.progressed(Waypoint("moving", 0.5, document.singularities, None, field))


def tried(state: SessionState, which: int, traced: bool) -> SessionState:
    """A step of a drag, answered at once."""
    surface = state.shown_surface
    if surface is None or state.document is None or which >= len(state.document.singularities):
        return state
    place = np.array((0.7 * np.cos(which), 0.7 * np.sin(which), 0.0))
    held = state.taken_hold(which).dragged_to(surface.closest_point(place))
    edit = known(held.trial).edit
    if edit is None or held.field is None:
        return held
    last = held.last
    curves = last.meshes.separatrices if traced and last is not None else None
    return held.field_tried(Traced(run(edit.solve()), curves))


Event = Callable[[SessionState], SessionState]


def event(name: str, number: int, yes: bool, also: bool) -> Event:
    there = happenings()
    events: dict[str, Event] = {
        "opened": lambda s: s.document_changed(there.documents[number], "edit", None),
        "solved": lambda s: s.solution_found(there.solved[number % 2]),
        "iterated": lambda s: s.progressed(there.steps[number % 2]),
        "moved": lambda s: waypoint(s, yes, also),
        "progressed": lambda s: s.progressed(Progress("at work", 0.5) if yes else None),
        "ended": lambda s: s.work_ended(),
        "tried": lambda s: tried(s, number, yes),
        "let go": lambda s: s.let_go(),
        "put back": lambda s: s.put_back(),
        "failed": lambda s: s.no_solution(),
        "prepared": lambda s: s.base_prepared(there.plain),
        "cut": lambda s: s.cut_along(there.solved[number % 2].solution, there.edges),
        "made": lambda s: s.meshes_made(Meshes(there.solved[number % 2].field, settled=True)),
    }
    return events[name]


NAMES = (
    "opened", "solved", "iterated", "moved", "progressed", "ended", "tried", "let go",
    "put back", "failed", "prepared", "cut", "made",
)  # fmt: skip
EVENTS = st.tuples(st.sampled_from(NAMES), st.integers(0, 2), st.booleans(), st.booleans())


@settings(max_examples=150, deadline=None)
@given(st.lists(EVENTS, max_size=25))
def test_what_is_shown_together_belongs_together(
    happened: list[tuple[str, int, bool, bool]],
) -> None:
    state = SessionState().document_changed(happenings().documents[0], "open", None)
    for name, number, yes, also in happened:
        before, said = state, (state.field, state.base, state.singularities)
        state = event(name, number, yes, also)(state)
        assert (before.field, before.base, before.singularities) == said  # frozen
        if state.field is not None:
            assert state.field.surface is state.shown_surface
        if state.base is not None:
            assert state.base.refinement.coarse is known(state.document).surface
        if state.cut_graph is not None:
            assert state.field is known(state.solution).field
        assert state.made.of in (None, state.field)
        assert not (state.iterating and state.moving)
        if state.solved:
            assert known(state.solution).problem is known(state.document).problem
        if state.document is None:
            assert (state.field, state.base, state.solution) == (None, None, None)
            assert state.singularities == ()
