"""What can go wrong, and how the window helps out."""

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication

from crossview.view.colors import PROBLEM, valence_color
from tests.real_surfaces import PATHS
from tests.windowing import Hand

BLUE, RED = valence_color(3), valence_color(5)
PIECES = """\
v 0 0 0
v 1 0 0
v 0 1 0
v 5 0 0
v 6 0 0
v 5 1 0
v 6 1 0
f 1 2 3
f 4 5 6
f 5 7 6
"""


def test_several_pieces_the_largest_is_one_click_away(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    before = hand.state.document
    path = tmp_path / "pieces.obj"
    path.write_text(PIECES)
    hand.open(str(path))
    bar = hand.window.centre.message_bar
    assert bar.isVisible()
    assert hand.state.document is before  # nothing is lost
    assert hand.shows(BLUE, hand.place_of(0))
    (button,) = bar.action_buttons
    assert button.text() == "Use the largest piece"
    button.click()
    hand.wait(lambda: hand.state.document is not before)
    assert hand.state.document.surface.n_faces == 2
    assert not bar.isVisible()  # the cause is gone
    assert hand.window.surface_panel.notes.isVisible()


def test_a_file_that_did_not_open_is_not_the_one_opened_again(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.open(str(tmp_path / "missing.obj"))
    assert hand.said.startswith("no such file")
    hand.trigger("use-largest")
    assert hand.state.message is None
    assert hand.state.document.name == "disk-4"


def test_a_file_that_did_not_open_keeps_nothing_from_being_made(hand: Hand) -> None:
    hand.window.files.open("disk-4")
    while not hand.state.solved:
        QApplication.processEvents()
    assert hand.state.made.layout is None
    hand.open("missing.obj")
    hand.wait(lambda: hand.state.made.layout is not None)
    assert hand.state.message is not None


def test_what_could_not_be_written_is_forgotten_with_its_surface(
    hand: Hand, tmp_path: Path
) -> None:
    hand.open("disk-4")
    hand.window.files.export(tmp_path / "figure.docx")
    hand.wait()
    assert ".docx" in hand.said
    hand.open("square")
    assert hand.state.message is None


def test_bad_triangles_are_mended(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "bad.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 1 2 2\n")
    hand.open(str(path))
    assert hand.state.shown_surface.n_faces == 2
    assert hand.state.field is not None  # four corners: the budget holds


def test_where_the_trouble_is_can_be_seen(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "three at an edge.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 1 2 3\nf 1 3 4\nf 1 3 5\n")
    hand.open(str(path))
    bar = hand.window.centre.message_bar
    said = [button.text() for button in bar.action_buttons]
    assert said == ["Repair, use the largest piece", "Show where"]  # cut apart, it is in two
    bar.action_buttons[1].click()
    hand.wait(lambda: hand.state.faulty is not None)
    assert hand.window.viewport.isVisible()
    assert hand.shows(PROBLEM, hand.place((0.5, 0.5, 0.0)), line=True)
    assert not hand.shows(PROBLEM, hand.place((0.5, 0.0, 0.0)))
    hand.window.session.dismiss()  # dismissed
    assert hand.window.centre.empty.isVisible()


def test_poor_triangles_are_counted_and_pointed_out(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "sliver.obj"
    path.write_text("v 0 0 0\nv 4 0 0\nv 2 0.1 0\nv 2 3 0\nf 1 2 3\nf 1 3 4\nf 3 2 4\n")
    hand.open(str(path))
    problems = hand.window.surface_panel.problems
    assert problems.text() == "1 poor triangle"
    assert not hand.shows(PROBLEM)
    problems.hovered.emit(True)
    assert hand.shows(PROBLEM, hand.place((2.0, 0.0, 0.0)))
    problems.hovered.emit(False)
    assert not hand.shows(PROBLEM)


def test_a_failed_opening_takes_nothing_and_the_next_clears_the_bar(hand: Hand) -> None:
    hand.open("nothing.obj")
    assert hand.state.document is None
    assert hand.window.centre.empty.isVisible()
    assert hand.window.centre.message_bar.isVisible()
    hand.open("disk-4")
    assert not hand.window.centre.message_bar.isVisible()


def test_the_panel_says_what_a_click_would_do(hand: Hand) -> None:
    hand.open("annulus-near")
    panel = hand.window.validity_panel
    document = hand.state.document
    hand.key(Qt.Key.Key_3)
    spot = hand.place((-0.5, 0.45, 0.0))
    hand.move(spot)
    hand.wait()
    assert panel.budget.text.text() == "Index sum 1 of 0"
    assert panel.note.text() == "if placed here"
    assert hand.state.document is document
    hand.move(QPointF(2.0, 2.0))  # off the surface: nothing would be done
    assert panel.budget.text.text() == "Index sum 0 of 0"
    hand.key(Qt.Key.Key_Escape)
    assert hand.state.added_valence is None


def test_the_last_one_of_a_budget_shows_its_defects_before_it_is_placed(hand: Hand) -> None:
    """With the budget one short, the preview is a table look-up; the placed one solves the same."""
    hand.open("annulus-near")
    hand.click(hand.place_of(0))
    hand.key(Qt.Key.Key_Delete)
    hand.wait()
    assert hand.state.field is None
    hand.key(Qt.Key.Key_3)
    hand.move(hand.place((0.75, 0.1, 0.0)))
    hand.wait()
    predicted = hand.state.defects
    assert predicted is not None
    shown = hand.window.validity_panel.rows[0].value.text()
    hand.click(hand.place((0.75, 0.1, 0.0)))
    hand.wait(lambda: hand.state.solved)
    np.testing.assert_allclose(hand.state.solution.holonomy_defects, predicted, atol=1e-3)
    assert hand.window.validity_panel.rows[0].value.text() == shown
    assert hand.shows(BLUE, hand.place_of(7))


def test_any_valence_and_a_second_press_ends(hand: Hand) -> None:
    hand.open("torus")
    hand.key(Qt.Key.Key_N)
    assert hand.state.added_valence == 7
    hand.key(Qt.Key.Key_5)
    assert hand.state.added_valence == 5
    hand.key(Qt.Key.Key_5)
    assert hand.state.added_valence is None


def test_a_drag_in_the_add_tool_moves_and_adds_nothing(hand: Hand) -> None:
    hand.open("disk-4")
    hand.key(Qt.Key.Key_5)
    start, end = hand.place_of(0), hand.place((0.3, 0.3, 0.0))
    hand.drag(start, end)
    hand.release(end)
    hand.wait(lambda: hand.state.solved)
    assert len(hand.state.singularities) == 4
    assert hand.state.undo_name == "move singularity 1"
    assert hand.shows(BLUE, end)


def test_a_drag_is_one_step_however_long(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.state.document
    start = hand.place_of(0)
    hand.drag(start, start + QPointF(40.0, 30.0), steps=30)
    hand.release(start + QPointF(40.0, 30.0))
    hand.wait(lambda: hand.state.solved)
    hand.trigger("undo")
    assert hand.state.document is before


def test_validity_follows_a_drag_at_once(hand: Hand) -> None:
    """The rows are a table look-up: they are there before any field comes back."""
    hand.open("annulus-near")
    row = hand.window.validity_panel.rows[0]
    start, end = hand.place_of(0), hand.place((0.5, 0.6, 0.0))
    texts = [row.value.text()]
    hand.press(start)
    for step in range(1, 6):
        hand.move(start + (end - start) * (step / 5), Qt.MouseButton.LeftButton)
        texts.append(row.value.text())
    hand.release(end)
    assert len(set(texts)) >= 5
    hand.wait(lambda: hand.state.solved)
    final = np.degrees(hand.state.solution.holonomy_defects[0])
    assert row.value.text() == f"{final:.1f}°".replace("-", "−")


def test_dropped_on_the_boundary_is_told_and_undone(hand: Hand) -> None:
    hand.open("disk-4")
    trials, surface = hand.window.session.trials, hand.state.shown_surface
    rim = surface.point_at_vertex(int(surface.boundary_loops[0][0]))
    trials.start_drag(0)
    trials.drag_to(rim)
    trials.drop()
    hand.wait(lambda: hand.state.message is not None)
    assert "singularity 1 lies on the boundary" in hand.said
    assert hand.state.field is None
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.message is None
    assert hand.state.field is not None


@pytest.mark.parametrize("name", ["wingnut.obj", "plate_holes.stl", "pointy.obj"])
def test_real_surfaces_from_file_to_field(hand: Hand, name: str) -> None:
    hand.open(str(PATHS[name]))
    assert hand.state.field is None
    panel = hand.window.validity_panel
    labels = [button.text() for button in panel.buttons]
    all_of_them = [label for label in labels if label.startswith("Add all")]
    panel.buttons[labels.index((all_of_them or labels)[0])].click()
    hand.wait(lambda: hand.state.solved)
    assert hand.state.solution.field.max_closing_error < 1e-9
    color = BLUE if hand.state.singularities[0].valence == 3 else RED
    assert hand.shows(color)
