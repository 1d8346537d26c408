"""From an empty window to a figure, as a newcomer goes."""

from pathlib import Path

import numpy as np
from PIL import Image
from PySide6.QtCore import QPointF, Qt

from crossview.view.colors import valence_color
from tests.windowing import Hand, count_color

BLUE, RED, ORANGE = valence_color(3), valence_color(5), valence_color(6)


def test_open_add_drag_undo_redo_delete_export(hand: Hand, tmp_path: Path) -> None:
    window = hand.window
    assert window.centre.stack.currentWidget() is window.centre.empty

    # a disk needs four; one press of 3 carries a dot, each click places one
    hand.open("disk")
    assert hand.state.document.surface.genus == 0
    assert hand.state.field is None
    assert not hand.shows(BLUE)
    hand.key(Qt.Key.Key_3)
    assert hand.state.added_valence == 3
    spots = [(0.5, 0.1, 0.0), (-0.1, 0.5, 0.0), (-0.5, -0.1, 0.0), (0.1, -0.5, 0.0)]
    for count, spot in enumerate(spots, start=1):
        hand.click(hand.place(spot))
        hand.wait()
        assert len(hand.state.singularities) == count
        assert window.validity_panel.budget.text.text() == f"Index sum {count} of 4"
    np.testing.assert_allclose(
        hand.state.document.surface.positions([s.point for s in hand.state.singularities]),
        spots,
        atol=0.01,
    )
    hand.key(Qt.Key.Key_3)  # a second press ends
    assert hand.state.added_valence is None

    # the budget holds: the field is there, aligned with the circle
    hand.wait(lambda: hand.state.field is not None)
    assert np.abs(hand.state.field.boundary_misalignment).max() < 1e-6
    assert all(hand.shows(BLUE, hand.place_of(i)) for i in range(4))

    # drag one: the field follows before the mouse is let go
    solved = hand.state.field
    start, end = hand.place_of(0), hand.place((0.7, 0.3, 0.0))
    hand.drag(start, end)
    hand.wait(lambda: hand.state.field is not solved)
    followed = hand.state.field
    assert followed.surface is solved.surface
    assert not np.allclose(followed.H, solved.H, atol=1e-3)
    assert hand.shows(BLUE, end)
    assert not hand.shows(BLUE, start)
    assert hand.state.undo_name == "add valence 3"

    # let go: one step, and a refined solution
    hand.release(end)
    hand.wait(lambda: hand.state.solution.problem is hand.state.document.problem)
    assert hand.state.field is hand.state.solution.field
    assert hand.state.field.surface is not solved.surface
    assert hand.state.undo_name == "move singularity 1"

    # undo and redo
    hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    hand.wait()
    assert hand.shows(BLUE, start)
    assert not hand.shows(BLUE, end)
    np.testing.assert_allclose(hand.state.field.H[:100], solved.H[:100], atol=1e-12)
    hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    hand.wait()
    assert hand.shows(BLUE, end)
    assert not hand.shows(BLUE, start)

    # the figure shows the same
    hand.window.files.export(tmp_path / "figure.png")
    hand.wait()
    assert hand.state.message is None
    figure = np.asarray(Image.open(tmp_path / "figure.png").convert("RGB"))
    assert figure.shape == (1200, 1600, 3)
    assert count_color(figure, BLUE) > 4 * 50

    # delete the selected one: the budget is missed, the field gone
    assert hand.state.focus.selected == 0
    hand.key(Qt.Key.Key_Delete)
    hand.wait()
    assert len(hand.state.singularities) == 3
    assert hand.state.field is None
    assert not hand.shows(BLUE, end)
    assert window.validity_panel.budget.text.text() == "Index sum 3 of 4"


def test_wheel_changes_the_valence_and_the_panel_mends(hand: Hand) -> None:
    hand.open("disk-4")
    panel = hand.window.validity_panel
    assert hand.state.budget.satisfied
    place = hand.place_of(2)
    hand.wheel(place, 1)
    hand.wait()
    assert [s.valence for s in hand.state.singularities] == [3, 3, 5, 3]
    assert hand.state.undo_name == "make singularity 3 a valence 5"
    assert hand.shows(RED, place)
    assert hand.state.field is None
    assert panel.budget.text.text() == "Index sum 2 of 4"
    labels = [button.text() for button in panel.buttons]
    assert "Add one valence 3" in labels
    panel.buttons[labels.index("Add all 2 valence 3")].click()
    hand.wait(lambda: hand.state.field is not None)
    assert hand.state.budget.satisfied
    assert len(hand.state.singularities) == 6
    assert panel.buttons == []
    hand.wheel(place, 1)
    hand.wait()
    assert hand.state.singularities[2].valence == 6
    assert hand.shows(ORANGE, place)


def test_the_wheel_elsewhere_moves_the_camera(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.place((1.0, 0.0, 0.0))
    hand.wheel(hand.place((0.05, 0.05, 0.0)), 2)
    after = hand.place((1.0, 0.0, 0.0))
    assert (after - before).manhattanLength() > 5
    assert [s.valence for s in hand.state.singularities] == [3, 3, 3, 3]


def test_a_press_elsewhere_turns_the_view_and_changes_nothing(hand: Hand) -> None:
    hand.open("sphere-cube")
    document = hand.state.document
    top = hand.place((0.0, 0.0, 1.0))
    middle = QPointF(hand.canvas.width() / 2 + 30, hand.canvas.height() / 2 + 10)
    assert hand.window.viewport.singularity_at(middle) is None
    hand.drag(middle, middle + QPointF(120.0, 30.0))
    hand.release(middle + QPointF(120.0, 30.0))
    assert (hand.place((0.0, 0.0, 1.0)) - top).manhattanLength() > 5
    assert hand.state.document is document


def test_escape_during_a_drag_puts_it_back(hand: Hand) -> None:
    hand.open("disk-4")
    document, start = hand.state.document, hand.place_of(1)
    hand.drag(start, start + QPointF(60.0, 40.0))
    hand.wait()
    hand.key(Qt.Key.Key_Escape)
    hand.release(start + QPointF(60.0, 40.0))
    hand.wait(lambda: hand.state.field is hand.state.solution.field)
    assert hand.state.document is document
    assert hand.shows(BLUE, start)


def test_locked_ones_stay(hand: Hand) -> None:
    hand.open("disk-4")
    hand.click(hand.place_of(0))
    assert hand.state.focus.selected == 0
    hand.trigger("lock")
    assert hand.state.singularities[0].locked
    point, start = hand.state.singularities[0].point, hand.place_of(0)
    hand.drag(start, start + QPointF(80.0, 0.0))
    hand.release(start + QPointF(80.0, 0.0))
    hand.wait()
    assert hand.state.singularities[0].point == point


def test_keys_change_the_valence_of_the_selected(hand: Hand) -> None:
    hand.open("disk-4")
    hand.click(hand.place_of(1))
    hand.key(Qt.Key.Key_Plus)
    assert hand.state.singularities[1].valence == 5
    assert hand.shows(RED, hand.place_of(1))
    hand.key(Qt.Key.Key_Minus)
    hand.key(Qt.Key.Key_Minus)
    assert hand.state.singularities[1].valence == 2
    hand.wait()
    assert hand.shows(valence_color(2), hand.place_of(1))


def test_a_transparent_figure_of_the_size_and_scale_asked(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    panel = hand.window.export_panel
    panel.width_box.setValue(300)
    panel.height_box.setValue(200)
    panel.scale_box.setValue(2)
    panel.transparent_box.setChecked(True)
    assert panel.result.text() == "600 × 400 pixels"
    assert (panel.across_box.value(), panel.up_box.value()) == (50.8, 33.9)
    hand.window.files.export(tmp_path / "disk.png")
    hand.wait()
    picture = np.asarray(Image.open(tmp_path / "disk.png"))
    assert picture.shape == (400, 600, 4)
    assert picture[2, 2, 3] == 0
    assert (picture[..., 3] == 255).mean() > 0.2


def test_a_figure_shows_the_view_and_layers_of_the_window(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    for name in ("singularities", "separatrices"):
        hand.window.session.looks.toggle_layer(name)
    hand.window.files.export(tmp_path / "without.png")
    hand.wait()
    without = np.asarray(Image.open(tmp_path / "without.png").convert("RGB"))
    assert count_color(without, BLUE) == 0


def test_a_figure_that_cannot_be_written_is_told(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.window.files.export(tmp_path / "figure.jpeg")
    hand.wait()
    assert "figure.jpeg" in hand.said
    hand.window.files.export(tmp_path / "figure.png")
    hand.wait()
    assert hand.state.message is None


def test_the_window_goes_on_while_a_figure_is_written(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.window.files.export(tmp_path / "before.png")
    assert hand.window.files.busy
    assert not (tmp_path / "before.png").exists()
    assert hand.window.statusBar().currentMessage().startswith("Writing ")
    hand.window.session.edits.step_valence(1, 0)  # the figure is of what was shown
    hand.window.session.looks.toggle_layer("legend")
    hand.wait()
    assert hand.window.statusBar().currentMessage().startswith("Wrote ")
    picture = np.asarray(Image.open(tmp_path / "before.png").convert("RGB"))
    assert count_color(picture, BLUE) > 0
    assert count_color(picture, valence_color(5)) == 0


def test_a_window_that_closes_writes_its_last_figure(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.window.files.export(tmp_path / "last.png")
    hand.window.close()
    with Image.open(tmp_path / "last.png") as figure:
        assert figure.size == (1600, 1200)
