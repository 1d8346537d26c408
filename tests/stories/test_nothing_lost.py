"""Work that is not saved is never lost without a word: not by closing, opening or a crash."""

import subprocess
import sys
from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QDialogButtonBox,
    QFileDialog,
    QLineEdit,
    QMessageBox,
    QPushButton,
)

from crossview.cases.gallery import find_case
from crossview.gui.dialogs import Answer
from tests.windowing import Hand

LEFT = Qt.MouseButton.LeftButton

EDITS = """
import sys
from pathlib import Path
from PySide6.QtCore import QCoreApplication
from crossview.cases.gallery import find_case
from crossview.gui.recovery import Recovery
from crossview.session.commands import ChangeValence
from crossview.session.document import Document

app = QCoreApplication([])
app.setOrganizationName("crossview")
app.setApplicationName("crossview")
document, recovery = Document.from_case("disk-4", find_case("disk-4")), Recovery()
for step in range(10 ** 6):
    document = ChangeValence(step % 4, 5 + step % 7).apply(document)
    recovery.keep(document, "disk-4")
    print(step, *(s.valence for s in document.singularities), flush=True)
"""
"""A process that edits for ever, and says what it has edited."""


def answering(answer: Answer, asked: list[str]) -> None:
    """Let the next question be answered with a button."""

    def press() -> None:
        box = QApplication.activeModalWidget()
        if not isinstance(box, QMessageBox):
            QTimer.singleShot(20, press)
            return
        asked.append(box.text())
        QTest.mouseClick(box.button(answer), LEFT)

    QTimer.singleShot(20, press)


def naming(name: str) -> None:
    """Let the next file dialog be given a name."""

    def write() -> None:
        dialog = QApplication.activeModalWidget()
        if not isinstance(dialog, QFileDialog):
            QTimer.singleShot(20, write)
            return
        line = dialog.findChild(QLineEdit)
        line.setText(name)
        box = dialog.findChild(QDialogButtonBox)
        QTest.mouseClick(box.button(QDialogButtonBox.StandardButton.Save), LEFT)

    QTimer.singleShot(20, write)


def edit(hand: Hand) -> None:
    """Change something."""
    hand.window.session.edits.change_valence(0, 5)
    hand.wait()


def valences(case: Path) -> list[int]:
    return [s.valence for s in find_case(str(case)).singularities]


def test_title_marks_what_is_not_saved_until_it_is_undone_or_saved(
    hand: Hand, tmp_path: Path
) -> None:
    hand.open("disk-4")
    assert not hand.window.isWindowModified()
    assert "[*]" in hand.window.windowTitle()  # where the mark goes
    edit(hand)
    assert hand.window.isWindowModified()
    hand.trigger("undo")
    assert not hand.window.isWindowModified()
    hand.trigger("redo")
    assert hand.window.isWindowModified()
    hand.window.files.save_to(tmp_path / "mine.json")
    assert not hand.window.isWindowModified()
    assert hand.window.windowTitle().startswith("mine[*]")
    assert hand.window.statusBar().currentMessage() == f"Saved {tmp_path / 'mine.json'}"
    hand.trigger("undo")
    assert hand.window.isWindowModified()


def test_save_asks_for_a_name_once_and_gives_it_a_suffix(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    edit(hand)
    naming(str(tmp_path / "mine"))
    hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert valences(tmp_path / "mine.crossview") == [5, 3, 3, 3]
    hand.window.session.edits.change_valence(1, 5)
    hand.window.activateWindow()
    assert QTest.qWaitForWindowActive(hand.window)
    hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)  # no question
    assert valences(tmp_path / "mine.crossview") == [5, 5, 3, 3]
    assert not hand.window.isWindowModified()


def test_a_folder_that_is_made_for_a_file_is_told(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.window.files.save_to(tmp_path / "new" / "disk.json")
    assert hand.window.statusBar().currentMessage().endswith("disk.json, in a new folder")
    hand.window.files.export(tmp_path / "figures" / "disk.png")
    hand.wait()
    assert hand.window.statusBar().currentMessage().endswith("disk.png, in a new folder")
    hand.window.files.export(tmp_path / "figures" / "again.png")
    hand.wait()
    assert hand.window.statusBar().currentMessage().endswith("again.png")


def test_closing_asks_and_can_be_given_up_or_save_first(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    hand.window.files.save_to(tmp_path / "mine.json")
    edit(hand)
    asked: list[str] = []
    answering(Answer.Cancel, asked)
    assert not hand.window.close()
    assert hand.window.isVisible()
    assert asked == ["Save the changes of mine?"]
    assert valences(tmp_path / "mine.json") == [3, 3, 3, 3]
    answering(Answer.Save, asked)
    assert hand.window.close()
    assert valences(tmp_path / "mine.json") == [5, 3, 3, 3]


def test_opening_another_asks_too_and_cancel_keeps_what_was_there(hand: Hand) -> None:
    hand.open("disk-4")
    edit(hand)
    asked: list[str] = []
    answering(Answer.Cancel, asked)
    hand.window.files.open("sphere-cube")
    hand.wait()
    assert hand.state.document.name == "disk-4"
    answering(Answer.Discard, asked)
    hand.window.files.open("sphere-cube")
    hand.wait()
    assert hand.state.document.name == "sphere-cube"
    assert len(asked) == 2
    assert not hand.window.isWindowModified()


def test_undo_never_takes_the_surface_away(hand: Hand) -> None:
    hand.open("square")
    hand.open("disk-4")
    assert hand.state.undo_name is None
    hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    hand.wait()
    assert hand.state.document.name == "disk-4"


def restore_button(hand: Hand, verb: str) -> QPushButton:
    (button,) = (
        b for b in hand.window.centre.unsaved.findChildren(QPushButton) if b.text() == verb
    )
    return button


def test_what_a_killed_process_had_not_saved_is_offered_up_to_its_last_edit(
    hand: Hand, tmp_path: Path
) -> None:
    killed = subprocess.Popen(
        [sys.executable, "-c", EDITS], stdout=subprocess.PIPE, text=True, cwd=tmp_path
    )
    for _ in range(20):
        known = killed.stdout.readline()
    killed.kill()
    known = (killed.stdout.read().splitlines() or [known])[-1]
    killed.wait()
    killed.stdout.close()
    step, *expected = map(int, known.split())

    bar = hand.window.centre.unsaved
    assert not bar.isVisible()
    bar.look()
    assert bar.isVisible()
    restore_button(hand, "Restore").click()
    hand.wait(lambda: hand.state.document is not None)
    found = [s.valence for s in hand.state.singularities]
    following = list(expected)  # it may have been killed before it could tell
    following[(step + 1) % 4] = 5 + (step + 1) % 7
    assert found in (expected, following)
    assert hand.window.windowTitle().startswith("disk-4")
    assert hand.window.isWindowModified()  # it is in no file yet
    assert not bar.isVisible()


def test_a_copy_is_kept_after_each_edit_and_gone_when_it_is_not_needed(
    hand: Hand, tmp_path: Path
) -> None:
    def copies() -> list[list[int]]:
        return [valences(path) for path in (tmp_path / "data").rglob("*.json")]

    hand.open("disk-4")
    assert copies() == []
    edit(hand)
    assert copies() == [[5, 3, 3, 3]]
    hand.window.session.edits.change_valence(2, 6)
    assert copies() == [[5, 3, 6, 3]]
    hand.trigger("undo")
    hand.trigger("undo")
    assert copies() == []
    hand.trigger("redo")
    hand.window.files.save_to(tmp_path / "mine.json")
    assert copies() == []


def test_the_copy_of_a_window_that_lives_is_not_offered(hand: Hand) -> None:
    hand.open("disk-4")
    edit(hand)
    hand.window.centre.unsaved.look()
    assert not hand.window.centre.unsaved.isVisible()
