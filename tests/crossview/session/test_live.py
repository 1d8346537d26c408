import numpy as np
import pytest

from crossview.cases.model import Case
from crossview.session.document import Document
from crossview.session.live import LiveBase, LiveEdit, cut, prepare
from crossview.workflow.pipeline import Pipeline
from solvers.progress import run
from solvers.singularities import Singularity

ANGLES = np.radians([10.0, 100.0, 190.0, 280.0])


@pytest.fixture(scope="module")
def document() -> Document:
    """An annulus with two pairs of valence 3 and 5."""
    singularities = [
        {"position": [0.7 * np.cos(a), 0.7 * np.sin(a), 0.0], "valence": v}
        for a, v in zip(ANGLES, (3, 5, 3, 5), strict=True)
    ]
    return Document.from_case(
        "annulus",
        Case.from_json({"surface": {"builtin": "annulus"}, "singularities": singularities}),
    )


@pytest.fixture(scope="module")
def base(document: Document) -> LiveBase:
    return LiveBase.from_solution(run(Pipeline().solve(document.problem)))


def test_untouched_the_live_field_is_the_solution(document: Document) -> None:
    solution = run(Pipeline().solve(document.problem))
    edit = LiveEdit.start(document, LiveBase.from_solution(solution))
    field = run(edit.solve())
    np.testing.assert_allclose(field.H, solution.field.H, atol=1e-12)
    np.testing.assert_allclose(edit.defects(), solution.holonomy_defects, atol=1e-12)


def test_the_look_up_while_dragging_is_what_a_solve_says(
    document: Document, base: LiveBase
) -> None:
    edit = LiveEdit.start(document, base)
    for angle in np.radians([12.0, 20.0, 40.0]):
        target = (0.6 * np.cos(angle), 0.6 * np.sin(angle), 0.0)
        moved = edit.moved(0, base.surface.closest_point(target))
        np.testing.assert_allclose(moved.defects(), run(moved.solve()).defects, atol=1e-9)


def test_dragging_follows_the_closed_form(document: Document, base: LiveBase) -> None:
    """On an annulus r = wrap(sum k_j phi_j / 4): turning one +1 by d turns r by d / 4."""
    edit = LiveEdit.start(document, base)
    before = edit.defects()[0]
    for turn in np.radians([4.0, 20.0]):
        angle = ANGLES[0] + turn
        target = (0.7 * np.cos(angle), 0.7 * np.sin(angle), 0.0)
        after = edit.moved(0, base.surface.closest_point(target)).defects()[0]
        change = (after - before + np.pi / 4) % (np.pi / 2) - np.pi / 4
        # picks lie on chords of the round annulus: its polygon is not quite round
        assert abs(change) == pytest.approx(turn / 4, rel=0.02)


def test_points_go_to_the_refined_surface_and_back(document: Document, base: LiveBase) -> None:
    assert base.surface.n_faces > document.surface.n_faces
    for singularity in document.singularities:
        there = base.refinement.locate(singularity.point)
        back = base.refinement.lift(there)
        np.testing.assert_allclose(
            document.surface.position(back),
            document.surface.position(singularity.point),
            atol=1e-12,
        )


def test_what_is_not_yet_solved_is_located_by_position(document: Document, base: LiveBase) -> None:
    new = Singularity(document.surface.closest_point((0.0, 0.8, 0.0)), 5)
    edit = LiveEdit.start(document.with_singularities([*document.singularities, new]), base)
    np.testing.assert_allclose(
        base.surface.position(edit.singularities[-1].point),
        document.surface.position(new.point),
        atol=1e-12,
    )


def test_a_surface_is_prepared_without_a_valid_configuration(document: Document) -> None:
    bare = document.with_singularities(document.singularities[:3])
    assert not bare.budget.satisfied
    base = run(prepare(bare))
    assert base.surface is document.surface
    edit = LiveEdit.start(bare, base)
    completed = edit.added(document.singularities[3])
    full = LiveEdit.start(document, base)
    np.testing.assert_allclose(completed.defects(), full.defects(), atol=1e-12)


def test_cut_graph_touches_every_singularity(document: Document) -> None:
    solution = run(Pipeline().solve(document.problem))
    edges = run(cut(solution))
    assert set(solution.refinement.vertices.tolist()) <= set(edges.ravel().tolist())
