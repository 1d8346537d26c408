"""What a window gives away comes back: figures, cameras, scripts; and what its Help tells."""

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QMenu

from crossview.cases.gallery import exhibits, find_case, names
from crossview.cli import main
from crossview.gui.gallery import Gallery
from crossview.gui.help_page import KeysPage
from tests.crossview.gui.test_window import write_obj
from tests.windowing import Hand


def drop(hand: Hand, path: Path) -> None:
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    button, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    copy = Qt.DropAction.CopyAction
    enter = QDragEnterEvent(QPoint(9, 9), copy, data, button, keys)
    QApplication.sendEvent(hand.window, enter)
    assert enter.isAccepted()
    event = QDropEvent(QPointF(9, 9), copy, data, button, keys)
    QApplication.sendEvent(hand.window, event)
    hand.wait()


def places(hand: Hand) -> np.ndarray:
    points = [s.point for s in hand.state.singularities]
    return np.asarray(hand.state.document.surface.positions(points))


@pytest.mark.parametrize("kind", ["png", "svg", "pdf"])
def test_a_figure_dropped_on_the_window_opens_the_case_it_shows(
    hand: Hand, tmp_path: Path, kind: str
) -> None:
    """Also when it was moved away from its surface."""
    hand.open(write_obj(tmp_path / "mine.obj"))
    for place in ((0.4, 0.0), (-0.4, 0.1), (0.0, 0.5), (0.0, -0.5)):
        point = hand.state.shown_surface.closest_point(np.array((*place, 0.0)))
        hand.window.session.edits.add(point, 3)
        hand.wait()
    hand.trigger("view-iso")
    shown, camera = places(hand), hand.window.viewport.scene.camera
    hand.window.files.export(tmp_path / f"figure.{kind}")
    hand.wait()
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    moved = (tmp_path / f"figure.{kind}").rename(elsewhere / f"figure.{kind}")
    hand.open("sphere-cube")
    drop(hand, moved)
    assert [s.valence for s in hand.state.singularities] == [3, 3, 3, 3]
    np.testing.assert_allclose(places(hand), shown, atol=1e-9)
    opened = hand.window.viewport.scene.camera
    np.testing.assert_allclose(opened.position, camera.position, rtol=1e-7)
    np.testing.assert_allclose(opened.up, camera.up, rtol=1e-7)
    assert hand.window.files.path is None  # saving asks for a case file


def test_a_picture_without_a_case_says_so(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "plain.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n")
    drop(hand, path)
    assert hand.said.startswith("this picture holds no case")


def test_a_figure_of_the_command_line_is_a_case_too(tmp_path: Path) -> None:
    path = tmp_path / "figure.png"
    asked = ["render", "disk-4", "-o", str(path), "--size", "200x150", "--camera", "zx", "--quiet"]
    assert main(asked) == 0
    assert find_case(str(path)) == find_case("disk-4")


def test_a_camera_is_copied_and_pasted(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("view-zx")
    behind = hand.window.viewport.scene.camera
    hand.trigger("copy-camera")
    hand.trigger("view-xy")
    assert hand.window.viewport.scene.camera.position != behind.position
    hand.trigger("paste-camera")
    back = hand.window.viewport.scene.camera
    np.testing.assert_allclose(back.position, behind.position, rtol=1e-7)
    assert back.parallel_scale == pytest.approx(behind.parallel_scale, rel=1e-7)
    QGuiApplication.clipboard().setText("not a camera")
    hand.trigger("paste-camera")
    assert hand.said.startswith('no camera "not a camera"')
    assert hand.window.viewport.scene.camera == back


def test_opposite_views_look_from_opposite_sides(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.canvas.setFocus()
    seen = []
    for key in (Qt.Key.Key_1, Qt.Key.Key_2, Qt.Key.Key_3, Qt.Key.Key_4, Qt.Key.Key_5, Qt.Key.Key_6):
        hand.key(key, Qt.KeyboardModifier.ControlModifier)
        camera = hand.window.viewport.scene.camera
        away = np.subtract(camera.position, camera.focus)
        seen.append(away / np.linalg.norm(away))
    np.testing.assert_allclose(np.abs(seen).max(axis=1), 1.0, atol=1e-9)
    np.testing.assert_allclose(np.array(seen[0::2]) + np.array(seen[1::2]), 0.0, atol=1e-9)
    assert np.linalg.matrix_rank(seen) == 3


def test_parallel_and_perspective_keep_what_is_at_the_focus(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("view-iso")
    camera = hand.window.viewport.scene.camera
    assert camera.parallel_scale is None
    across = np.cross(camera.up, np.subtract(camera.position, camera.focus))
    beside = np.add(camera.focus, 0.3 * across / np.linalg.norm(across))
    before = hand.place(beside)
    hand.key(Qt.Key.Key_O)
    assert hand.window.viewport.scene.camera.parallel_scale is not None
    assert (hand.place(beside) - before).manhattanLength() < 1.0
    hand.key(Qt.Key.Key_O)
    np.testing.assert_allclose(hand.window.viewport.scene.camera.position, camera.position)


def test_the_script_does_what_was_done(
    hand: Hand, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand.open(write_obj(tmp_path / "mine.obj"))
    for place in ((0.4, 0.0), (-0.4, 0.1), (0.0, 0.5), (0.0, -0.5)):
        point = hand.state.shown_surface.closest_point(np.array((*place, 0.0)))
        hand.window.session.edits.add(point, 3)
        hand.wait()
    hand.trigger("copy-script")
    monkeypatch.chdir(tmp_path.parent)
    done: dict[str, object] = {}
    exec(QGuiApplication.clipboard().text(), done)
    field = done["solution"].field  # type: ignore[attr-defined]
    np.testing.assert_allclose(field.H, hand.state.field.H, atol=1e-9)


def test_help_lists_keys_and_the_gallery_says_what_its_cases_show(hand: Hand) -> None:
    hand.key(Qt.Key.Key_F1)
    (page,) = hand.window.findChildren(KeysPage)
    text = page.page.toPlainText()
    assert "Ctrl+S" in text
    assert "Save as" in text
    page.close()
    groups = [action.menu() for action in hand.window.menus.menu("Gallery").actions()]
    listed = [action for group in groups if isinstance(group, QMenu) for action in group.actions()]
    assert [action.text() for action in listed] == [find_case(name).title for name in names()]
    hand.open("disk-4")
    hand.trigger("diagnostics")
    told = QGuiApplication.clipboard().text()
    assert told.startswith("crossview ")
    assert "disk-4" in told


def test_the_gallery_shows_a_picture_and_a_sentence_of_each_case(hand: Hand) -> None:
    hand.trigger("gallery")
    (gallery,) = hand.window.findChildren(Gallery)
    assert list(gallery.cards) == list(names())
    told = {label.text() for label in gallery.findChildren(QLabel)}
    for exhibit in exhibits():
        assert not gallery.cards[exhibit.case].icon().isNull()
        assert {exhibit.sentence, exhibit.group, find_case(exhibit.case).title} <= told
    gallery.cards["l-shape-corners"].setFocus()
    QTest.keyClick(gallery.cards["l-shape-corners"], Qt.Key.Key_Space)
    hand.wait(lambda: hand.state.solved)
    assert hand.window.findChildren(Gallery) == []
    assert hand.state.document.name == "l-shape-corners"
