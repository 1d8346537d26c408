"""Every widget says its name and shows its focus; themes, preferences, the log."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QAccessible, QGuiApplication, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractItemView, QApplication, QDialog, QToolButton, QWidget

from crossview.gui.docks import TABS
from crossview.gui.panels import LogPanel
from crossview.gui.preferences import Preferences, PreferencesDialog
from crossview.scene import renderer_name
from crossview.view.colors import THEMES
from tests.windowing import Hand

TAB = Qt.FocusPolicy.TabFocus


def reached_by_tab(root: QWidget) -> list[QWidget]:
    return [
        widget
        for widget in root.findChildren(QWidget)
        if widget.focusPolicy() & TAB
        and not widget.visibleRegion().isEmpty()
        and widget.isEnabled()
        and not widget.objectName().startswith("qt_")  # a part of another
    ]


def name_of(widget: QWidget) -> str:
    return QAccessible.queryAccessibleInterface(widget).text(QAccessible.Text.Name)


def lightnesses(widget: QWidget) -> np.ndarray:
    """How light the pixels of a widget are, (height, width), 0 to 1."""
    image = widget.grab().toImage()
    rows = [
        [image.pixelColor(x, y).lightnessF() for x in range(image.width())]
        for y in range(image.height())
    ]
    return np.array(rows)


def bytes_of(image: QImage) -> bytes:
    return bytes(image.constBits())


def test_tab_reaches_every_widget_each_with_a_name_and_a_focus_that_is_seen(hand: Hand) -> None:
    hand.open("annulus-near")
    hand.trigger("mesh")
    window = hand.window
    window.docks["Log"].show()
    reached: set[QWidget] = set()
    for title in TABS:
        window.docks[title].raise_()
        QApplication.processEvents()
        wanted = set(reached_by_tab(window))
        assert not [widget for widget in wanted if not name_of(widget)]
        hand.canvas.setFocus()
        QTest.keyClick(hand.canvas, Qt.Key.Key_Tab)
        widget: QWidget | None = None
        while widget is not hand.canvas:
            widget = QApplication.focusWidget()
            assert widget is not None
            assert not widget.visibleRegion().isEmpty()
            around = window.viewport if widget is hand.canvas else widget
            before = bytes_of(around.grab().toImage())
            QTest.keyClick(widget, Qt.Key.Key_Tab)
            QApplication.processEvents()
            if widget not in reached and QApplication.focusWidget() is not widget:
                assert before != bytes_of(around.grab().toImage()), f"unseen: {name_of(widget)}"
            reached.add(widget)
        left = wanted & set(reached_by_tab(window))  # settings may be of another layer by now
        missed = [name_of(widget) for widget in left - reached]
        assert not missed
    assert len(reached) > 25


def test_a_theme_turns_window_icons_and_scene(hand: Hand) -> None:
    hand.open("disk-4")

    def lightness() -> tuple[float, float, float]:
        QApplication.processEvents()
        picture = hand.window.grab().toImage()
        icon = hand.window.actions_table.by_name["open"].icon().pixmap(20, 20).toImage()
        inked = [
            icon.pixelColor(x, y).lightnessF()
            for x in range(20)
            for y in range(20)
            if icon.pixelColor(x, y).alphaF() > 0.9
        ]
        scene = hand.picture()[4, 4] / 255
        return picture.pixelColor(5, 5).lightnessF(), float(np.mean(inked)), float(scene.mean())

    def grounds() -> list[float]:
        """How light lists, tables and texts are behind what is written, the empty ones too."""
        areas = [area for area in window.findChildren(QAbstractItemView) if area.isVisible()]
        pictures = [area.viewport().grab().toImage() for area in areas]
        return [p.pixelColor(p.width() - 2, p.height() - 2).lightnessF() for p in pictures]

    window = hand.window
    light = lightness()
    assert min(grounds()) > 0.8
    window.appearance.show_dialog()
    dialog = window.findChild(PreferencesDialog)
    assert dialog is not None
    assert not [w for w in reached_by_tab(dialog) if not name_of(w)]
    dialog.theme.setCurrentIndex(dialog.theme.findData("dark"))
    dark = lightness()
    assert light[0] > 0.8 > 0.5 > dark[0]
    # words and the frames of boxes are seen on the dark ground
    add = window.singularities_panel.findChild(QToolButton)
    assert add is not None
    for widget in (add, window.surface_panel.features.sharp, window.layers_panel.list):
        assert np.ptp(lightnesses(widget)) > 0.4
    box = window.surface_panel.features.sharp
    assert np.ptp(lightnesses(box)[:, :13]) > 0.25  # of the frame alone
    assert len(grounds()) >= 2
    assert max(grounds()) < 0.5
    assert light[1] < 0.3 < 0.7 < dark[1]
    assert hand.shows(THEMES["dark"].background)
    assert light[2] > 0.9 > 0.2 > dark[2]
    assert Preferences.load().theme == "dark"
    dialog.theme.setCurrentIndex(dialog.theme.findData("light"))
    assert lightness() == light
    assert min(grounds()) > 0.8
    dialog.shaded.setChecked(True)
    assert hand.state.layers["H"].shaded
    dialog.quads.setValue(1234)
    assert window.quads_panel.options.target_quads == 1234
    dialog.close()


def test_settings_that_make_no_sense_are_as_at_first(settings: None) -> None:
    QSettings().setValue("preferences/theme", "purple")
    QSettings().setValue("preferences/quads", -7)
    found = Preferences.load()
    assert (found.theme, found.quads) == ("system", 1)
    replace(found, theme="dark", copies=False).keep()
    assert Preferences.load() == replace(found, theme="dark", copies=False)


def test_the_log_tells_what_was_done_and_diagnostics_tell_the_log(hand: Hand) -> None:
    hand.open("disk-4")
    hand.window.session.edits.step_valence(1, 0)
    hand.trigger("undo")
    hand.trigger("redo")
    hand.window.session.edits.change_valence(1, 99)
    told = [(entry.kind, entry.text) for entry in hand.window.log.entries]
    done = [text for kind, text in told if kind == "done"]
    assert done[0] == "open disk-4"
    assert done[2:] == [f"undo {done[1]}", f"redo {done[1]}"]
    assert ("error", "valence 99 is not offered: choose from 1 to 12, but 4") in told
    panel = hand.window.findChild(LogPanel)
    assert panel is not None
    assert panel.toPlainText().count("\n") == len(told) - 1
    hand.open(Path.home() / "no such folder" / "surface.obj")
    hand.trigger("diagnostics")
    copied = QGuiApplication.clipboard().text()
    assert "redo" in copied
    assert f"Drawn by {renderer_name()}" in copied
    assert renderer_name()
    assert "no such folder" in copied
    assert str(Path.home()) not in copied
    hand.trigger("preferences")
    for dialog in hand.window.findChildren(QDialog):
        dialog.close()
