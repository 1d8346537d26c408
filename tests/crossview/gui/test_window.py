"""The window's parts, each through its widgets."""

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QSlider, QSpinBox

import crossview
from crossview.cases.model import Case
from crossview.gui.action_table import ACTIONS, TOOLBAR
from crossview.gui.help_page import AboutBox
from crossview.gui.palette import Palette
from crossview.gui.recent import MOST, recent, remember
from crossview.view.colors import LOOP, valence_color
from solvers.primitives import BUILTIN
from tests.windowing import Hand


def write_obj(path: Path, name: str = "disk") -> Path:
    surface = BUILTIN[name]()
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in surface.vertices)
    faces = "".join(f"f {a} {b} {c}\n" for a, b, c in surface.faces + 1)
    path.write_text(vertices + faces)
    return path


def test_empty_window_offers_three_cases_and_opens_one(hand: Hand) -> None:
    empty = hand.window.centre.empty
    assert [button.objectName() for button in empty.thumbnails] == [
        "sphere-cube",
        "disk-4",
        "suboptimal-a",
    ]
    assert all(not button.icon().isNull() for button in empty.thumbnails)
    assert empty.isVisible()
    empty.thumbnails[1].click()
    hand.wait(lambda: hand.state.field is not None)
    assert not empty.isVisible()
    assert hand.state.document.name == "disk-4"
    assert hand.window.windowTitle().startswith("disk-4")


def test_dropped_file_opens_and_is_remembered(hand: Hand, tmp_path: Path) -> None:
    path = write_obj(tmp_path / "my disk.obj")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    copy = Qt.DropAction.CopyAction
    enter = QDragEnterEvent(QPoint(9, 9), copy, data, buttons, keys)
    QApplication.sendEvent(hand.window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(hand.window, QDropEvent(QPointF(9, 9), copy, data, buttons, keys))
    hand.wait(lambda: hand.state.document is not None)
    assert hand.state.document.name == "my disk"
    assert recent() == (str(path),)


def test_what_is_no_file_is_not_taken(hand: Hand) -> None:
    data = QMimeData()
    data.setText("hello")
    event = QDragEnterEvent(
        QPoint(9, 9),
        Qt.DropAction.CopyAction,
        data,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    event.ignore()
    QApplication.sendEvent(hand.window, event)
    assert not event.isAccepted()


def test_recent_files_newest_first_without_those_that_are_gone(
    settings: None, tmp_path: Path
) -> None:
    assert recent() == ()
    paths = [tmp_path / f"{i}.obj" for i in range(MOST + 3)]
    for path in paths:
        path.touch()
        remember(str(path))
    remember(str(paths[5]))
    assert len(recent()) == MOST
    assert recent()[:2] == (str(paths[5]), str(paths[-1]))
    paths[5].unlink()
    assert recent()[0] == str(paths[-1])


def test_every_action_is_in_a_menu_and_shortcuts_are_unique(hand: Hand) -> None:
    titles = [title for title, _ in hand.window.menus.titled_actions()]
    for spec in ACTIONS:
        action = hand.window.actions_table.by_name[spec.name]
        assert any(title.startswith(f"{spec.menu}: ") for title in titles)
        menu = hand.window.menus.menu(spec.menu)
        inner = menu.findChild(QMenu, spec.submenu) if spec.submenu else menu
        assert action in inner.actions()
    keys = [QKeySequence(key).toString() for spec in ACTIONS for key in spec.keys]
    assert len(keys) == len(set(keys))
    assert {
        name
        for name in TOOLBAR
        if name not in ("|", "->", "any-valence", "method", "solve-or-stop")
    } <= {spec.name for spec in ACTIONS}


def test_palette_finds_and_runs(hand: Hand) -> None:
    hand.open("disk-4")
    hand.key(Qt.Key.Key_P, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    palette = next(w for w in QApplication.topLevelWidgets() if isinstance(w, Palette))
    QTest.keyClicks(palette.search, "cut graph layers")
    shown = [palette.list.topLevelItem(i).text(0) for i in range(palette.list.topLevelItemCount())]
    assert shown == ["View: Layers: Cut graph"]
    QTest.keyClick(palette.search, Qt.Key.Key_Return)
    hand.wait(lambda: hand.state.cut_graph is not None)
    assert hand.state.layers["cut"].visible


def test_palette_says_what_an_action_does_and_its_key_in_words(hand: Hand) -> None:
    hand.open("disk-4")
    hand.click(hand.place_of(0))
    hand.window.show_palette()
    palette = next(w for w in QApplication.topLevelWidgets() if isinstance(w, Palette))
    items = (palette.list.topLevelItem(i) for i in range(palette.list.topLevelItemCount()))
    rows = [item for item in items if item is not None]
    lower = next(row for row in rows if row.text(0) == "Singularities: Lower valence")
    assert lower.text(1) == "Minus"
    palette.list.setCurrentItem(lower)
    assert palette.tip.text().startswith("One quad fewer at each")
    panels = [row.text(0).startswith("View: Panels") for row in rows]
    assert sorted(panels) == panels  # behind all that does something
    palette.close()


def test_about_names_the_method_and_can_be_copied(hand: Hand) -> None:
    hand.window.actions_table.by_name["about"].trigger()
    box = hand.window.findChild(AboutBox)
    assert "Integrable cross-field generation" in box.text()
    box.copy.click()
    assert box.isVisible()
    told = QGuiApplication.clipboard().text()
    assert told.startswith(f"crossview {crossview.__version__}\n")
    assert "VTK" in told
    assert "<" not in told
    box.close()


def test_palette_walks_with_the_arrows(hand: Hand) -> None:
    hand.window.show_palette()
    palette = next(w for w in QApplication.topLevelWidgets() if isinstance(w, Palette))
    first = palette.list.currentItem().text(0)
    QTest.keyClick(palette.search, Qt.Key.Key_Down)
    assert palette.list.currentItem().text(0) != first
    QTest.keyClick(palette.search, Qt.Key.Key_Up)
    assert palette.list.currentItem().text(0) == first
    palette.close()


def test_the_table_edits_valence_lock_and_selection(hand: Hand) -> None:
    hand.open("disk-4")
    panel = hand.window.singularities_panel
    table, model = panel.table, panel.model
    assert model.rowCount() == 4
    row = [model.index(1, column).data() for column in range(3)]
    assert row == ["2", "3", "+1"]
    table.selectRow(1)
    assert hand.state.focus.selected == 1
    hand.trigger("edit")
    editor = table.findChild(QSpinBox)
    assert editor is not None
    editor.setValue(5)
    QTest.keyClick(editor, Qt.Key.Key_Return)
    hand.wait()
    assert hand.state.singularities[1].valence == 5
    assert hand.state.undo_name == "make singularity 2 a valence 5"
    lock = table.visualRect(model.index(2, 4)).center()
    QTest.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, pos=lock)
    hand.wait()
    assert hand.state.singularities[2].locked
    assert hand.state.undo_name == "lock singularity 3"


def test_a_double_click_edits_the_valence(hand: Hand) -> None:
    hand.open("disk-4")
    QTest.mouseDClick(
        hand.canvas, Qt.MouseButton.LeftButton, pos=hand.place_of(2).toPoint(), delay=0
    )
    editor = hand.window.singularities_panel.table.findChild(QSpinBox)
    assert editor is not None
    editor.setValue(6)
    QTest.keyClick(editor, Qt.Key.Key_Return)
    hand.wait()
    assert [s.valence for s in hand.state.singularities] == [3, 3, 6, 3]


def test_the_palette_knows_what_gallery_cases_show(hand: Hand) -> None:
    hand.window.show_palette()
    palette = next(w for w in QApplication.topLevelWidgets() if isinstance(w, Palette))
    QTest.keyClicks(palette.search, "gallery ten valence")
    assert palette.list.topLevelItemCount() == 1
    QTest.keyClick(palette.search, Qt.Key.Key_Return)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document.name == "closed-H"


def test_a_regular_valence_is_not_taken(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.state.document
    hand.window.singularities_panel.model.setData(
        hand.window.singularities_panel.model.index(0, 1), 4
    )
    assert hand.state.document is before


def test_hovering_a_condition_points_out_its_loop(hand: Hand) -> None:
    hand.open("annulus-near")
    row = hand.window.validity_panel.rows[0]
    assert row.text.text() == "around the inner boundary"
    assert row.value.text().endswith("°")
    inner = hand.place((0.4, 0.0, 0.0))
    assert not hand.shows(LOOP, inner)
    row.hovered.emit(True)
    assert hand.shows(LOOP, inner)
    row.hovered.emit(False)
    assert not hand.shows(LOOP, inner)


def test_eyes_and_sliders_of_the_layers(hand: Hand) -> None:
    hand.open("disk-4")
    panel = hand.window.layers_panel
    hand.window.session.looks.toggle_layer("separatrices")  # three of them meet there, as blue
    place = hand.place_of(0)
    assert hand.shows(valence_color(3), place)
    hand.window.session.looks.toggle_layer("singularities")
    assert not hand.shows(valence_color(3), place)
    hand.window.session.looks.toggle_layer("singularities")
    assert hand.shows(valence_color(3), place)
    before = hand.picture()
    slider = panel.editors["crosses"].findChild(QSlider, "opacity")
    slider.setValue(slider.minimum())
    assert hand.state.layers["crosses"].opacity == 0.05  # an open eye shows something
    slider.setValue(slider.maximum())
    assert hand.state.layers["crosses"].opacity == 1.0
    slider = panel.editors["crosses"].findChild(QSlider, "density")
    slider.setValue(slider.maximum())
    assert hand.state.layers["crosses"].density == pytest.approx(2.5)
    assert not np.array_equal(hand.picture(), before)


def test_right_click_offers_the_verbs_of_a_singularity(hand: Hand) -> None:
    hand.open("disk-4")
    place = hand.place_of(3)
    hand.press(place, Qt.MouseButton.RightButton)
    hand.release(place, Qt.MouseButton.RightButton)
    menu = QApplication.activePopupWidget()
    texts = [action.text() for action in menu.actions()]
    assert hand.state.focus.selected == 3
    assert {"Raise valence", "Lower valence", "Locked", "Delete"} <= set(texts)
    next(action for action in menu.actions() if action.text() == "Delete").trigger()
    menu.close()
    hand.wait()
    assert len(hand.state.singularities) == 3


def test_status_reads_out_the_field_under_the_mouse(hand: Hand) -> None:
    hand.open("disk-4")
    hand.move(hand.place((0.0, 0.0, 0.0)))
    text = hand.window.status.hover.text()
    assert text.startswith("H = ")
    assert "triangle" in text
    hand.move(QPointF(3.0, 3.0))
    assert hand.window.status.hover.text() == ""
    assert hand.window.status.frame.text().endswith("ms/frame")


def test_a_saved_case_is_the_document(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.trigger("add-5")
    hand.click(hand.place((0.1, 0.05, 0.0)))
    hand.wait()
    path = tmp_path / "mine.json"
    hand.window.files.save_to(path)
    assert [s.valence for s in Case.load(path).singularities] == [3, 3, 3, 3, 5]
    hand.open(str(path))
    assert [s.valence for s in hand.state.singularities] == [3, 3, 3, 3, 5]


def test_message_details_can_be_copied(hand: Hand) -> None:
    hand.window.files.open("no such thing")
    hand.wait(lambda: hand.state.message is not None)
    bar = hand.window.centre.message_bar
    assert bar.isVisible()
    bar.details_button.click()
    assert bar.details.isVisible()
    bar.copy_button.click()
    assert "no such file" in QGuiApplication.clipboard().text()


def test_dark_scene(hand: Hand) -> None:
    hand.open("disk-4")
    corner = QPointF(4.0, hand.canvas.height() / 2)
    assert hand.shows("#ffffff", corner, reach=1)
    hand.trigger("dark")
    assert not hand.shows("#ffffff", corner, reach=1)


def test_looking_from_three_sides(hand: Hand) -> None:
    hand.open("sphere-cube")
    for name, away in (("xy", (0, 0, 1)), ("xz", (0, -1, 0)), ("yz", (1, 0, 0))):
        hand.trigger(f"view-{name}")
        camera = hand.window.viewport.scene.camera
        seen = np.subtract(camera.position, camera.focus)
        np.testing.assert_allclose(seen / np.linalg.norm(seen), away, atol=0.05)
    assert hand.state.message is None
