"""What a scene and a figure show of a state, without drawing either."""

from dataclasses import replace

import numpy as np
import pytest

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.session.document import Document
from crossview.session.hand import AddTool, Focus, MarkTool
from crossview.session.method_solver import MethodSolver
from crossview.session.pictures import figure_view, scene_view
from crossview.session.state import SessionState
from solvers.progress import run
from tests.crossview.session.headless import known


@pytest.fixture(scope="module")
def solved() -> SessionState:
    document = Document.from_case("near", Case.load(path_of("annulus-near")))
    opened = SessionState().document_changed(document, "open near", None)
    return opened.solution_found(run(MethodSolver().solve(document.problem)))


def test_the_singularities_are_drawn_where_they_are(solved: SessionState) -> None:
    view = scene_view(solved.focused(Focus(selected=2, others=frozenset({5}))))
    document = known(solved.document)
    places = document.surface.positions([s.point for s in document.singularities])
    np.testing.assert_allclose([m.position for m in view.singularities], places)
    assert [i for i, m in enumerate(view.singularities) if m.selected] == [2, 5]
    assert view.points is known(solved.base).surface.vertices


def test_a_preview_and_a_loop_are_shown_and_no_figure_has_them(solved: SessionState) -> None:
    tool = solved.tool_taken(AddTool(5)).focused(Focus(selected=0, condition=0))
    state = tool.previewed(known(solved.shown_surface).closest_point(np.array((0.0, 0.7, 0.0))))
    view = scene_view(replace(state, poor=True))
    assert known(view.preview).valence == 5
    path = known(state.base).solver.holonomy.conditions[0].path
    np.testing.assert_array_equal(known(view.loop), path)
    figure = figure_view(replace(state, poor=True), transparent=True)
    assert figure.preview is None
    assert figure.loop is None
    assert figure.problem is None
    assert not any(m.selected for m in figure.singularities)
    assert figure.transparent
    assert figure.H is view.H is not None
    marking = replace(solved, tool=MarkTool(0, np.array([0, 1])))
    assert scene_view(marking).loop is not None
    assert figure_view(marking, transparent=False).loop is None


def test_held_ranges_are_used_unless_the_user_has_chosen(solved: SessionState) -> None:
    held = {"H": (-2.0, 2.0)}
    assert scene_view(solved, held).layer("H").value_range == (-2.0, 2.0)
    chosen = solved.with_layer("H", replace(solved.layers["H"], value_range=(0.0, 1.0)))
    assert scene_view(chosen, held).layer("H").value_range == (0.0, 1.0)
