"""What the window shows and says is true at every moment, and every key does what it says."""

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QDoubleSpinBox,
    QFrame,
    QLabel,
    QSpinBox,
    QTabBar,
    QToolTip,
)

from crossview.session.commands import ChangeValence, Together
from crossview.session.pictures import figure_view, scene_view
from crossview.session.waypoints import NATURAL_LABELS
from crossview.view.colors import BAD, CONDITIONS, GOOD, rgb
from crossview.view.scalars import SURFACE_SCALARS
from tests.windowing import Hand

CTRL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


def valences(hand: Hand) -> list[int]:
    return [s.valence for s in hand.state.document.singularities]


def patch(hand: Hand, index: int) -> np.ndarray:
    """The inner half of the disc of a singularity, as it is drawn."""
    place, reach = hand.place_of(index).toPoint(), 5
    rows = slice(place.y() - reach, place.y() + reach + 1)
    return hand.picture()[rows, place.x() - reach : place.x() + reach + 1].astype(int)


def test_return_ends_the_editing_of_a_valence_and_undo_hears_its_key_again(hand: Hand) -> None:
    hand.open("disk-4")
    hand.canvas.setFocus()
    hand.click(hand.place_of(0))
    hand.key(Qt.Key.Key_Return)
    editor = QApplication.focusWidget()
    assert isinstance(editor, QSpinBox)
    QTest.keyClick(editor, Qt.Key.Key_5)
    QTest.keyClick(editor, Qt.Key.Key_Return)
    hand.wait(lambda: valences(hand) == [5, 3, 3, 3])
    assert not hand.window.singularities_panel.table.findChildren(QSpinBox)
    assert QApplication.focusWidget() is hand.canvas
    hand.key(Qt.Key.Key_Z, CTRL)
    hand.wait()
    assert valences(hand) == [3, 3, 3, 3]


def test_a_valence_that_there_is_not_is_refused_with_the_reason(hand: Hand) -> None:
    hand.open("disk-4")
    for valence, reason in ((99, "valence 99 is not offered"), (4, "valence 4 is regular")):
        hand.window.session.edits.change_valence(0, valence)
        assert hand.said.startswith(reason)
        assert valences(hand) == [3, 3, 3, 3]


def test_delete_lock_and_valence_act_on_all_that_are_selected_as_one_step(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.canvas.setFocus()
    hand.key(Qt.Key.Key_A, CTRL)
    assert hand.state.focus.all == tuple(range(8))
    hand.key(Qt.Key.Key_L)
    hand.wait()
    assert all(s.locked for s in hand.state.singularities)
    hand.key(Qt.Key.Key_Plus)
    hand.wait()
    assert valences(hand) == [5] * 8
    hand.trigger("undo")
    assert valences(hand) == [3] * 8
    hand.window.session.pointer.select(1)
    hand.window.session.pointer.select(4, both=True)
    hand.window.session.pointer.select(6, both=True)
    assert len(hand.state.focus.all) == 3
    hand.window.session.pointer.select(4, both=True)  # a second time takes it away
    assert sorted(hand.state.focus.all) == [1, 6]
    hand.key(Qt.Key.Key_Delete)
    hand.wait()
    assert len(valences(hand)) == 6
    hand.trigger("undo")
    assert len(valences(hand)) == 8


def test_tab_reaches_every_panel(hand: Hand) -> None:
    hand.open("disk-4")
    hand.canvas.setFocus()
    reached, tabs = set(), False
    for _ in range(60):
        focus = QApplication.focusWidget()
        assert focus is not None
        tabs |= isinstance(focus, QTabBar)
        for title, dock in hand.window.docks.items():
            if dock.isAncestorOf(focus):
                reached.add(title)
        QTest.keyClick(focus, Qt.Key.Key_Tab)
    assert {"Surface", "Singularities", "Layers"} <= reached
    assert tabs  # whose arrow keys change between the other panels


def test_space_opens_and_shuts_the_eye_of_a_layer(hand: Hand) -> None:
    layers = hand.window.layers_panel.list
    layers.setFocus()
    layers.select("surface")
    QTest.keyClick(layers, Qt.Key.Key_Space)
    assert not hand.state.layers["surface"].visible
    QTest.keyClick(layers, Qt.Key.Key_Space)
    assert hand.state.layers["surface"].visible


def test_all_layers_are_seen_in_a_small_window_and_a_click_on_an_eye_shuts_it(hand: Hand) -> None:
    hand.open("disk-4")
    panel = hand.window.layers_panel
    area = panel.list.viewport().rect()
    rows = [panel.list.visualItemRect(panel.list.item(i)) for i in range(panel.list.count())]
    assert all(area.contains(row) for row in rows)
    assert panel.list.viewport().visibleRegion().boundingRect() == area
    for editor in panel.editors.values():  # none higher than there is room for
        panel.settings.setCurrentWidget(editor)
        QApplication.processEvents()
        bottom = panel.settings.geometry().bottom()
        assert panel.settings.height() >= editor.sizeHint().height()
        assert bottom <= panel.rect().bottom()
    names = [panel.list.item(i).text() for i in range(panel.list.count())]
    row = rows[names.index("Legend")]
    QTest.mouseClick(panel.list.viewport(), LEFT, pos=row.topLeft() + QPoint(10, 8))
    assert not hand.state.layers["legend"].visible
    QTest.mouseClick(panel.list.viewport(), LEFT, pos=row.center())  # its name
    assert not hand.state.layers["legend"].visible


def test_all_fits_on_a_screen_of_1080_lines_at_twice_the_size(hand: Hand) -> None:
    window = hand.window
    window.resize(960, 500)  # what a title bar and a task bar leave
    hand.open("annulus-near")
    hand.trigger("method-isotropic")
    QApplication.processEvents()
    assert (window.width(), window.height()) == (960, 500)
    actions = window.validity_panel.places
    for widget in (
        window.statusBar(),
        actions.make_valid,
        window.validity_panel.rows[0],
        window.solve_button,
    ):
        assert widget.visibleRegion().boundingRect() == widget.rect()
    layers = window.layers_panel.list
    for i in range(layers.count()):
        words = layers.fontMetrics().horizontalAdvance(layers.item(i).text())
        row = layers.visualItemRect(layers.item(i))
        assert layers.mapTo(window.layers_panel, row.topRight()).x() < window.layers_panel.width()
        assert words < row.width() - layers.iconSize().width()
    (tabs,) = (bar for bar in window.findChildren(QTabBar) if bar.count() == 3)
    for i in range(tabs.count()):
        assert tabs.fontMetrics().horizontalAdvance(tabs.tabText(i)) < tabs.tabRect(i).width() - 8
    assert tabs.tabRect(2).right() < tabs.width()


def test_the_surface_is_coloured_by_what_the_box_says(hand: Hand) -> None:
    hand.open("annulus-near")
    hand.wait(lambda: hand.state.solved)
    box = hand.window.layers_panel.scalar
    assert box.currentText() == "H"
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_Down)
    assert [n for n in SURFACE_SCALARS if hand.state.layers[n].visible] == ["theta"]
    QTest.keyClick(box, Qt.Key.Key_Home)
    assert not any(hand.state.layers[n].visible for n in SURFACE_SCALARS)
    hand.trigger("layer-aspect")
    assert box.currentText() == "Aspect"


def test_layers_under_quads_are_pale_in_the_list(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.layers["quads"].visible)
    assert hand.state.covered == {"surface", "crosses"}
    hand.trigger("layer-quads")
    assert not hand.state.covered


def test_one_scalar_is_shown_at_a_time_and_comparing_gives_it_back(hand: Hand) -> None:
    hand.open("annulus-near")
    hand.wait(lambda: hand.state.solved and hand.state.start is not None)

    def seen() -> list[str]:
        return [name for name in SURFACE_SCALARS if hand.state.layers[name].visible]

    hand.trigger("layer-theta")
    assert seen() == ["theta"]
    hand.trigger("compare")
    assert seen() == ["error"]
    hand.trigger("compare")
    assert seen() == ["theta"]
    hand.trigger("layer-H")
    assert seen() == ["H"]


def test_a_range_typed_the_wrong_way_round_says_why_it_is_not_taken(hand: Hand) -> None:
    hand.open("disk-4")
    hand.window.layers_panel.scalar.setFocus()  # below it are its settings
    editor = hand.window.layers_panel.editors["H"]
    low, high = editor.findChildren(QDoubleSpinBox)
    hand.window.session.looks.set_layer("H", type(hand.state.layers["H"])(value_range=(-1.0, 1.0)))
    low.setValue(5.0)
    high.setValue(-5.0)
    (wrong,) = (label for label in editor.findChildren(QLabel) if "smaller" in label.text())
    assert wrong.isVisible()
    assert hand.state.layers["H"].value_range == (-1.0, 1.0)
    high.setValue(7.0)
    assert not wrong.isVisible()
    assert hand.state.layers["H"].value_range == (5.0, 7.0)


def test_what_a_title_says_ends_with_the_first_edit(hand: Hand) -> None:
    hand.open("annulus-near")
    title = scene_view(hand.state).title
    hand.trigger("method-aligned")  # says nothing against it
    assert scene_view(hand.state).title == title
    hand.window.session.edits.step_valence(1, 0)
    assert scene_view(hand.state).title == f"{title}, edited"
    hand.wait()
    hand.trigger("undo")
    assert scene_view(hand.state).title == title


def test_another_title_can_be_typed_and_is_of_the_configuration(hand: Hand) -> None:
    hand.open("annulus-near")
    title = hand.state.document.title
    hand.window.session.edits.step_valence(1, 0)
    hand.wait()
    hand.window.docks["Export"].raise_()
    box = hand.window.export_panel.title
    assert box.text() == f"{title}, edited"
    box.setText("")
    QTest.keyClicks(box, "A 5 beside three 3")
    QTest.keyClick(box, Qt.Key.Key_Return)
    hand.wait()
    assert scene_view(hand.state).title == "A 5 beside three 3"
    assert figure_view(hand.state, False).title == "A 5 beside three 3"
    assert hand.state.document.to_case().title == "A 5 beside three 3"
    assert hand.state.undo_name == "change the title"
    hand.trigger("undo")
    assert box.text() == f"{title}, edited"


def test_undo_shows_the_field_of_before_at_once(hand: Hand) -> None:
    hand.open("sphere-cube")
    before = hand.state.field
    hand.drag(hand.place_of(6), hand.place_of(6) + QPointF(30, 10))
    assert "let go" in hand.window.convergence_panel.verdict.text()
    hand.release(hand.place_of(6))
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field is not before
    hand.window.session.edits.undo()
    assert hand.state.field is before  # no waiting
    assert hand.state.solved


def test_a_field_of_another_configuration_is_pale_and_has_no_verdict(hand: Hand) -> None:
    hand.open("sphere-cube")
    whole = scene_view(hand.state).layer("H").opacity
    assert "aligned" in hand.window.convergence_panel.verdict.text()
    session = hand.window.session
    session.edits.toggle_lock(0)
    assert not hand.state.stale  # the same field
    hand.wait()
    changes = (ChangeValence(0, 2), ChangeValence(1, 2), ChangeValence(2, 5))
    session.edits.do(Together(changes, "change"))
    assert hand.state.stale
    assert scene_view(hand.state).layer("H").opacity < whole
    assert "not solved yet" in hand.window.convergence_panel.verdict.text()
    hand.wait(lambda: hand.state.solved)
    assert scene_view(hand.state).layer("H").opacity == whole


def test_a_locked_singularity_says_so_when_it_is_dragged(hand: Hand) -> None:
    hand.open("disk-4")
    blank = patch(hand, 0)
    assert np.abs(blank - blank[:, ::-1]).max() < 0.1 * 255  # one colour
    hand.window.session.edits.toggle_lock(0)
    hand.wait()
    assert (patch(hand, 0).min(axis=-1) > 250).sum() > 0.2 * patch(hand, 0)[..., 0].size  # white
    assert not any(m.locked for m in figure_view(hand.state, False).singularities)
    eye = hand.canvas.renderer.GetActiveCamera().GetPosition()
    start = hand.place_of(0)
    hand.drag(start, start + QPointF(60, 40))
    assert QToolTip.text() == "Singularity 1 is locked: L unlocks it"
    assert hand.canvas.cursor().shape() == Qt.CursorShape.ForbiddenCursor
    hand.release(start + QPointF(60, 40))
    assert hand.canvas.renderer.GetActiveCamera().GetPosition() == eye
    assert hand.state.undo_name == "lock singularity 1"
    QToolTip.hideText()


def test_the_read_out_is_of_what_is_shown(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.move(hand.place((0.0, 0.0, 1.0)))
    assert "triangle" in hand.window.status.hover.text()
    hand.open("disk-4")
    assert hand.window.status.hover.text() == ""


@pytest.mark.parametrize("name", ["mbo", "globally-optimal"])
def test_long_work_can_be_stopped_from_its_first_moment(hand: Hand, name: str) -> None:
    hand.open("sphere-cube")
    hand.window.session.moves.place_natural(name)
    assert hand.window.actions_table.by_name["stop"].isEnabled()
    assert hand.state.progress.stage == f"preparing {NATURAL_LABELS[name]}"
    hand.window.session.solving.stop()
    assert "Stopped" in hand.said
    assert not hand.window.actions_table.by_name["stop"].isEnabled()
    hand.wait()


def test_natural_singularities_that_the_triangles_place_say_so(hand: Hand) -> None:
    hand.open("disk-4")
    hand.trigger("natural-globally-optimal")
    assert "4 singularities are as near to another as edges are long" in hand.said
    (button,) = hand.window.centre.message_bar.action_buttons
    assert button.text() == "Use MBO"
    button.click()
    hand.wait(lambda: hand.state.undo_name == "natural singularities (MBO)")
    assert hand.state.message is None


def test_remedies_go_while_the_mouse_carries_one(hand: Hand) -> None:
    hand.open("disk-4")
    hand.window.session.edits.remove(0)
    hand.wait()
    panel = hand.window.validity_panel
    assert panel.buttons
    hand.trigger("add-3")
    hand.move(hand.place((0.3, 0.2, 0.0)))
    assert not panel.buttons
    assert "click to place" in panel.note.text()
    hand.trigger("select")
    assert panel.buttons


def test_an_angle_without_edges_says_so(hand: Hand) -> None:
    hand.open("disk-4")
    box = hand.window.surface_panel.features
    box.sharp.click()
    hand.wait()
    assert box.found.text() == "No edge bends by more than 40\u00b0"


def test_the_button_that_solves_stops_what_takes_long(hand: Hand) -> None:
    hand.open("sphere-cube")
    button = hand.window.solve_button
    actions = hand.window.actions_table.by_name
    assert button.defaultAction() is actions["solve"]
    hand.window.session.moves.place_natural("ginzburg-landau")
    while button.defaultAction() is not actions["stop"]:
        QApplication.processEvents()
        assert hand.state.progress is not None
    QTest.mouseClick(button, LEFT)
    hand.wait()
    assert "Stopped" in hand.said
    assert button.defaultAction() is actions["solve"]


def test_no_loop_has_the_colour_of_what_is_good(hand: Hand) -> None:
    for color in CONDITIONS:
        red, green, blue = rgb(color)
        assert green <= max(red, blue)
    hand.open("annulus-near")
    hand.trigger("method-isotropic")
    row = hand.window.validity_panel.rows[0]
    assert row.color == BAD
    assert GOOD not in {child.styleSheet() for child in row.findChildren(QFrame)}


def test_a_message_says_what_first_then_where_and_has_a_button(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "fin.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nf 1 2 3\nf 2 4 3\nf 1 2 5\nf 2 1 4\n"
    )
    hand.open(path)
    bar = hand.window.centre.message_bar
    assert bar.text.text() == "1 non-manifold edge with more than two triangles"
    assert bar.below.text().startswith("fin.obj, edges 0-1: repair")
    assert str(tmp_path) not in bar.below.text()
    # cut apart, it is in two pieces: one button does all that is needed
    said = [button.text() for button in bar.action_buttons]
    assert said == ["Repair, use the largest piece", "Show where"]
    bar.action_buttons[0].click()
    hand.wait(lambda: hand.state.document is not None)
    assert hand.state.message is None
    assert hand.state.document.surface.n_faces == 3
